"""Extrapolation of finite elements to incompressible layers: nu = 1/2, or so near that digits are lost."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from operator import attrgetter
from types import SimpleNamespace
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike

from verification.problem.array_types import Array, Coatings
from verification.problem.coated_contact import CoatedContact, PrescribedLoad, Solution
from verification.problem.quantity import QUANTITIES, SCALARS, SLOPES

Problem = TypeVar("Problem", bound=CoatedContact | PrescribedLoad)
Solver = Callable[[CoatedContact | PrescribedLoad], Solution]
FIELDS = ("pressure", "stress", "displacement")
STEP = 1e-3  # of Poisson's ratio, at most
NEAR = 1e-4  # of 1/2: mean stresses of elements lose digits as 1/(1 - 2 nu)
# (a/h)^2 times the step: a bonded film of thickness h deforms by its compressibility, over that by shear, as
# (1 - 2 nu) (a/h)^2.
CONFINED = 0.01


def extrapolated(problem: CoatedContact | PrescribedLoad, solve: Solver) -> Solution:
    """The solution with nu = 1/2 or near it; that of ``solve`` for a problem without such a layer.

    The parabola through t = 1, 2, 3 at t = 0, with nu - step t in those layers: step = 1e-3, or ``CONFINED``
    (h/a)^2 where that is less. Its distance from the straight line through t = 1 and 2, the second
    difference, is part of the uncertainty.
    """
    if short_of_limit(problem, 1) == problem:
        return solve(problem)
    first = solve(short_of_limit(problem, 1))
    step = min(STEP, CONFINED * (_thinnest(problem) / float(first.contact_radius)) ** 2)
    near = first if step == STEP else solve(short_of_limit(problem, 1, step))
    further, third = (solve(short_of_limit(problem, t, step)) for t in (2, 3))
    return cast(Solution, _Extrapolated(near, further, third))


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
class _Extrapolated:
    """3 f(1) - 3 f(2) + f(3), uncertain by 3 U(1) + 3 U(2) + U(3) + |second difference|, for each f.

    Fields are extrapolated at the same x/a, of which they are smooth functions at the edge too; that of the
    extrapolated radius is uncertain, which moves fields beside the edge.
    """

    near: Solution
    further: Solution
    third: Solution

    def __getattr__(self, name: str) -> Any:
        if name in SCALARS + SLOPES:
            return self._parabola(attrgetter(name))
        if name in FIELDS:
            return partial(self._field, name)
        if (field := name.removesuffix("_uncertainty")) in FIELDS:
            return partial(self._field_uncertainty, field)
        if name in ("diagnostics", "surface_nodes", "singular_radii"):
            return getattr(self.near, name)
        raise AttributeError(name)

    @cached_property
    def uncertainty(self) -> Any:
        """Uncertainty of the scalars; None where the solutions state none."""
        if any(one.uncertainty is None for one in self._three):
            return None
        rows, total = [], {}
        for name in (name for name in SCALARS if not QUANTITIES[name].derived):
            own = self._summed(attrgetter(f"uncertainty.{name}"))
            bend = abs(self._bend(attrgetter(name)))
            rows += [(name, "the three solutions", own), (name, "limit", bend)]
            total[name] = own + bend
        return SimpleNamespace(**total, budget=tuple(rows))

    @property
    def stiffness_uncertainty(self) -> float | None:
        if self.uncertainty is None:
            return None
        own = self._summed(lambda one: one.stiffness_uncertainty or 0.0)
        return float(own + abs(self._bend(attrgetter("stiffness"))))

    @property
    def _three(self) -> tuple[Solution, Solution, Solution]:
        return self.near, self.further, self.third

    def _at(self, one: Solution, name: str, x: ArrayLike, y: ArrayLike = 0.0, *z: Any, **of: Any) -> Array:
        """``name`` of one solution where x/a is the same."""
        ratio = float(one.contact_radius) / float(self.contact_radius)
        found: Array = getattr(one, name)(np.asarray(x) * ratio, np.asarray(y) * ratio, *z, **of)
        return found

    def _field(self, name: str, *at: Any, **of: Any) -> Array:
        return np.asarray(self._parabola(lambda one: self._at(one, name, *at, **of)))

    def _field_uncertainty(self, name: str, x: ArrayLike, y: ArrayLike = 0.0, *z: Any, **of: Any) -> Array:
        own = self._summed(lambda one: self._at(one, f"{name}_uncertainty", x, y, *z, **of))
        bend = np.abs(self._bend(lambda one: self._at(one, name, x, y, *z, **of)))
        moved = abs(self._bend(attrgetter("contact_radius"))) / float(self.contact_radius)
        f = self._at(self.near, name, x, y, *z, **of)
        shifts = [
            np.abs(self._at(self.near, name, np.asarray(x) * k, np.asarray(y) * k, *z, **of) - f)
            for k in (1 - moved, 1 + moved)
        ]
        return np.asarray(own + bend + np.maximum(*shifts))

    def _parabola(self, of: Callable[[Solution], Any]) -> Any:
        return 3 * of(self.near) - 3 * of(self.further) + of(self.third)

    def _summed(self, of: Callable[[Solution], Any]) -> Any:
        return 3 * of(self.near) + 3 * of(self.further) + of(self.third)

    def _bend(self, of: Callable[[Solution], Any]) -> Any:
        return of(self.near) - 2 * of(self.further) + of(self.third)
