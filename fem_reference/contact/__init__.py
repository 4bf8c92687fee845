"""Round contacts: the pressure at a given radius, and the radius on a sequence of meshes."""
