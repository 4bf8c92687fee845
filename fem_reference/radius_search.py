"""Search for the contact radius at a given load.

The load of a rigid paraboloid rises with the contact radius, W ~ a^3 on a homogeneous solid, so log W is
nearly linear in log a and Newton's method with the slope d log W / d log a, which every solution gives to a
hundredth (``contact``), converges in a few steps. Small steps stretch the mesh, large ones make a new one.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

from .contact import FixedRadiusContact
from .mesh import Meshes

__all__ = ["RadiusSearch", "find_contact_radius"]

_STRETCH = 1.3  # largest factor by which radii are stretched before a new mesh is generated


@dataclass(frozen=True, eq=False)
class RadiusSearch:
    """The contact found, and (contact radius, load) of every solve."""

    contact: FixedRadiusContact
    history: tuple[tuple[float, float], ...]
    converged: bool


def find_contact_radius(
    load: float,
    *,
    start: float,
    tolerance: float,
    max_iterations: int,
    mesh_at: Callable[[float], Meshes],
    solve_on: Callable[[Meshes], FixedRadiusContact],
) -> RadiusSearch:
    """Find a with |W(a)/load - 1| <= ``tolerance`` from ``start``.

    mesh_at : contact radius -> mesh with a vertex there
    solve_on : mesh -> contact with the radius of the mesh
    """
    a, mesh = start, mesh_at(start)
    history: list[tuple[float, float]] = []
    while True:
        contact = solve_on(mesh.stretched(a / mesh.contact_radius))
        history.append((a, contact.load))
        positive = contact.load > 0 and math.isfinite(contact.load)
        converged = positive and abs(math.log(load / contact.load)) <= tolerance
        if converged or not positive or len(history) >= max_iterations:
            return RadiusSearch(contact, tuple(history), converged)
        a = contact.radius_at(load)
        if not 1 / _STRETCH < a / mesh.contact_radius < _STRETCH:
            mesh = mesh_at(a)
