"""Sequence of mesh levels on which the contact radius is found.

A coarse mesh finds the contact radius approximately. A companion, somewhat coarser than the final mesh, finds
it closely and is the reference of the error estimate. The final mesh gives the result. A vertex lies at the
contact radius of every level.
"""

import math
from dataclasses import replace
from typing import NamedTuple

from fem_reference.contact.fixed_radius import FixedRadiusContact, solve_at_radius
from fem_reference.elasticity.axisymmetric import Discretisation
from fem_reference.meshing.mesh import EDGE_SIZE, Grading, MeridianMesh, meridian_mesh
from fem_reference.scaling import LayeredSolid, first_radius

# One row of triangles in a coating: the radius is good to 1e-5, from where the companion takes one solve.
_COARSE = Grading.of(0.5, rows=1.0)
# Tolerances of the load. That of the companion counts in the estimate: one solve instead of two. The final
# mesh meets its own by one solve, then moves with its edge to the load itself.
_OF_COMPANION, _OF_FINAL = 1e-5, 3e-8
_MOST_SOLVES = 30  # of the contact on one level
_STRETCH = 1.3  # largest factor by which radii are stretched before a new mesh is generated
# Above this Poisson ratio flat triangles in a film lock far from the contact: at 0.4999 the approach erred by
# 2.4 times its uncertainty until the largest were this share of those of other films.
_INCOMPRESSIBLE, _NARROWER = 0.495, 0.64
COMPANION = 1.4  # size of the companion over that of the final mesh


class NotConverged(Exception):
    """The solver did not reach its tolerance; the message states what was reached and what to try."""


class Level(NamedTuple):
    """A mesh level and the |log W/load| allowed on it."""

    name: str
    grading: Grading
    tolerance: float


Solids = tuple[LayeredSolid, ...]  # the flat, then an elastic ball
History = list[tuple[str, float, float]]  # level, contact radius, load of every solve


def solve_levels(
    solids: Solids, load: float, *, order: int, size: float, with_companion: bool, curvature: float = 0.0
) -> tuple[FixedRadiusContact, FixedRadiusContact | None, History]:
    """Find the contact radius at ``load``, each level starting from the result of the one before.

    Returns the contact on the final mesh, that on the companion if wanted, and every solve.

    order, size : of the final level.  curvature : of the gap, as in `contact.undeformed_gap`
    Raises NotConverged when the load is not reached on one of the levels.
    """
    levels = [Level("coarse", _COARSE, 1e-3)]
    if with_companion:
        levels.append(Level("companion", companion_grading(size), _OF_COMPANION))
    levels.append(Level("final", final_grading(size), _OF_FINAL))
    a = first_radius(solids, load)
    history: History = []
    found: dict[str, FixedRadiusContact] = {}
    for level in levels:
        contact, solves = find_contact_radius(solids, load, level, a, order, curvature)
        history += solves
        found[level.name] = contact
        a = contact.radius_at(load) + contact.edge_displacement  # which is smaller on the next
    return found["final"].at_load(load), found.get("companion"), history


def find_contact_radius(
    solids: Solids, load: float, level: Level, a: float, order: int, curvature: float
) -> tuple[FixedRadiusContact, History]:
    """Find the contact radius of a ``load``, within the tolerance of the ``level``, from ``a``.

    The load of a rigid paraboloid rises with the contact radius, W ~ a^3 on a homogeneous solid, so log W is
    nearly linear in log a and Newton's method with the slope d log W / d log a, which every solution gives to
    some thousandths (``fixed_radius``), converges in a few steps. Small steps stretch the meshes, large ones
    make new ones.

    Returns the last contact and every solve. Raises NotConverged after ``_MOST_SOLVES``, or where the load is
    not a positive number.
    """
    meshes = meshes_at(solids, level.grading, a)
    solves: History = []
    while True:
        factor = a / meshes[0].contact_radius
        elements = [Discretisation(mesh.stretched(factor), order) for mesh in meshes]
        flat, *others = zip(solids, elements, strict=True)
        contact = solve_at_radius(*flat, others[0] if others else None, curvature)
        solves.append((level.name, a, contact.load))
        positive = 0 < contact.load < math.inf  # NaN is not
        if positive and abs(math.log(load / contact.load)) <= level.tolerance:
            return contact, solves
        if not positive or len(solves) >= _MOST_SOLVES:
            raise NotConverged(
                f"the contact radius did not converge on the {level.name} mesh: after {len(solves)} solves, "
                f"at {a:.4g} a_h, the load is {contact.load / load:.6g} of the required one; check "
                "the thicknesses and the ratio of the moduli"
            )
        a = contact.radius_at(load)
        if not 1 / _STRETCH < a / meshes[0].contact_radius < _STRETCH:
            meshes = meshes_at(solids, level.grading, a)


def final_grading(size: float) -> Grading:
    """Sizes of the final mesh: the largest leave room for a companion coarser by its factor."""
    return Grading.of(size).limited(1 / COMPANION)


def companion_grading(size: float) -> Grading:
    """The companion of ``final_grading(size)``: coarser everywhere, with larger triangles at the edge.

    Far away and in thin coatings too: two meshes that are alike there differ by less than their error.
    """
    rows = final_grading(size).rows / COMPANION
    return Grading.of(COMPANION * size, edge_size=4 * EDGE_SIZE, rows=rows).limited(1.0)


def meshes_at(solids: Solids, grading: Grading, contact_radius: float) -> tuple[MeridianMesh, ...]:
    """Mesh of each of the ``solids``, alike on the surface; layers of equal thicknesses share one.

    The contact radius is rounded to five digits, so that the rounding of a search does not decide on the
    triangles; the search stretches the meshes to its own.
    """
    contact_radius = float(f"{contact_radius:.5g}")
    if any(nu > _INCOMPRESSIBLE for solid in solids for _, nu in solid.materials):
        grading = replace(grading, film_size=_NARROWER * grading.film_size)
    far = max(solid.far for solid in solids)
    stacks = tuple(solid.thicknesses for solid in solids)
    made = {
        thicknesses: meridian_mesh(
            contact_radius=contact_radius, thicknesses=thicknesses, far=far, grading=grading, stacks=stacks
        )
        for thicknesses in dict.fromkeys(stacks)
    }
    return tuple(made[solid.thicknesses] for solid in solids)
