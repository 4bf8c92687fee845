"""Values of the open digits at the points of each problem, by the exact reference or a method."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from open_digits_made import ellipses
from open_digits_made.row import DEPTH, DIRECTION, INSIDE, SCALARS, Row, component, off_plane, places, rows_at
from verification.problem.coated_contact import CoatedContact, PrescribedLoad
from verification.problem.point_answers import FLAT, Points
from verification.problem.quantity import DISPLACEMENTS, IN_PLANE, STRESSES
from verification.sources.exact_sources import solve_exactly

Problem = CoatedContact | PrescribedLoad
# Positions over the contact radius, or over the radius of the disc.
SURFACE = (0.0, 0.25, 0.5, 0.75, 0.9, 1.1, 1.25, 1.5, 2.0, 3.0)
BESIDE = (0.0, 0.5, 1.0, 1.5)
OBLIQUE = (0.0, 0.25, 0.75, 1.25, 2.0)


def exact_rows(problem: Problem) -> list[Row]:
    """Every value of ``problem`` by the exact reference, each with its uncertainty."""
    if isinstance(problem, CoatedContact) and problem.indenter is not None:
        return list(ellipses.rows(problem))
    return list(_rows(solve_exactly(problem), problem))


def _rows(solution: Any, problem: Problem) -> Iterator[Row]:
    """Every value of the exact ``solution``; points at multiples of its radius, four digits."""
    a, contact = float(solution.contact_radius), isinstance(problem, CoatedContact)
    for name in SCALARS if contact else ("approach",):
        value, U = (np.array([number]) for number in solution.sample(None, name))
        yield Row(name, None, value, U)
    if contact:
        points = _points(places(INSIDE, a))
        yield Row("pressure", points, *solution.sample(points, "pressure"))
    for body in problem.bodies if isinstance(problem, CoatedContact) else (FLAT,):
        coatings = (
            problem.seen_from(body).coatings if isinstance(problem, CoatedContact) else problem.coatings
        )
        for points, names in _fields(a, coatings, problem.friction > 0, body):
            yield from rows_at(points, names, solution.sample)


def _points(x: Any, y: Any = 0.0, z: Any = 0.0, layer: int = 0, body: str = FLAT) -> Points:
    x, y, z = (np.array(v) for v in np.broadcast_arrays(x, y, z))
    return Points(x, y, z, layer, body)


def _fields(a: float, coatings: Any, sliding: bool, body: str) -> Iterator[tuple[Points, tuple[str, ...]]]:
    """Points of one body with the stresses and displacements that are given there."""
    yield _points(places(SURFACE, a, sliding=sliding), body=body), ("sigma_xx", "sigma_yy")
    z = places(DEPTH, a)
    bounds = np.cumsum([h for _, _, h in coatings])
    layers = np.searchsorted(bounds, z)
    for layer in sorted(set(layers.tolist())):
        names = ("sigma_xx", "sigma_zz", *(("sigma_xz",) if sliding else ()))
        yield _points(0.0, 0.0, z[layers == layer], layer, body), names
    x = places(BESIDE, a, sliding=sliding)
    for k, depth in enumerate(bounds.tolist()):
        for layer in (k, k + 1):
            yield _points(x, 0.0, depth, layer, body), tuple(IN_PLANE)
    x, y = (places([cosine * r for r in OBLIQUE], a, sliding=sliding) for cosine in DIRECTION)
    yield _points(x, y, body=body), ("sigma_xx", "sigma_yy", "sigma_xy", *DISPLACEMENTS)
    for points in off_plane(a, coatings, body):
        yield points, (*STRESSES, *DISPLACEMENTS)


def compared(rows: list[Row], problem: Problem, solve: Callable[..., Any]) -> tuple[int, int, float]:
    """Values compared with a method, how many are within the uncertainty of both, the largest share of it."""
    solution, fields = solve(problem, {}), dict[tuple[int, str], Any]()
    count = within = 0
    largest = 0.0
    for exact in rows:
        if exact.points is None:
            if exact.quantity not in SCALARS:
                continue
            value, U = solution.sample(None, exact.quantity)
        else:
            kind = {"p": "pressure", "s": "stress", "u": "displacement"}[exact.quantity[0]]
            if (id(exact.points), kind) not in fields:
                fields[id(exact.points), kind] = solution.sample(exact.points, kind)
            value, U = (part[component(exact.quantity)] for part in fields[id(exact.points), kind])
        share = np.abs(exact.value - value) / np.maximum(exact.uncertainty + U, 1e-300)
        share = np.where(exact.value == value, 0.0, share)
        count, within = count + share.size, within + int((share <= 1).sum())
        largest = max(largest, float(share.max()))
    return count, within, largest
