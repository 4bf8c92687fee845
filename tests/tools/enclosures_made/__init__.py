"""Proven enclosures of contacts of a rigid sphere with a coated half-space, by ball arithmetic.

Nothing here uses a method or another reference. The extra ``certify`` brings the ball arithmetic.
"""
