"""Search for the contact radius at a given load.

The load of a rigid paraboloid rises with the contact radius, W ~ a^3 on a homogeneous solid, so log W is
nearly linear in log a and the secant method converges in a few steps. Small steps stretch the mesh, large
ones generate a new one.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

from .contact import FixedRadiusContact
from .mesh import Meshes

__all__ = ["RadiusSearch", "find_contact_radius"]

_STRETCH = 1.05  # largest factor by which radii are stretched before a new mesh is generated


@dataclass(frozen=True, eq=False)
class RadiusSearch:
    """The contact found, d log W / d log a there, and (contact radius, load) of every solve."""

    contact: FixedRadiusContact
    slope: float
    history: tuple[tuple[float, float], ...]
    converged: bool


def find_contact_radius(
    load: float,
    *,
    start: float,
    slope: float,
    tolerance: float,
    max_iterations: int,
    mesh_at: Callable[[float], Meshes],
    solve_on: Callable[[Meshes, FixedRadiusContact | None], FixedRadiusContact],
) -> RadiusSearch:
    """Find a with |W(a)/load - 1| <= ``tolerance``, from ``start`` and an initial ``slope``.

    mesh_at : contact radius -> mesh with a vertex there
    solve_on : mesh, contact found before (None at first) -> contact with the radius of the mesh
    """
    a = start
    mesh = mesh_at(a)
    history: list[tuple[float, float]] = []
    last: tuple[Meshes, float, float] | None = None
    contact: FixedRadiusContact | None = None
    while True:
        contact = solve_on(mesh.stretched(a / mesh.contact_radius), contact)
        history.append((a, contact.load))
        positive = contact.load > 0 and math.isfinite(contact.load)
        miss = math.log(load / contact.load) if positive else math.inf
        if positive:
            here = (math.log(a), math.log(contact.load))
            if last is not None:
                step = here[0] - last[1]
                # from one mesh to another the discretisation error changes the load too: use long steps only
                if abs(step) > (1e-5 if last[0] is mesh else 0.02):
                    slope = min(max((here[1] - last[2]) / step, 0.5), 12.0)
        if abs(miss) <= tolerance or not positive or len(history) >= max_iterations:
            return RadiusSearch(contact, slope, tuple(history), abs(miss) <= tolerance)
        last = (mesh, *here)
        a *= math.exp(min(max(miss / slope, -0.7), 0.7))
        if not 1 / _STRETCH < a / mesh.contact_radius < _STRETCH:
            mesh = mesh_at(a)
