"""Triangles of the meridian plane and where points lie in them."""
