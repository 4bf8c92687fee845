"""Error of the influence coefficients by each conversion, against quadrature of the response functions."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from verification.judging.invariant_verdict import Invariant, decide
from verification.problem.array_types import FloatArray
from verification.problem.coated_contact import CoatedContact, Solution
from verification.sources.exact_sources import solve_exactly
from verification.sources.references.patch_displacement import surface_coefficient
from verification.sources.references.solids_in_contact import solids_of

PATCHES = 33  # of a solution that does not state its own
BOUND = 1e-8  # that the default conversion has to meet; its error is 1e-10


@dataclass(frozen=True)
class ConversionError:
    """Error of influence coefficients of the surface displacement by one conversion.

    enlarge : the domain over the grid's, 0 for a conversion that has none.   aliases : summed on either side.
    distance : of the patches, in contact radii.   error : |K - K_exact| / |K_exact| of each.
    largest : of |K - K_exact| over the largest K.
    """

    conversion: str
    enlarge: int
    seconds: float
    distance: tuple[float, ...]
    error: tuple[float, ...]
    largest: float
    aliases: int = 0


def conversion_errors(
    problem: CoatedContact, patches: int = 33, enlarge: Sequence[int] = (2, 4, 8, 16)
) -> tuple[ConversionError, ...]:
    """The influence coefficients of each conversion against direct quadrature.

    plain, with no alias and with two on either side, on each domain; split, which has none.
    The grid fits the contact; the patches judged are the loaded one, some along a row, some along the
    diagonal, out to the corner.
    """
    from semianalytic.coefficients import frf, influence
    from semianalytic.inputs import Numerics

    a = solve_exactly(problem, {"estimate_uncertainty": False}).contact_radius
    n, d = patches, 2.24 * a / patches
    body = _body(problem)
    scale = 1 / (np.pi * body.contact_modulus)
    places = _places(n)
    exact = _by_quadrature(problem, places, d)
    distance = tuple(float(np.hypot(i, j) * d / a) for i, j in places)

    def excess(k: FloatArray) -> FloatArray:
        return frf.compliance_excess(k, problem.coatings, problem.substrate)

    def plain(wide: int, aliases: int) -> FloatArray:
        return scale * influence.plain_coefficients(n, d, excess, enlarge=wide, aliases=aliases)

    wanted: list[tuple[str, int, int, Callable[[], FloatArray]]] = [
        ("split", 0, 0, partial(influence.surface_coefficients, n, d, body, Numerics()))
    ]
    wanted += [("plain", wide, some, partial(plain, wide, some)) for wide in enlarge for some in (0, 2)]
    found = []
    for conversion, wide, aliases, convert in wanted:
        begin = time.perf_counter()
        K = convert()
        seconds = time.perf_counter() - begin
        gap = np.abs(np.array([K[place] for place in places]) - exact)
        error = tuple(float(e) for e in gap / exact)
        largest = float(gap.max() / exact[0])
        found.append(ConversionError(conversion, wide, seconds, distance, error, largest, aliases))
    return tuple(found)


def coefficient_error(problem: CoatedContact, side: float, patches: int = 33) -> float:
    """Largest |K - K_exact| over the largest K, of coefficients by default on patches of ``side`` [m]."""
    from semianalytic.coefficients import influence
    from semianalytic.inputs import Numerics

    places = _places(patches)
    exact = _by_quadrature(problem, places, side)
    K = influence.surface_coefficients(patches, side, _body(problem), Numerics())
    return float(np.abs(np.array([K[place] for place in places]) - exact).max() / exact[0])


def influence_coefficients(solution: Solution, source: str, problem: CoatedContact) -> Invariant:
    """The coefficients in use, of patches and of their parts at the edge, at near and far offsets.

    ``surface_coefficients`` is called as the solution calls it: on its grid, for both bodies. The quadrature
    is that of the response of the layers in the references, around the edge of each patch.
    """
    from semianalytic.coefficients import influence
    from semianalytic.edge import smooth_edge
    from semianalytic.inputs import Numerics

    body, stated, parts = _body(problem), solution.diagnostics, smooth_edge.PARTS
    n = getattr(stated, "patches_per_side", PATCHES)
    d = getattr(stated, "patch_size", None) or 2.24 * solution.contact_radius / n
    errors = []
    for size, side in ((n, d), ((smooth_edge.NEAR + 1) * parts, d / parts)):
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
