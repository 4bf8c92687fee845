"""Axisymmetric finite element model of a rigid sphere on a coated elastic half-space."""
