"""Numerical uncertainty of a quantity from its values on successively finer levels.

Least squares over four levels or more: phi_i = phi_0 + alpha h_i^p, the fit that explains the data best

    U = F_s epsilon + sigma + |phi - phi_fit|    where the standard deviation of the fit sigma < Delta
    U = 3 sigma/Delta (epsilon + sigma + |phi - phi_fit|)    elsewhere
    Delta = (phi_max - phi_min)/(levels - 1), the data range

with F_s = 1.25 for an order 1/2 <= p <= 2.1 that was fitted, 3 otherwise. L. Eca and M. Hoekstra, J. Comput.
Phys. 262 (2014) 104-130. The grid convergence index for two and three levels: P. J. Roache,
Verification and Validation in Computational Science and Engineering, Hermosa, Albuquerque 1998.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from verification.problem.array_types import Array

# Eca and Hoekstra accept a fitted order within these bounds only.
LEAST_ORDER, THEORETICAL_ORDER, SLACK = 0.5, 2.0, 0.1
TRUSTED, SAFE = 1.25, 3.0


@dataclass(frozen=True)
class Fit:
    """phi(h) = limit + sum of coefficients times powers of h, with the standard ``deviation`` of the fit."""

    limit: float
    coefficients: tuple[float, ...]
    powers: tuple[float, ...]
    deviation: float

    def __call__(self, h: float) -> float:
        """phi at the step ``h``."""
        terms = zip(self.coefficients, self.powers, strict=True)
        return self.limit + sum(c * h**power for c, power in terms)


@dataclass(frozen=True)
class Estimate:
    """Uncertainty of the value on the finest level, in its unit.

    order : observed, None where it is not credible.   limit : value extrapolated to step 0.
    method : "least squares", "three levels" or "two levels".
    """

    uncertainty: float
    order: float | None
    limit: float
    method: str


def uncertainty(h: Sequence[float], phi: Sequence[float], order: float = THEORETICAL_ORDER) -> Estimate:
    """Least squares from four levels on, the grid convergence index for fewer."""
    return least_squares(h, phi, order) if len(phi) >= 4 else convergence_index(h, phi, order)


def least_squares(h: Sequence[float], phi: Sequence[float], order: float = THEORETICAL_ORDER) -> Estimate:
    """Eca and Hoekstra's uncertainty of the value on the finest level.

    h : steps, any order, at least four different ones, over any unit.   phi : the values there.
    order : theoretical, 2 in the source; a fitted order above it by more than 0.1 is rejected.
    Raises ValueError for fewer levels, steps that are not positive, values that are not finite.
    """
    steps, values = _checked(h, phi, least=4)
    data_range = float(np.ptp(values)) / (values.size - 1)
    size = float(np.abs(values).max())
    if data_range <= np.finfo(float).eps * size:
        return Estimate(float(np.finfo(float).eps * size), None, float(values[0]), "least squares")
    fit, trusted = _best(steps, values, order)
    fitted = fit(float(steps[0]))
    epsilon, missed = abs(fitted - fit.limit), abs(float(values[0]) - fitted)
    if fit.deviation < data_range:
        found = (TRUSTED if trusted else SAFE) * epsilon + fit.deviation + missed
    else:
        found = SAFE * fit.deviation / data_range * (epsilon + fit.deviation + missed)
    return Estimate(found, fit.powers[0] if trusted else None, fit.limit, "least squares")


def convergence_index(h: Sequence[float], phi: Sequence[float], order: float = THEORETICAL_ORDER) -> Estimate:
    """Roache's index F |phi_2 - phi_1|/(r^p - 1) of the finest value, r the ratio of the steps.

    From three levels p is observed and F = 1.25, or F = 3 with the theoretical ``order`` at most where the
    observed one lies outside [1/2, order + 0.1] or the changes alternate; from two levels always the latter.
    Raises ValueError as ``least_squares``, for fewer than two levels.
    """
    steps, values = _checked(h, phi, least=2)
    change = float(values[1] - values[0])
    ratio = float(steps[1] / steps[0])
    if values.size == 2:
        remainder = change / (ratio**order - 1)
        return Estimate(SAFE * abs(remainder), None, float(values[0]) - remainder, "two levels")
    before = float(values[2] - values[1])
    if change == 0 or before / change <= 0:
        # alternating or constant: no order is observed, so the larger change is taken as the error
        return Estimate(SAFE * max(abs(change), abs(before)), None, float(values[0]), "three levels")
    observed = _order_of_three(steps, change, before)
    trusted = LEAST_ORDER <= observed <= order + SLACK
    used = observed if trusted else min(max(observed, LEAST_ORDER), order)
    remainder = change / (ratio**used - 1)
    found = (TRUSTED if trusted else SAFE) * abs(remainder)
    return Estimate(found, observed if trusted else None, float(values[0]) - remainder, "three levels")


def _checked(h: Sequence[float], phi: Sequence[float], least: int) -> tuple[Array, Array]:
    """Steps and values, finest first."""
    steps, values = np.asarray(h, dtype=float), np.asarray(phi, dtype=float)
    if steps.ndim != 1 or steps.shape != values.shape:
        raise ValueError(f"{steps.shape} steps and {values.shape} values; give one value for each step")
    if np.unique(steps).size < max(least, steps.size):
        raise ValueError(f"{np.unique(steps).size} different steps; give at least {least}, each once")
    if not (np.isfinite(steps).all() and (steps > 0).all() and np.isfinite(values).all()):
        raise ValueError("steps must be positive and values finite; leave failed levels out")
    ranked = np.argsort(steps)
    return steps[ranked] / steps.min(), values[ranked]


def _best(steps: Array, values: Array, order: float) -> tuple[Fit, bool]:
    """The fit by the source's rules, and whether its order is credible."""
    free = min((_free(steps, values, weighted) for weighted in (False, True)), key=lambda fit: fit.deviation)
    p = free.powers[0]
    if LEAST_ORDER <= p <= order + SLACK:
        return free, True
    powers: tuple[tuple[float, ...], ...] = ((1.0,), (order,))
    if p < LEAST_ORDER:
        powers = (*powers, (1.0, order))
    fits = [_linear(steps, values, used, weighted) for used in powers for weighted in (False, True)]
    return min(fits, key=lambda fit: fit.deviation), False


