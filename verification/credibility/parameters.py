"""Parameter sweeps: one numerical parameter of a method over its levels, with the uncertainty fitted to it.

A parameter takes four levels or more while the others stay at their defaults, which isolates its error. The
fitted uncertainty is compared with the budget that the method states and with the true error, known from the
integral equation.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from verification.credibility.refinement import failure_message
from verification.credibility.uncertainty import Estimate, uncertainty
from verification.problem.contact import CoatedContact, Solution
from verification.sources.references import integral_equation

__all__ = ["PARAMETERS", "Parameter", "Stated", "Sweep", "places", "probe", "stated", "study", "sweep"]

SCALARS = {"p0": "peak_pressure", "a": "contact_radius", "approach": "approach"}


@dataclass(frozen=True)
class Parameter:
    """A numerical parameter of a method: its ``levels`` as (name, keywords, step), coarse to fine.

    order : theoretical order of the error in the step.   coated : True where only coated solids have it.
    """

    method: str
    name: str
    levels: tuple[tuple[str, Mapping[str, Any], float], ...]
    order: float = 2.0
    coated: bool = False


def _wider(times: float, patches: int = 129) -> tuple[str, Mapping[str, Any], float]:
    """A domain ``times`` the default one on patches of the same size."""
    n = 2 * round(patches * times / 2) + 1
    return f"{times:g} times", {"patches": n, "fill": 1.12 * times * (n / (patches * times))}, 1 / times


# Sweeps but those of patch and element size use a coarser grid or mesh, to save time.
PARAMETERS = (
    Parameter(
        "semianalytic",
        "patch size",
        tuple((f"N = {n}", {"patches": n}, 1 / n) for n in (65, 97, 129, 193, 257)),
    ),
    Parameter(
        "semianalytic",
        "conversion",
        tuple((f"{n} points", {"patches": 129, "hankel_points": n}, 1 / n) for n in (512, 1024, 2048, 4096)),
        coated=True,
    ),
    Parameter("semianalytic", "domain", tuple(_wider(times) for times in (1.0, 1.25, 1.5, 2.0))),
    Parameter(
        "semianalytic",
        "iteration",
        tuple((f"{t:.0e}", {"patches": 129, "tolerance": t}, t) for t in (1e-5, 1e-6, 1e-7, 1e-8)),
    ),
    Parameter(
        "fem_reference",
        "element size",
        tuple((f"size {s}", {"size": s}, s) for s in (0.5, 0.36, 0.25, 0.16)),
        order=4.0,
    ),
    Parameter(
        "fem_reference",
        "element order",
        tuple((f"order {p}", {"order": p, "size": 0.25}, 1 / p) for p in (2, 3, 4)),
        order=4.0,
    ),
    Parameter(
        "fem_reference",
        "outer boundary",
        tuple((f"at {d:g}", {"far": d, "size": 0.36}, 1 / d) for d in (125.0, 250.0, 500.0, 1000.0)),
    ),
    Parameter(
        "fem_reference",
        "load balance",
        tuple((f"{t:.0e}", {"load_tolerance": t, "size": 0.36}, t) for t in (1e-3, 1e-4, 1e-5, 1e-6)),
    ),
)


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
    """Points of comparison of the stress: (component), x [m], z [m], layer; on the first interface or at a/2."""
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
    return _collect(problem, a, solution, solution.pressure, solution.stress)


def _collect(
    problem: CoatedContact, a: float, scalars: Any, pressure: Callable[..., Any], stress: Callable[..., Any]
) -> dict[str, float]:
    scales = {"p0": problem.p_h, "a": problem.a_h, "approach": problem.delta_h}
    found = {name: float(getattr(scalars, full)) / scales[name] for name, full in SCALARS.items()}
    found["pressure, r = 0.6 a"] = float(pressure(np.array([0.6 * a]))[0]) / problem.p_h
    for name, (component, x, z, layer) in places(problem, a).items():
        sigma = stress(np.array([x]), np.zeros(1), np.array([z]), layer)
        found[name] = float(sigma[component][0]) / problem.p_h
    return found


def sweep(
    problem: CoatedContact, parameter: Parameter, a: float, solve: Callable[..., Solution], solid: str = ""
) -> Sweep:
    """``problem`` on every level of ``parameter``; a level that fails ends the sweep with its message.

    a : contact radius that scales the points of comparison [m].   solve : of the parameter's method.
    """
    found: list[dict[str, float]] = []
    failure = None
    for name, keywords, _ in parameter.levels:
        try:
            solution = _solve(solve, problem, estimate_uncertainty=False, **keywords)
            found.append(probe(solution, problem, a))
        except Exception as error:  # a message of the report, not a traceback
            failure = f"{name}: {failure_message(error)}"
            break
    done = parameter.levels[: len(found)]
    return Sweep(
        parameter.method,
        solid,
        parameter.name,
        parameter.order,
        tuple(name for name, _, _ in done),
        tuple(step for _, _, step in done),
        {name: tuple(level[name] for level in found) for name in (found[0] if found else {})},
        failure,
    )


def stated(
    problem: CoatedContact, method: str, solve: Callable[..., Solution], exact: Solution, solid: str = ""
) -> Stated:
    """The uncertainty that ``method`` states at its defaults, and its true error against ``exact``."""
    a = exact.contact_radius
    solution = _solve(solve, problem)
    value, truth = probe(solution, problem, a), probe(exact, problem, a)
    uncertainty = _collect(
        problem, a, solution.uncertainty, solution.pressure_uncertainty, solution.stress_uncertainty
    )
    scales = {"p0": problem.p_h, "a": problem.a_h, "approach": problem.delta_h}
    short = {full: name for name, full in SCALARS.items()}
    budget = tuple(
        (short[q], parameter, float(v) / scales[short[q]])
        for q, parameter, v in solution.uncertainty.budget
        if q in short
    )
    error = {name: abs(value[name] - truth[name]) for name in value}
    return Stated(method, solid, uncertainty, budget, error)


def study(
    problem: CoatedContact, solid: str, methods: Sequence[str] = ("semianalytic", "fem_reference")
) -> tuple[tuple[Sweep, ...], tuple[Stated, ...]]:
    """Every parameter sweep and the uncertainty that each method states."""
    import fem_reference
    import semianalytic

    solvers: dict[str, Callable[..., Any]] = {
        "semianalytic": semianalytic.solve,
        "fem_reference": fem_reference.solve,
    }
    exact = _solve(integral_equation.solve, problem, estimate_uncertainty=False)
    chosen = [p for p in PARAMETERS if p.method in methods and (problem.coatings or not p.coated)]
    sweeps = tuple(sweep(problem, p, exact.contact_radius, solvers[p.method], solid) for p in chosen)
    return sweeps, tuple(stated(problem, m, solvers[m], exact, solid) for m in methods)


def _solve(solve: Callable[..., Any], problem: CoatedContact, **numerics: Any) -> Any:
    return solve(**{field.name: getattr(problem, field.name) for field in fields(problem)}, **numerics)
