"""Extrapolation of finite elements to incompressible layers: nu = 1/2, or so near that digits are lost."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, TypeVar

import numpy as np

from verification.problem.array_types import Array, Coatings
from verification.problem.coated_contact import (
    CoatedContact,
    ContactSolution,
    PrescribedLoad,
    ScalarUncertainty,
)
from verification.problem.point_answers import UNSUPPORTED, Answer, Points, Sampled
from verification.problem.quantity import SCALARS

Problem = TypeVar("Problem", bound=CoatedContact | PrescribedLoad)
Solver = Callable[[CoatedContact | PrescribedLoad], ContactSolution]
STEP = 1e-3  # of Poisson's ratio, at most
NEAR = 1e-4  # of 1/2: mean stresses of elements lose digits as 1/(1 - 2 nu)
# (a/h)^2 times the step: a bonded film of thickness h deforms by its compressibility, over that by shear, as
# (1 - 2 nu) (a/h)^2.
CONFINED = 0.01


def extrapolated(problem: CoatedContact | PrescribedLoad, solve: Solver) -> ContactSolution:
    """The solution with nu = 1/2 or near it; that of ``solve`` for a problem without such a layer.

    The parabola through t = 1, 2, 3 at t = 0, with nu - step t in those layers: step = 1e-3, or ``CONFINED``
    (h/a)^2 where that is less; the straight line through t = 1 and 2 where the two differ by less than the
    parabola adds to the numerical uncertainty. Their distance, the second difference, is part of it.
    """
    if short_of_limit(problem, 1) == problem:
        return solve(problem)
    first = solve(short_of_limit(problem, 1))
    step = min(STEP, CONFINED * (_thinnest(problem) / float(first.contact_radius)) ** 2)
    near = first if step == STEP else solve(short_of_limit(problem, 1, step))
    further, third = (solve(short_of_limit(problem, t, step)) for t in (2, 3))
    return Extrapolated(near, further, third)


def short_of_limit(problem: Problem, t: int, step: float = STEP) -> Problem:
    """The problem with Poisson's ratios near 1/2 lower by ``t`` steps; unchanged where there are none."""

    def compressible(nu: float) -> float:
        return nu - step * t if nu > 0.5 - NEAR else nu

    def layers(coatings: Coatings) -> Coatings:
        return tuple((E1, compressible(nu1), h) for E1, nu1, h in coatings)

    E, nu = problem.substrate
    short: dict[str, Any] = {"coatings": layers(problem.coatings), "substrate": (E, compressible(nu))}
    if isinstance(problem, CoatedContact) and problem.ball is not None:
        E_ball, nu_ball, on_ball = problem.ball
        short["ball"] = E_ball, compressible(nu_ball), layers(on_ball)
    return replace(problem, **short)


def _thinnest(problem: CoatedContact | PrescribedLoad) -> float:
    """Thickness [m] of the thinnest coating near the limit, on either body; infinite where there is none."""
    ball = problem.ball if isinstance(problem, CoatedContact) else None
    layers = (*problem.coatings, *(ball[2] if ball else ()))
    return min((h for _, nu, h in layers if nu > 0.5 - NEAR), default=np.inf)


@dataclass(frozen=True, eq=False)
class Extrapolated(Sampled):
    """Each quantity f by ``_limit`` of f(1), f(2), f(3) and their uncertainties.

    Fields are extrapolated at the same x/a, of which they are smooth functions at the edge too; that of the
    extrapolated radius is uncertain, which moves fields beside the edge.
    """

    near: ContactSolution
    further: ContactSolution
    third: ContactSolution

    def sample(self, points: Points | None, quantity: str, uncertainty: bool = True) -> Answer:
        """Value and uncertainty in the limit; no uncertainty where the solutions state none."""
        three, a = (self.near, self.further, self.third), 1.0 if points is None else self.contact_radius
        places = [_scaled(points, float(one.contact_radius) / a) for one in three]
        (f, U), (g, V), (h, W) = (one.sample(at, quantity) for one, at in zip(three, places, strict=True))
        if f is None:
            return UNSUPPORTED
        value, own, bend = _limit((f, g, h), (U, V, W))
        if own is None or not uncertainty:
            return Answer(value)
        U = own + bend
        if points is None:
            return Answer(value, U)
        radii = [float(one.contact_radius) for one in three]
        moved = abs(radii[0] - 2 * radii[1] + radii[2]) / a
        beside = (self.near.sample(_scaled(places[0], k), quantity, False) for k in (1 - moved, 1 + moved))
        return Answer(value, U + np.maximum(*(np.abs(one.value - f) for one in beside)))

    @property
    def diagnostics(self) -> Any:
        """Those of the nearest solution."""
        return self.near.diagnostics

    @property
    def surface_nodes(self) -> Array:
        """Those of the nearest solution."""
        return self.near.surface_nodes

    @cached_property
    def uncertainty(self) -> ScalarUncertainty | None:
        """Uncertainty of the scalars; None where the solutions state none."""
        rows, total = [], {}
        for name in SCALARS:
            values, stated = zip(
                *(one.sample(None, name) for one in (self.near, self.further, self.third)), strict=True
            )
            if None in stated:
                return None
            _, own, bend = _limit(values, stated)
            assert own is not None
            rows += [(name, "the three solutions", float(own)), (name, "limit", float(bend))]
            total[name] = float(own + bend)
        return ScalarUncertainty(**total, budget=tuple(rows))


def _limit(values: tuple[Any, Any, Any], stated: tuple[Any, Any, Any]) -> tuple[Any, Any | None, Any]:
    """Value at t = 0, the numerical uncertainty of it, None where none is ``stated``, the second difference.

    Parabola: 3 f(1) - 3 f(2) + f(3), 3 U(1) + 3 U(2) + U(3).   Line: 2 f(1) - f(2), 2 U(1) + U(2).
    """
    (f, g, h), (U, V, W) = values, stated
    parabola, bend = 3 * f - 3 * g + h, np.abs(f - 2 * g + h)
    if U is None or V is None or W is None:
        return parabola, None, bend
    straight = bend < U + 2 * V + W
    own = np.where(straight, 2 * U + V, 3 * U + 3 * V + W)
    return np.where(straight, 2 * f - g, parabola), own, bend


def _scaled(points: Points | None, ratio: float) -> Points | None:
    """Points at x and y times ``ratio``."""
    if points is None:
        return None
    x, y = np.asarray(points.x) * ratio, np.asarray(points.y) * ratio
    return Points(x, y, points.z, points.layer, points.body, points.frame)
