"""Extrapolation to limits that a method does not support: nu = 1/2, or a rigid base."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from operator import attrgetter
from types import SimpleNamespace
from typing import Any, TypeVar, cast

import numpy as np

from verification.problem.array_types import Array, Coatings
from verification.problem.coated_contact import CoatedContact, PrescribedLoad, Solution
from verification.problem.quantity import QUANTITIES, SCALARS, SLOPES

Problem = TypeVar("Problem", bound=CoatedContact | PrescribedLoad)
Solver = Callable[[CoatedContact | PrescribedLoad], Solution]
FIELDS = ("pressure", "stress", "displacement")
STEP = 1e-3  # of Poisson's ratio
STIFFEST = 1e4  # base over softest coating


def extrapolated(problem: CoatedContact | PrescribedLoad, solve: Solver) -> Solution:
    """The solution in the incompressible or rigid limit; that of ``solve`` for a problem in neither.

    Linear extrapolation from t = 1 and 2 to t = 0, with nu = 1/2 - 1e-3 t in the incompressible layers and,
    under a coating 1e4 times softer, a compliance of the base of 1/E + 1e-4 t / E1. The second difference
    over t = 1, 2, 3 estimates the error of the extrapolation; it is part of the uncertainty.
    """
    if short_of_limit(problem, 1) == problem:
        return solve(problem)
    near, further, third = (solve(short_of_limit(problem, t)) for t in (1, 2, 3))
    return cast(Solution, _Extrapolated(near, further, third))


def short_of_limit(problem: Problem, t: int) -> Problem:
    """The problem ``t`` steps short of its limits; unchanged where it is in none."""

    def compressible(nu: float) -> float:
        return nu - STEP * t if nu == 0.5 else nu

    E, nu = problem.substrate
    softest = min((E1 for E1, _, _ in problem.coatings), default=E)
    if STIFFEST * softest < E:
        E = 1 / (1 / E + t / (STIFFEST * softest))

    def layers(coatings: Coatings) -> Coatings:
        return tuple((E1, compressible(nu1), h) for E1, nu1, h in coatings)

    short: dict[str, Any] = {"coatings": layers(problem.coatings), "substrate": (E, compressible(nu))}
    if isinstance(problem, CoatedContact) and problem.ball is not None:
        E_ball, nu_ball, on_ball = problem.ball
        short["ball"] = E_ball, compressible(nu_ball), layers(on_ball)
    return replace(problem, **short)


@dataclass(frozen=True, eq=False)
class _Extrapolated:
    """2 f(1) - f(2) of uncertainty 2 U(1) + U(2) + |second difference|, for each scalar and field f."""

    near: Solution
    further: Solution
    third: Solution

    def __getattr__(self, name: str) -> Any:
        if name in SCALARS + SLOPES:
            return 2 * getattr(self.near, name) - getattr(self.further, name)
        if name in FIELDS:
            return partial(self._field, name)
        if (field := name.removesuffix("_uncertainty")) in FIELDS:
            return partial(self._field_uncertainty, field)
        if name in ("diagnostics", "surface_nodes"):
            return getattr(self.near, name)
        raise AttributeError(name)

    @cached_property
    def uncertainty(self) -> Any:
        """Uncertainty of the scalars; None where the solutions state none."""
        if self.near.uncertainty is None or self.further.uncertainty is None:
            return None
        rows, total = [], {}
        for name in (name for name in SCALARS if not QUANTITIES[name].derived):
            own = 2 * getattr(self.near.uncertainty, name) + getattr(self.further.uncertainty, name)
            bend = abs(self._bend(attrgetter(name)))
            rows += [(name, "both solutions", own), (name, "limit", bend)]
            total[name] = own + bend
        return SimpleNamespace(**total, budget=tuple(rows))

    @property
    def stiffness_uncertainty(self) -> float | None:
        if self.uncertainty is None:
            return None
        near, further = (one.stiffness_uncertainty or 0.0 for one in (self.near, self.further))
        return float(2 * near + further + abs(self._bend(attrgetter("stiffness"))))

    def _field(self, name: str, *at: Any, **of: Any) -> Array:
        near, further = (getattr(one, name)(*at, **of) for one in (self.near, self.further))
        return 2 * near - further

    def _field_uncertainty(self, name: str, *at: Any, **of: Any) -> Array:
        U, V = (getattr(one, f"{name}_uncertainty")(*at, **of) for one in (self.near, self.further))
        return 2 * U + V + np.abs(self._bend(lambda one: getattr(one, name)(*at, **of)))

    def _bend(self, of: Callable[[Solution], Any]) -> Any:
        return of(self.near) - 2 * of(self.further) + of(self.third)
