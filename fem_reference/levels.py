"""Sequence of mesh levels on which the contact radius is found.

A rough and a coarse mesh find the contact radius approximately. A companion, somewhat coarser than the final
mesh, finds it closely and is the reference of the error estimate. The final mesh gives the result. A vertex
lies at the contact radius of every level.
"""

from dataclasses import dataclass
from functools import partial

from .axisymmetric import Discretisation
from .contact import FixedRadiusContact, solve_at_radius
from .coupling import Coupling
from .mesh import EDGE_SIZE, Grading, MeridianMesh, Meshes, meridian_mesh
from .radius_search import find_contact_radius
from .scaling import LayeredSolid, first_radius

__all__ = [
    "COMPANION",
    "ContactLevels",
    "NotConverged",
    "companion_grading",
    "final_grading",
    "mesh_at",
    "solve_levels",
]

_COARSE = 0.5
_ROUGH_SOLVES = 8
COMPANION = 1.4  # size of the companion over that of the final mesh


class NotConverged(Exception):
    """The solver did not reach its tolerance; the message states what was reached and what to try."""


@dataclass(frozen=True)
class _Level:
    name: str
    grading: Grading
    order: int
    tolerance: float


@dataclass(frozen=True, eq=False)
class ContactLevels:
    """Contacts on the last levels, d log W / d log a, and (level, a, W) of every solve; scaled units.

    companion : None without an error estimate
    """

    final: FixedRadiusContact
    companion: FixedRadiusContact | None
    slope: float
    history: tuple[tuple[str, float, float], ...]


Solids = tuple[LayeredSolid, ...]


def solve_levels(
    solids: Solids,
    load: float,
    *,
    order: int,
    size: float,
    max_iterations: int,
    tolerance: float,
    with_companion: bool,
    curvature: float = 0.0,
) -> ContactLevels:
    """Find the contact radius at ``load``, each level starting from the result of the one before.

    solids : the flat, then an elastic ball
    order, size, tolerance : of the final level.  max_iterations : contact solves allowed on each level
    curvature : of the gap, as in `contact.undeformed_gap`
    Raises NotConverged when the load is not reached on one of the levels.
    """
    levels = [_Level("rough", Grading.of(0.6), 2, 0.02), _Level("coarse", Grading.of(_COARSE), order, 1e-3)]
    if with_companion:
        levels.append(_Level("companion", companion_grading(size), order, tolerance))
    levels.append(_Level("final", final_grading(size), order, tolerance))
    start = first_radius(solids, load), 3.0
    a, slope = start
    history: list[tuple[str, float, float]] = []
    found: dict[str, FixedRadiusContact] = {}
    for level in levels:
        search = find_contact_radius(
            load,
            start=a,
            slope=slope,
            tolerance=level.tolerance,
            max_iterations=min(max_iterations, _ROUGH_SOLVES) if level.name == "rough" else max_iterations,
            mesh_at=partial(_meshes_at, solids, level.grading),
            solve_on=partial(_solve_on, solids, level.order, curvature),
        )
        history += [(level.name, *entry) for entry in search.history]
        a, W = search.history[-1]
        if not search.converged and level.name == "rough":
            # order 2 is too stiff for the bending of a hard thin film; the next level can do without this one
            a, slope = start
            continue
        if not search.converged:
            raise NotConverged(
                f"the contact radius did not converge on the {level.name} mesh: after "
                f"{len(search.history)} solves, at {a:.4g} a_h, the load is {W / load:.6g} of the required "
                "one; raise max_iterations, or check the thicknesses and the ratio of the moduli"
            )
        slope = search.slope
        # the next level starts at the radius where this one has exactly the load
        a *= (load / W) ** (1 / slope)
        found[level.name] = search.contact
    return ContactLevels(found["final"], found.get("companion"), slope, tuple(history))


def final_grading(size: float) -> Grading:
    """Sizes of the final mesh: the largest leave room for a companion coarser by its factor."""
    return Grading.of(size).limited(1 / COMPANION)


def companion_grading(size: float) -> Grading:
    """The companion of ``final_grading(size)``: coarser everywhere, with larger triangles at the edge.

    Far away and in thin coatings too: two meshes that are alike there differ by less than their error.
    """
    rows = final_grading(size).rows / COMPANION
    return Grading.of(COMPANION * size, edge_size=4 * EDGE_SIZE, rows=rows).limited(1.0)


def mesh_at(solid: LayeredSolid, grading: Grading, contact_radius: float) -> MeridianMesh:
    """Mesh of the ``solid`` with a vertex at the contact radius."""
    return meridian_mesh(
        contact_radius=contact_radius, thicknesses=solid.thicknesses, far=solid.far, grading=grading
    )


def _meshes_at(solids: Solids, grading: Grading, contact_radius: float) -> Meshes:
    """Mesh of each of the ``solids``, alike on the surface; layers of equal thicknesses share one.

    The contact radius is rounded to five digits, so that the rounding of a search does not decide on the
    triangles; the search stretches the meshes to its own.
    """
    contact_radius = float(f"{contact_radius:.5g}")
    far = max(solid.far for solid in solids)
    stacks = tuple(solid.thicknesses for solid in solids)
    made = {
        thicknesses: meridian_mesh(
            contact_radius=contact_radius, thicknesses=thicknesses, far=far, grading=grading, stacks=stacks
        )
        for thicknesses in dict.fromkeys(stacks)
    }
    return Meshes(tuple(made[solid.thicknesses] for solid in solids))


def _solve_on(
    solids: Solids, order: int, curvature: float, meshes: Meshes, previous: FixedRadiusContact | None
) -> FixedRadiusContact:
    flat, *others = meshes.of
    d = Discretisation(flat, order) if previous is None else previous.discretisation.moved(flat)
    if not others:
        return solve_at_radius(solids[0], d, curvature=curvature)
    known = None if previous is None or previous.ball is None else previous.ball.coupling
    if others[0] is flat:
        ball = d
    else:
        ball = Discretisation(others[0], order) if known is None else known.ball.moved(others[0])
    coupling = Coupling(d, ball) if known is None else known.moved(d, ball)
    return solve_at_radius(solids[0], d, (solids[1], coupling), curvature)
