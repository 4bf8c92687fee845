"""One ladder for each numerical knob of each method, with the uncertainty that least squares make of it.

A knob is turned over four levels or more while the others stay, so that its own error shows. What a method
states in its budget stands beside the fit, and beside both the true error, known from the integral equation.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from verification.credibility.uncertainty import Estimate, uncertainty
from verification.problem.contact import CoatedContact, Solution
from verification.sources.references import integral_equation

__all__ = ["KNOBS", "Knob", "KnobLadder", "Stated", "places", "probe", "stated", "study", "turn"]

SCALARS = {"p0": "peak_pressure", "a": "contact_radius", "approach": "approach"}


@dataclass(frozen=True)
class Knob:
    """One numerical choice of a method: its ``levels`` as (name, keywords, step), coarse to fine.

    order : theoretical, at which the error falls with the step.   coated : of coated solids alone.
    """

    method: str
    name: str
    levels: tuple[tuple[str, Mapping[str, Any], float], ...]
    order: float = 2.0
    coated: bool = False


def _wider(times: float, patches: int = 129) -> tuple[str, Mapping[str, Any], float]:
    """A domain ``times`` the usual one on patches of the same size."""
    n = 2 * round(patches * times / 2) + 1
    return f"{times:g} times", {"patches": n, "fill": 1.12 * times * (n / (patches * times))}, 1 / times


# All but the size of patches and elements are turned on a coarser grid or mesh, for the sake of time.
KNOBS = (
    Knob(
        "semianalytic",
        "patch size",
        tuple((f"N = {n}", {"patches": n}, 1 / n) for n in (65, 97, 129, 193, 257)),
    ),
    Knob(
        "semianalytic",
        "conversion",
        tuple((f"{n} points", {"patches": 129, "hankel_points": n}, 1 / n) for n in (512, 1024, 2048, 4096)),
        coated=True,
    ),
    Knob("semianalytic", "domain", tuple(_wider(times) for times in (1.0, 1.25, 1.5, 2.0))),
    Knob(
        "semianalytic",
        "iteration",
        tuple((f"{t:.0e}", {"patches": 129, "tolerance": t}, t) for t in (1e-5, 1e-6, 1e-7, 1e-8)),
    ),
    Knob(
        "fem_reference",
        "element size",
        tuple((f"size {s}", {"size": s}, s) for s in (0.5, 0.36, 0.25, 0.16)),
        order=4.0,
    ),
    Knob(
        "fem_reference",
        "element order",
        tuple((f"order {p}", {"order": p, "size": 0.25}, 1 / p) for p in (2, 3, 4)),
        order=4.0,
    ),
    Knob(
        "fem_reference",
        "outer boundary",
        tuple((f"at {d:g}", {"far": d, "size": 0.36}, 1 / d) for d in (125.0, 250.0, 500.0, 1000.0)),
    ),
    Knob(
        "fem_reference",
        "load balance",
        tuple((f"{t:.0e}", {"load_tolerance": t, "size": 0.36}, t) for t in (1e-3, 1e-4, 1e-5, 1e-6)),
    ),
)


@dataclass(frozen=True)
class KnobLadder:
    """The values of each quantity, over its scale, on the levels of one knob; coarse to fine.

    failure : the sentence the next level failed with.
    """

    method: str
    solid: str
    knob: str
    order: float
    levels: tuple[str, ...]
    steps: tuple[float, ...]
    values: dict[str, tuple[float, ...]]
    failure: str | None = None

    def estimate(self, quantity: str) -> Estimate | None:
        """What the ladder says of the finest value of ``quantity``; None with fewer than two levels."""
        found = self.values.get(quantity, ())
        return uncertainty(self.steps, found, self.order) if len(found) > 1 else None


@dataclass(frozen=True)
class Stated:
    """What a method states of itself at its default numerics, over the scale of each quantity.

    uncertainty : by quantity.   budget : (quantity, knob, value).   error : true one, by quantity.
    """

    method: str
    solid: str
    uncertainty: dict[str, float]
    budget: tuple[tuple[str, str, float], ...]
    error: dict[str, float]


def places(problem: CoatedContact, a: float) -> dict[str, tuple[tuple[int, int], float, float, int]]:
    """Where stresses are looked at: (component), x [m], z [m], layer. On the first interface, or at a/2."""
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


def turn(
    problem: CoatedContact, knob: Knob, a: float, solve: Callable[..., Solution], solid: str = ""
) -> KnobLadder:
    """``problem`` on every level of ``knob``; a level that fails ends the ladder with its sentence.

    a : contact radius that the places are named by [m].   solve : of the knob's method.
    """
    found: list[dict[str, float]] = []
    failure = None
    for name, keywords, _ in knob.levels:
        try:
            solution = _solve(solve, problem, estimate_uncertainty=False, **keywords)
            found.append(probe(solution, problem, a))
        except Exception as error:  # a level that cannot be had is a sentence of the report, not a traceback
            failure = f"{name}: {' '.join(str(error).split())[:300]}"
            break
    done = knob.levels[: len(found)]
    return KnobLadder(
        knob.method,
        solid,
        knob.name,
        knob.order,
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
    spread = _collect(
        problem, a, solution.uncertainty, solution.pressure_uncertainty, solution.stress_uncertainty
    )
    scales = {"p0": problem.p_h, "a": problem.a_h, "approach": problem.delta_h}
    short = {full: name for name, full in SCALARS.items()}
    budget = tuple(
        (short[q], knob, float(v) / scales[short[q]])
        for q, knob, v in solution.uncertainty.budget
        if q in short
    )
    error = {name: abs(value[name] - truth[name]) for name in value}
    return Stated(method, solid, spread, budget, error)


def study(
    problem: CoatedContact, solid: str, methods: Sequence[str] = ("semianalytic", "fem_reference")
) -> tuple[tuple[KnobLadder, ...], tuple[Stated, ...]]:
    """Every ladder of every knob, and what each method states of itself."""
    import fem_reference
    import semianalytic

    solvers: dict[str, Callable[..., Any]] = {
        "semianalytic": semianalytic.solve,
        "fem_reference": fem_reference.solve,
    }
    exact = _solve(integral_equation.solve, problem, estimate_uncertainty=False)
    knobs = [k for k in KNOBS if k.method in methods and (problem.coatings or not k.coated)]
    ladders = tuple(turn(problem, k, exact.contact_radius, solvers[k.method], solid) for k in knobs)
    return ladders, tuple(stated(problem, m, solvers[m], exact, solid) for m in methods)


def _solve(solve: Callable[..., Any], problem: CoatedContact, **numerics: Any) -> Any:
    return partial(
        solve,
        radius=problem.radius,
        load=problem.load,
        coatings=problem.coatings,
        substrate=problem.substrate,
        friction=problem.friction,
    )(**numerics)
