"""Sequence of mesh levels on which the contact radius is found.

A coarse mesh finds it approximately, the companion, somewhat coarser than the final mesh, closely. The final
mesh gives the result; a third mesh of their family, coarser than the companion, is solved at its radius. A
vertex lies at the contact radius of every mesh.
"""

import math
from dataclasses import replace
from typing import NamedTuple

from fem_reference import element_numbers as chosen
from fem_reference.contact.fixed_radius import FixedRadiusContact, solve_at_radius
from fem_reference.elasticity.axisymmetric import Discretisation
from fem_reference.meshing.mesh import Grading, MeridianMesh, meridian_mesh
from fem_reference.scaling import LayeredSolid, first_radius


class ElementsNotConverged(Exception):
    """The solver did not reach its tolerance; the message states what was reached and what to try."""


class MeshLevel(NamedTuple):
    """A mesh level and the |log W/load| allowed on it."""

    name: str
    grading: Grading
    tolerance: float


Solids = tuple[LayeredSolid, ...]  # the flat, then an elastic ball
History = list[tuple[str, float, float]]  # level, contact radius, load of every solve


def solve_levels(
    solids: Solids, load: float, *, order: int, size: float, meshes: int, curvature: float = 0.0
) -> tuple[tuple[FixedRadiusContact, ...], History]:
    """Find the contact radius at ``load`` on the first ``meshes`` of a family, one or three.

    Returns the contact on each, the finest first, and every solve.

    order, size : of the finest.  curvature : of the gap, as in `contact.undeformed_gap`
    Raises ElementsNotConverged when the load is not reached on one of the meshes.
    """
    first = replace(Grading.of(chosen.LARGEST_SIZE), rows=1.0)
    final, companion, coarsest = family(size)
    levels = [
        MeshLevel("first", first, chosen.FIRST_LOAD),
        MeshLevel("companion", companion, chosen.COARSE_LOAD),
        MeshLevel("final", final, chosen.FINAL_LOAD),
        MeshLevel("coarsest", coarsest, chosen.COARSE_LOAD),
    ]
    a = first_radius(solids, load)
    history: History = []
    found: dict[str, FixedRadiusContact] = {}
    for level in levels if meshes > 1 else levels[::2]:
        contact, solves = find_contact_radius(solids, load, level, a, order, curvature)
        history += solves
        found[level.name] = contact
        a = contact.radius_at(load) + contact.edge_displacement  # which is smaller on the next
    coarser = [found[level.name] for level in levels[1::2]] if meshes > 1 else []
    return (found["final"].at_load(load), *coarser), history


def find_contact_radius(
    solids: Solids, load: float, level: MeshLevel, a: float, order: int, curvature: float
) -> tuple[FixedRadiusContact, History]:
    """Find the contact radius of a ``load``, within the tolerance of the ``level``, from ``a``.

    The load of a rigid paraboloid rises with the contact radius, W ~ a^3 on a homogeneous solid, so log W is
    nearly linear in log a and Newton's method with the slope d log W / d log a, which every solution gives to
    some thousandths (``fixed_radius``), converges in a few steps. Small steps stretch the meshes, large ones
    make new ones.

    Returns the last contact and every solve. Raises ElementsNotConverged after ``MOST_STEPS``, or where the
    load is not a positive number.
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
        if not positive or len(solves) >= chosen.MOST_STEPS:
            raise ElementsNotConverged(
                f"the contact radius did not converge on the {level.name} mesh: after {len(solves)} solves, "
                f"at {a:.4g} a_h, the load is {contact.load / load:.6g} of the required one; check "
                "the thicknesses and the ratio of the moduli"
            )
        a = contact.radius_at(load)
        if not 1 / chosen.STRETCH < a / meshes[0].contact_radius < chosen.STRETCH:
            meshes = meshes_at(solids, level.grading, a)


def family(size: float) -> tuple[Grading, ...]:
    """Sizes of three meshes in one ratio, ``size`` of the finest first.

    Far away and in thin coatings too: meshes that are alike there differ by less than their error. So the
    largest sizes of the finest leave room for the next.
    """
    finest = Grading.of(size).limited(1 / chosen.COARSER)
    next_one = finest.coarser()
    return finest, next_one, next_one.coarser()


def meshes_at(solids: Solids, grading: Grading, contact_radius: float) -> tuple[MeridianMesh, ...]:
    """Mesh of each of the ``solids``, alike on the surface; layers of equal thicknesses share one.

    The contact radius is rounded to five digits, so that the rounding of a search does not decide on the
    triangles; the search stretches the meshes to its own.
    """
    contact_radius = float(f"{contact_radius:.5g}")
    if any(nu > chosen.INCOMPRESSIBLE for solid in solids for _, nu in solid.materials):
        grading = replace(grading, film_size=chosen.NARROWER * grading.film_size)
    far = max(solid.far for solid in solids)
    stacks = tuple(solid.thicknesses for solid in solids)
    made = {
        thicknesses: meridian_mesh(
            contact_radius=contact_radius, thicknesses=thicknesses, far=far, grading=grading, stacks=stacks
        )
        for thicknesses in dict.fromkeys(stacks)
    }
    return tuple(made[solid.thicknesses] for solid in solids)
