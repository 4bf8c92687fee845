"""Guaranteed bounds by finite elements: displacements from one side, equilibrated stresses from the other."""
