"""Exact and published references, computed without either method."""
