"""Measured surfaces as indenters: their files, the contact of patches below them, their picture."""
