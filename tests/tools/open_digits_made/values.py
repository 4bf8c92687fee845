"""Values of the open digits at the points of each problem, by the exact reference or a method."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from open_digits_made import ellipses
from open_digits_made.row import DEPTH, INSIDE, SCALARS, Row, places
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, PrescribedLoad
from verification.problem.point_answers import Points
from verification.problem.quantity import IN_PLANE
from verification.sources.exact_sources import solve_exactly

Problem = CoatedContact | PrescribedLoad
# Positions over the contact radius, or over the radius of the disc.
SURFACE = (0.0, 0.25, 0.5, 0.75, 0.9, 1.1, 1.25, 1.5, 2.0, 3.0)
BESIDE = (0.0, 0.5, 1.0, 1.5)


def exact_rows(problem: Problem) -> list[Row]:
    """Every value of ``problem`` by the exact reference, each with its uncertainty."""
    if isinstance(problem, CoatedContact) and problem.indenter is not None:
        return list(ellipses.rows(problem))
    solution = solve_exactly(problem)
    return list(rows_of(solution, problem, float(solution.contact_radius)))


def rows_of(solution: Any, problem: Problem, a: float) -> Iterator[Row]:
    """Every value of a ``solution``; the points are multiples of ``a`` [m], rounded to four digits."""
    zero = np.zeros(1)
    sliding = problem.friction > 0
    for name in SCALARS if isinstance(problem, CoatedContact) else ("approach",):
        value, U = (np.array([number]) for number in solution.sample(None, name))
        yield Row(name, zero, zero, 0, value, U)
    if isinstance(problem, CoatedContact):
        x = places(INSIDE, a)
        yield Row("pressure", x, 0 * x, 0, *solution.sample(Points(x), "pressure"))
    x = places(SURFACE, a, sliding=sliding)
    yield from _stresses(solution, x, 0 * x, 0, ("sigma_xx", "sigma_yy"))
    z = places(DEPTH, a)
    bounds = np.cumsum([h for _, _, h in problem.coatings])
    layers = np.searchsorted(bounds, z)
    for layer in sorted(set(layers.tolist())):
        here = z[layers == layer]
        names = ("sigma_xx", "sigma_zz", *(("sigma_xz",) if sliding else ()))
        yield from _stresses(solution, 0 * here, here, layer, names)
    x = places(BESIDE, a, sliding=sliding)
    for k, depth in enumerate(bounds.tolist()):
        for layer in (k, k + 1):
            yield from _stresses(solution, x, np.full_like(x, depth), layer, tuple(IN_PLANE))


def _stresses(solution: Any, x: Array, z: Array, layer: int, names: tuple[str, ...]) -> Iterator[Row]:
    sigma, U = solution.sample(Points(x, 0.0, z, layer), "stress")
    assert U is not None
    for name in names:
        yield Row(name, x, z, layer, sigma[IN_PLANE[name]], U[IN_PLANE[name]])


def compared(rows: list[Row], problem: Problem, solve: Callable[..., Any]) -> tuple[int, int, float]:
    """Values compared with a method, how many are within the uncertainty of both, the largest share of it."""
    solution = solve(problem, {})
    if isinstance(problem, CoatedContact) and problem.indenter is not None:
        own = [ellipses.by_method(solution, row) for row in rows]
    else:
        a = next((float(row.value[0]) for row in rows if row.quantity == "contact_radius"), None)
        sampled = rows_of(solution, problem, a or float(solution.contact_radius))
        own = [(row.value, row.uncertainty) for row in sampled]
    count = within = 0
    largest = 0.0
    for exact, other in zip(rows, own, strict=True):
        if other is None:
            continue
        value, U = other
        share = np.abs(exact.value - value) / np.maximum(exact.uncertainty + U, 1e-300)
        share = np.where(exact.value == value, 0.0, share)
        count, within = count + share.size, within + int((share <= 1).sum())
        largest = max(largest, float(share.max()))
    return count, within, largest
