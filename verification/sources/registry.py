"""Sources by name."""

__all__ = ["METHODS", "PUBLISHED", "REFERENCE"]

METHODS = ("semianalytic", "fem_reference")
REFERENCE = "integral_equation"  # the exact solution for spheres and discs
PUBLISHED = "published"  # the source of the profiles made from a table
