"""Stresses of both methods in the plane y = 0 below the contact, as the report draws them.

They come from the Solutions that were judged, at nodes of the semi-analytical grid, where its pressure needs
no interpolation; finite elements have shape functions anywhere.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from verification.judging.invariant_verdict import Invariant, decide
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, ContactSolution
from verification.problem.point_answers import Points
from verification.problem.quantity import IN_PLANE
from verification.sources.source_registry import METHODS

WIDTH = 2.0  # half width over the contact radius, where the grid of the semi-analytical method goes as far
DEPTH = 1.5  # over the contact radius; at least 1.3 times the deepest interface, up to DEEPEST
DEEPEST = 3.0
COLUMNS = 65
LEVELS = 12  # over the depth of an uncoated solid
FEWEST = 4  # in a layer, both its sides included
CHECKED = np.array([-1.1, 0.45])  # over the contact radius: columns whose values are taken at points too
CROWDING = 0.6  # levels are even in z ** CROWDING: close below the surface, wide apart below


@dataclass(frozen=True, eq=False)
class StressPlane:
    """Stresses at x [m], (nx,), and the depths z [m] of each layer, (nz,), both sides of its interfaces.

    stress : by source, for each layer the stresses ``IN_PLANE`` [Pa], (4, nz, nx); the others are 0.
    failures : message by source that failed.   radius : contact radius [m].
    """

    x: Array
    depths: tuple[Array, ...]
    radius: float
    stress: Mapping[str, tuple[Array, ...]]
    failures: Mapping[str, str]


def sample_plane(interfaces: tuple[float, ...], solutions: Mapping[str, ContactSolution]) -> StressPlane:
    """Stresses of the methods among ``solutions`` at the same points; a method that fails leaves its message.

    interfaces : depths [m] from the surface down.
    """
    methods = {name: solutions[name] for name in METHODS if name in solutions}
    if not methods:
        return StressPlane(np.zeros(0), (), 0.0, {}, {})
    first = next(iter(methods.values()))
    stress, failures = {}, {}
    x = _columns(first)
    depths = depths_of(first.contact_radius, interfaces, LEVELS)
    for name, solution in methods.items():
        try:
            layers = [solution.stress(x, 0.0, z[:, None], layer=k) for k, z in enumerate(depths)]
            stress[name] = tuple(np.array([sigma[c] for c in IN_PLANE.values()]) for sigma in layers)
        except Exception as error:  # a result does not depend on its pictures
            failures[name] = f"{type(error).__name__}: {' '.join(str(error).split())[:300]}"
    return StressPlane(x, depths, float(first.contact_radius), stress, failures)


def plane_invariants(
    plane: StressPlane, solutions: Mapping[str, ContactSolution], problem: CoatedContact
) -> tuple[Invariant, ...]:
    """The stresses of ``plane`` are those at its points: two of each layer, beside and below the contact."""
    columns = np.abs(plane.x[:, None] - plane.radius * CHECKED).argmin(axis=0) if plane.x.size else []
    found = []
    for name, layers in plane.stress.items():
        gap, bound = [], []
        for k, (z, drawn) in enumerate(zip(plane.depths, layers, strict=True)):
            level = z.size // 2
            at = Points(plane.x[columns], 0.0, np.full(len(columns), z[level]), k)
            sigma, U = solutions[name].sample(at, "stress")
            for n, c in enumerate(IN_PLANE.values()):
                gap.append((drawn[n, level, columns] - sigma[c]) / problem.p_h)
                bound.append(np.full(len(columns), np.inf) if U is None else U[c] / problem.p_h)
        law = "stresses drawn are those at their points, over p_h"
        found.append(decide("sampled plane", name, law, np.array(gap), np.array(bound)))
    return tuple(found)


def _columns(solution: ContactSolution) -> Array:
    """Surface nodes drawn [m], the one at x = 0 among them."""
    a, nodes = solution.contact_radius, solution.surface_nodes
    inside = np.flatnonzero(np.abs(nodes) <= WIDTH * a)
    middle = int(np.argmin(np.abs(nodes)))
    step = max(1, round((inside.size - 1) / (COLUMNS - 1)))
    chosen = (np.arange(nodes.size) - middle) % step == 0
    return nodes[inside[chosen[inside]]]


def depths_of(a: float, interfaces: tuple[float, ...], levels: int) -> tuple[Array, ...]:
    """Depths [m] of each layer drawn under a contact of radius ``a`` [m], about ``levels`` in all.

    The first and the last of a layer lie on its interfaces; layers that begin below the drawing are left out.
    """
    bottom = max(DEPTH, min(1.3 * max(interfaces, default=0.0) / a, DEEPEST)) * a
    bounds = np.array([0.0, *(z for z in interfaces if z < bottom), bottom]) ** CROWDING
    counts = [max(FEWEST, 1 + round((levels - 1) * float(part) / bounds[-1])) for part in np.diff(bounds)]
    found = []
    for low, high, count in zip(bounds[:-1], bounds[1:], counts, strict=True):
        z = np.linspace(low, high, count) ** (1 / CROWDING)
        found.append(z)
    # Both sides of an interface lie on it to the last bit.
    for k, depth in enumerate(interfaces[: len(found) - 1]):
        found[k][-1] = found[k + 1][0] = depth
    return tuple(found)
