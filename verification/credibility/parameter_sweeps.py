"""Parameter sweeps: one numerical parameter of a method over its levels, with the uncertainty fitted to it.

A parameter takes four levels or more while the others stay at their defaults, which isolates its error. The
fitted uncertainty is compared with the budget that the method states and with the true error, known from the
integral equation.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from verification.credibility.level_uncertainty import Estimate, uncertainty
from verification.credibility.refinement_studies import failure_message
from verification.problem.coated_contact import CoatedContact, Solution
from verification.problem.quantity import QUANTITIES, SCALARS
from verification.sources.exact_sources import solve_exactly
from verification.sources.source_record import NumericalParameter
from verification.sources.source_registry import METHODS, SOURCES, solvers

Function = Callable[..., Any]
PARAMETERS = tuple(parameter for source in SOURCES.values() for parameter in source.parameters)


@dataclass(frozen=True)
class Sweep:
    """The values of each quantity, over its scale, on the levels of one parameter; coarse to fine.

    failure : message of the level that failed next.
    """

    method: str
    solid: str
    parameter: str
    order: float
    levels: tuple[str, ...]
    steps: tuple[float, ...]
    values: dict[str, tuple[float, ...]]
    failure: str | None = None

    def estimate(self, quantity: str) -> Estimate | None:
        """Uncertainty of the finest value of ``quantity``; None with fewer than two levels."""
        found = self.values.get(quantity, ())
        return uncertainty(self.steps, found, self.order) if len(found) > 1 else None


@dataclass(frozen=True)
class Stated:
    """The uncertainty that a method states at its default numerics, over the scale of each quantity.

    uncertainty : by quantity.   budget : (quantity, parameter, value).   error : true one, by quantity.
    """

    method: str
    solid: str
    uncertainty: dict[str, float]
    budget: tuple[tuple[str, str, float], ...]
    error: dict[str, float]


def places(problem: CoatedContact, a: float) -> dict[str, tuple[tuple[int, int], float, float, int]]:
    """Points of comparison of the stress, (component), x [m], z [m], layer, on an interface or at a/2."""
    depth, lower = (problem.interfaces[0], 1) if problem.coatings else (0.5 * a, 0)
    where = "interface" if problem.coatings else "z = a/2"
    return {
        "sigma_xx, surface, x = -0.8 a": ((0, 0), -0.8 * a, 0.0, 0),
        f"sigma_xx, axis, {where}": ((0, 0), 0.0, depth, 0),
        f"sigma_xz, x = 0.6 a, {where}": ((0, 2), 0.6 * a, depth, lower),
        "sigma_zz, axis, z = 2 a": ((2, 2), 0.0, max(2 * a, 1.5 * depth), len(problem.coatings)),
    }


def probe(solution: Solution, problem: CoatedContact, a: float) -> dict[str, float]:
    """p0, a and approach over Hertz's of the substrate; pressure at 0.6 a and the stresses over p_h."""
    scalars = {name: QUANTITIES[name].value(solution, problem) for name in SCALARS}
    return _collect(problem, a, scalars, solution.pressure, solution.stress)


def _collect(
    problem: CoatedContact, a: float, scalars: dict[str, float], pressure: Function, stress: Function
) -> dict[str, float]:
    found = {QUANTITIES[q].symbol: value / _scale(q, problem) for q, value in scalars.items()}
    found["pressure, r = 0.6 a"] = float(pressure(np.array([0.6 * a]))[0]) / problem.p_h
    for name, (component, x, z, layer) in places(problem, a).items():
        sigma = stress(np.array([x]), np.zeros(1), np.array([z]), layer)
        found[name] = float(sigma[component][0]) / problem.p_h
    return found


def sweep(
    problem: CoatedContact, parameter: NumericalParameter, a: float, solve: Function, solid: str = ""
) -> Sweep:
    """``problem`` on every level of ``parameter``; a level that fails ends the sweep with its message.

    a : contact radius that scales the points of comparison [m].   solve : of the parameter's method.
    """
    found: list[dict[str, float]] = []
    failure = None
    for name, numerics, _ in parameter.levels:
        try:
            solution = solve(problem, {"estimate_uncertainty": False, **numerics})
            found.append(probe(solution, problem, a))
        except Exception as error:  # a message of the report, not a traceback
            failure = f"{name}: {failure_message(error)}"
            break
    done = parameter.levels[: len(found)]
    levels, steps = tuple(name for name, _, _ in done), tuple(step for _, _, step in done)
    values = {name: tuple(level[name] for level in found) for name in (found[0] if found else {})}
    return Sweep(parameter.method, solid, parameter.name, parameter.order, levels, steps, values, failure)


def stated(problem: CoatedContact, method: str, solve: Function, exact: Solution, solid: str = "") -> Stated:
    """The uncertainty that ``method`` states at its defaults, and its true error against ``exact``."""
    a = exact.contact_radius
    solution = solve(problem)
    value, truth = probe(solution, problem, a), probe(exact, problem, a)
    scalars = {q: QUANTITIES[q].uncertainty(solution, problem) or 0.0 for q in SCALARS}
    bounds = _collect(problem, a, scalars, solution.pressure_uncertainty, solution.stress_uncertainty)
    budget = tuple(
        (QUANTITIES[q].symbol, parameter, float(v) / _scale(q, problem))
        for q, parameter, v in solution.uncertainty.budget
        if q in SCALARS
    )
    error = {name: abs(value[name] - truth[name]) for name in value}
    return Stated(method, solid, bounds, budget, error)


def study(
    problem: CoatedContact,
    solid: str,
    methods: Sequence[str] = METHODS,
    available: Mapping[str, Callable[..., Solution]] | None = None,
) -> tuple[tuple[Sweep, ...], tuple[Stated, ...]]:
    """Every parameter sweep and the uncertainty that each method states.

    available : other solvers, by method.
    """
    exact = solve_exactly(problem, {"estimate_uncertainty": False})
    available = available or solvers()
    chosen = [p for p in PARAMETERS if p.method in methods and (problem.coatings or not p.coated)]
    sweeps = tuple(sweep(problem, p, exact.contact_radius, available[p.method], solid) for p in chosen)
    return sweeps, tuple(stated(problem, m, available[m], exact, solid) for m in methods)


def _scale(name: str, problem: CoatedContact) -> float:
    return getattr(problem, QUANTITIES[name].scale)
