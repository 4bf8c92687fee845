"""Error of the influence coefficients by each conversion, against quadrature of the response functions."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from verification.judging.invariant_verdict import Invariant, decide
from verification.problem.array_types import FloatArray
from verification.problem.coated_contact import CoatedContact, Solution
from verification.sources.exact_sources import solve_exactly
from verification.sources.references.patch_displacement import surface_coefficient

PATCHES = 33
BOUND = 1e-7  # that the default conversion has to meet; its error is 1e-10


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

    plain, with no alias and with two on either side, and split-fft on each domain; split, which has none.
    The grid fits the contact; the patches judged are the loaded one, some along a row, some along the
    diagonal, out to the corner.
    """
    from semianalytic import frf, halfspace, influence
    from semianalytic.response import Response

    a = solve_exactly(problem, {"estimate_uncertainty": False}).contact_radius
    n, d = patches, 2.24 * a / patches
    E, nu = problem.coatings[0][:2] if problem.coatings else problem.substrate
    scale = (1 - nu**2) / (np.pi * E)
    thickness = [h for _, _, h in problem.coatings]
    steps = np.unique(np.round(np.geomspace(1, n - 1, 9)).astype(int))
    places = [(0, 0), *((int(i), 0) for i in steps), *((int(i), int(i)) for i in steps)]
    places.sort(key=lambda place: np.hypot(*place))
    exact = np.array(
        [surface_coefficient(i * d, j * d, d, problem.coatings, problem.substrate) for i, j in places]
    )
    distance = tuple(float(np.hypot(i, j) * d / a) for i, j in places)

    def excess(k: FloatArray) -> FloatArray:
        return frf.compliance_excess(k, problem.coatings, problem.substrate)

    layers = Response(excess, thickness[0] if thickness else 0.0, sum(thickness))

    def split(wide: int) -> FloatArray:
        C = halfspace.surface_deflection(n, n, d, d)
        if not problem.coatings:
            return C
        c, b = layers.image
        C = C + c * halfspace.surface_deflection(n, n, d, d, b)
        return C + influence.remainder_coefficients(n, d, layers, enlarge=wide)

    def plain(wide: int, aliases: int) -> FloatArray:
        return influence.plain_coefficients(n, d, excess, enlarge=wide, aliases=aliases)

    wanted: list[tuple[str, int, int, Callable[[], FloatArray]]] = [("split", 0, 0, partial(split, 0))]
    for wide in enlarge:
        wanted.append(("plain", wide, 0, partial(plain, wide, 0)))
        wanted.append(("plain", wide, 2, partial(plain, wide, 2)))
        if problem.coatings:
            wanted.append(("split-fft", wide, 2, partial(split, wide)))
    found = []
    for conversion, wide, aliases, convert in wanted:
        begin = time.perf_counter()
        K = scale * convert()
        seconds = time.perf_counter() - begin
        gap = np.abs(np.array([K[place] for place in places]) - exact)
        error = tuple(float(e) for e in gap / exact)
        largest = float(gap.max() / exact[0])
        found.append(ConversionError(conversion, wide, seconds, distance, error, largest, aliases))
    return tuple(found)


def influence_coefficients(solution: Solution, source: str, problem: CoatedContact) -> Invariant:
    """The default conversion on a grid over the contact, at near and far patches, over the largest.

    Checked by themselves, since the edge profile of a sphere hides the error of a poor conversion.
    """
    found = conversion_errors(problem, PATCHES, ())[0]
    law = f"influence coefficients at {len(found.error)} patches are those of direct quadrature"
    return decide("influence coefficients", source, law, found.largest, BOUND)
