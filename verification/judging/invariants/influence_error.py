"""Error of the influence coefficients, against quadrature of the response functions."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from verification.judging.invariant_verdict import Invariant, decide
from verification.problem.array_types import FloatArray
from verification.problem.coated_contact import CoatedContact, ContactSolution
from verification.sources.references.patch_displacement import surface_coefficient
from verification.sources.references.solids_in_contact import solids_of

PATCHES = 33  # of a solution that does not state its own
BOUND = 1e-8  # that the conversion has to meet; its error is 1e-10


def coefficient_error(problem: CoatedContact, side: float, patches: int = 33) -> float:
    """Largest |K - K_exact| over the largest K, of coefficients by default on patches of ``side`` [m]."""
    from semianalytic.coefficients import influence
    from semianalytic.inputs import Numerics

    places = _places(patches)
    exact = _by_quadrature(problem, places, side)
    K = influence.surface_coefficients(patches, side, _body(problem), Numerics())
    return float(np.abs(np.array([K[place] for place in places]) - exact).max() / exact[0])


def influence_coefficients(solution: ContactSolution, source: str, problem: CoatedContact) -> Invariant:
    """The coefficients in use, of patches and of their parts at the edge, at near and far offsets.

    ``surface_coefficients`` is called as the solution calls it: on its grid, for both bodies, and on the
    coarsest of all over the same square, whose patches are wider than many films are thick. The quadrature is
    that of the response of the layers in the references, around the edge of each patch.
    """
    from semianalytic import numbers
    from semianalytic.coefficients import influence
    from semianalytic.inputs import Numerics

    body, stated, parts = _body(problem), solution.diagnostics, numbers.PARTS
    n = getattr(stated, "patches_per_side", PATCHES)
    d = getattr(stated, "patch_size", None) or 2.24 * solution.contact_radius / n
    errors = []
    grids = (n, d), (numbers.COARSEST, d * n / numbers.COARSEST)
    for size, side in (*grids, ((numbers.NEAR_PARTS + 1) * parts, d / parts)):
        K = influence.surface_coefficients(size, side, body, Numerics())
        places = _places(size)
        exact = _by_quadrature(problem, places, side)
        errors.append((np.array([K[place] for place in places]) - exact) / exact[0])
    error = np.concatenate(errors)
    law = f"influence coefficients at {error.size} patches and parts are those of direct quadrature"
    return decide("influence coefficients", source, law, error, BOUND)


def _body(problem: CoatedContact) -> Any:
    """The bodies in contact as the method holds them."""
    from semianalytic.inputs import Body

    ball = None if problem.ball is None else Body.of_ball(problem.ball, problem.friction)
    return Body(problem.coatings, problem.substrate, problem.friction, ball)


def _places(n: int) -> list[tuple[int, int]]:
    """The loaded patch, some along a row, some along the diagonal, nearest first."""
    steps = np.unique(np.round(np.geomspace(1, n - 1, 9)).astype(int))
    places = {(0, 0), *((int(i), 0) for i in steps), *((int(i), int(i)) for i in steps)}
    return sorted(places, key=lambda place: float(np.hypot(*place)))


def _by_quadrature(problem: CoatedContact, places: Sequence[tuple[int, int]], side: float) -> FloatArray:
    """The approach of both surfaces at each offset under unit pressure on a patch [m/Pa]."""
    solids = solids_of(problem.coatings, problem.substrate, problem.ball)
    return np.array(
        [sum(surface_coefficient(i * side, j * side, side, *one) for one in solids) for i, j in places]
    )
