"""Loading curve of a sphere: load, approach, contact radius, stiffness at given points.

The sphere's dW/d delta is the stiffness of a flat punch of the contact radius, 2 a E1* kappa, for any
layers: Pharr, Oliver and Brotzen, J. Mater. Res. 7 (1992) 613-617. A solver of spheres therefore gives the
stiffness of flat punches too.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import exp, log, sqrt

import numpy as np
from scipy.optimize import brentq

from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, ContactSolution
from verification.problem.loading_curve import LoadingCurve
from verification.problem.point_answers import Answer, Points
from verification.sources.limit_extrapolation import short_of_limit
from verification.sources.references.flat_punch import Pressed, pressed


@dataclass(frozen=True, eq=False)
class Loading:
    """States (W, delta, a, S) near the points, columns of ``state``, with their ``uncertainties`` [SI].

    diagnostics : number of contacts solved for the curve.   series : coefficients of the formulas that
    ``series_over_load`` and ``series_over_kappa`` judge.
    """

    problem: LoadingCurve
    state: Array
    uncertainties: Array
    diagnostics: dict[str, int]
    series: tuple[float, ...] = ()
    uncertainty: None = None

    def sample(self, points: Points, quantity: str, uncertainty: bool = True) -> Answer:
        """One of ``CURVES`` with its uncertainty [SI] where the control equals x, points of the problem.

        series_over_load  : (4/3) E1* sqrt(R) delta^1.5 (1 + c1 X + c2 X^2 + ..) / W,  X = sqrt(R delta)/h
        series_over_kappa : (1 + c1 X + c2 X^2 + ..) / kappa,  X = a/h

        A state misses its point by the error of the load estimated for it. The value is moved to the point
        along the curve through the neighbouring states; the shift is part of the uncertainty.
        """
        value = self._of(quantity, self.state)
        U = np.zeros(value.shape)
        for j in range(4):
            moved = self.state.copy()
            moved[:, j] *= 1 + 1e-6
            slope = (self._of(quantity, moved) / value - 1) / 1e-6
            U += np.abs(slope * self.uncertainties[:, j] / self.state[:, j])
        column = 2 if self.problem.control == "contact_radius" else 1
        control = self.state[:, column]
        miss = np.log(np.array(self.problem.at) / control)
        power = np.full(value.shape, 3.0)
        if control.size > 1:
            order = np.argsort(control)
            power[order] = np.gradient(np.log(value[order]), np.log(control[order]))
        U += np.abs(power) * (self.uncertainties[:, column] / control + np.abs(miss))
        value = value * np.exp(power * miss)
        rows = [self.problem.at.index(float(x)) for x in np.ravel(points.x)]
        return Answer(value[rows], (U * value)[rows] if uncertainty else None)

    def _of(self, name: str, state: Array) -> Array:
        W, delta, a, S = state.T
        p = self.problem
        h = p.coatings[0][2] if p.coatings else np.inf
        kappa = S / (2 * a * p.E_star)
        if name == "series_over_load":
            hertz = 4 / 3 * p.E_star * np.sqrt(p.radius) * delta**1.5
            return hertz * _series(np.sqrt(p.radius * delta) / h, self.series) / W
        if name == "series_over_kappa":
            return _series(a / h, self.series) / kappa
        return {"load": W, "approach": delta, "contact_radius": a, "kappa": kappa}[name]


def pressed_at(problem: LoadingCurve, at: float) -> tuple[float, Pressed]:
    """Contact radius [m] and exact solution where the control of ``problem`` equals ``at`` [m]."""
    layers = (problem.coatings, problem.substrate)
    if problem.control == "contact_radius":
        return at, pressed(at, *layers)
    wanted = at * problem.radius
    # Hertz has delta R = a^2; a layer on a stiff base down to a^2/4, one on a soft base far more.
    span = (log(sqrt(wanted) / 30), log(sqrt(wanted) * 30))
    a = exp(brentq(lambda s: log(pressed(exp(s), *layers).approach / wanted), *span))
    return a, pressed(a, *layers)


def loading(
    problem: LoadingCurve, solve: Callable[[CoatedContact], ContactSolution], *, limits: bool = False
) -> Loading:
    """The curve by a solver of one contact under a load.

    limits : extrapolate to nu = 1/2, see ``limit_extrapolation``.
    """
    states, count = [], 0

    def state(contact: CoatedContact) -> tuple[Array, Array]:
        nonlocal count
        count += 1
        one = solve(contact)
        found = [one.sample(None, name) for name in ("approach", "contact_radius", "stiffness")]
        value, U = zip((contact.load, 0.0), *found, strict=True)
        return np.array(value), np.array(U)

    for at in problem.at:
        contact = problem.contact(pressed_at(problem, at)[1].load / problem.radius)
        if not limits or short_of_limit(contact, 1) == contact:
            states.append(state(contact))
            continue
        (near, U), (further, V) = (state(short_of_limit(contact, t)) for t in (1, 2))
        third, T = state(short_of_limit(contact, 3))
        # Parabola through all three points, with the uncertainty of the straight line through two.
        bend = near - 2 * further + third
        states.append((2 * near - further + bend, 3 * U + 3 * V + T + np.abs(bend)))
    found, uncertainties = (np.array(column) for column in zip(*states, strict=True))
    return Loading(problem, found, uncertainties, {"contacts": count})


def exact_loading(problem: LoadingCurve) -> Loading:
    """The curve by the integral equation; its uncertainty is the change by fewer nodes and a shorter tail."""
    rows, uncertainty = [], []
    for at in problem.at:
        a, fine = pressed_at(problem, at)
        coarse = pressed(a, problem.coatings, problem.substrate, nodes=60, panel=12, tail=27.0)
        state, other = (_exact_state(problem, a, one) for one in (fine, coarse))
        rows.append(state)
        uncertainty.append(2 * np.abs(state - other) + 1e-12 * state)
    return Loading(problem, np.array(rows), np.array(uncertainty), {"contacts": 2 * len(rows)})


def _exact_state(problem: LoadingCurve, a: float, one: Pressed) -> Array:
    return np.array(
        [one.load / problem.radius, one.approach / problem.radius, a, 2 * a * problem.E_star * one.kappa]
    )


def _series(X: Array, coefficients: tuple[float, ...]) -> Array:
    return 1 + X * np.polynomial.polynomial.polyval(X, coefficients or (0.0,))
