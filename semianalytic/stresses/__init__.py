"""Stresses and displacements below the surface."""