def _free(steps: Array, values: Array, weighted: bool) -> Fit:
    """Fit of the order too, between 1/8 and 8."""
    found = minimize_scalar(
        lambda p: _linear(steps, values, (float(p),), weighted).deviation,
        bounds=(0.125, 8.0),
        method="bounded",
        options={"xatol": 1e-6},
    )
    return _linear(steps, values, (float(found.x),), weighted, fitted=1)


def _linear(steps: Array, values: Array, powers: tuple[float, ...], weighted: bool, fitted: int = 0) -> Fit:
    """Fit with given powers; weights 1/h where ``weighted``.  fitted : number of nonlinear unknowns."""
    weight = 1 / steps if weighted else np.ones_like(steps)
    weight = weight / weight.sum()
    A = np.stack([np.ones_like(steps), *(steps**p for p in powers)], axis=1)
    root = np.sqrt(weight)[:, None]
    x = np.linalg.lstsq(A * root, values * root[:, 0], rcond=None)[0]
    miss = values - A @ x
    free = max(values.size - x.size - fitted, 1)
    deviation = float(np.sqrt(values.size * (weight * miss**2).sum() / free))
    return Fit(float(x[0]), tuple(float(c) for c in x[1:]), powers, deviation)


def _order_of_three(steps: Array, change: float, before: float) -> float:
    """p of (h_3^p - h_2^p)/(h_2^p - h_1^p) = before/change, between 1/8 and 8, by bisection."""
    low, high = 0.125, 8.0

    def ratio(p: float) -> float:
        s = steps[:3] ** p
        return float((s[2] - s[1]) / (s[1] - s[0]))

    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if ratio(middle) < before / change else (low, middle)
    return (low + high) / 2
