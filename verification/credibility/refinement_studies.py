"""Refinement studies: the error of each method against the exact solution, level by level.

A study that fails at some level keeps the coarser levels with the message of the failure.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from verification.problem.array_types import FloatArray
from verification.problem.coated_contact import CoatedContact, ContactSolution
from verification.problem.gauss_legendre import gauss_legendre
from verification.problem.line_profile import lines_of
from verification.problem.quantity import QUANTITIES as ALL
from verification.problem.quantity import SCALARS
from verification.running.case_result import message_of
from verification.sources.exact_sources import solve_exactly
from verification.sources.method_sources import solve_semianalytic

QUANTITIES = (*(ALL[name].symbol for name in SCALARS), "pressure", "stress")
# An error within this factor of the smallest of all levels has stopped falling.
SETTLED = 3.0
# Between two levels much closer than a doubling, noise looks like an order.
SPAN = 1.9


@dataclass(frozen=True)
class RefinementLevel:
    """One solution: its ``resolution``, its time [s], its error by quantity.

    resolution : patches a side, or the square root of the degrees of freedom of finite elements.
    errors : of p0, a and approach relative; of pressure (L2 over the disc) over p0; of stress over p_h.
    """

    name: str
    resolution: float
    seconds: float
    errors: dict[str, float]


@dataclass(frozen=True)
class Refinement:
    """Solutions of one problem by one ``method`` in one setting, coarse to fine.

    solid : name of what the sphere is pressed on.   failure : message of the level that failed next.
    """

    method: str
    solid: str
    setting: str
    levels: tuple[RefinementLevel, ...] = ()
    failure: str | None = None

    def order(self, quantity: str) -> float | None:
        """Observed order of ``quantity``, see ``order_of``."""
        return order_of(
            [one.resolution for one in self.levels], [one.errors[quantity] for one in self.levels]
        )


def order_of(resolution: Sequence[float], error: Sequence[float]) -> float | None:
    """Slope s of error ~ resolution^-s by least squares, down to the level where the error stops falling.

    Finer levels than the first within a factor ``SETTLED`` of the last error are left out, where another
    numerical parameter dominates, and so is an error that a finer level exceeds by more than that factor: it
    crosses zero by chance. None where the error falls by less than that factor, or where the levels span less
    than the factor ``SPAN``.
    """
    N, found = np.asarray(resolution, dtype=float), np.asarray(error, dtype=float)
    if found.size < 2 or not np.isfinite(found).all():
        return None
    largest_after = np.maximum.accumulate(found[::-1])[::-1]
    monotone = (found > 0) & (SETTLED * found >= largest_after)
    last = int(np.argmax(monotone & (found <= SETTLED * found[-1])))
    used = np.flatnonzero(monotone[: last + 1])
    if used.size < 2 or N[used].max() < SPAN * N[used].min():
        return None
    return float(-np.polyfit(np.log(N[used]), np.log(found[used]), 1)[0])


def errors_against(
    exact: ContactSolution, problem: CoatedContact
) -> Callable[[ContactSolution], dict[str, float]]:
    """Error of each of ``QUANTITIES`` of a solution: p0, a, approach relative, and

    pressure = [ int (p - p_exact)^2 dA / (pi a^2) ]^(1/2) / p0  over the disc of the exact radius a
    stress = max |sigma - sigma_exact| / p_h  on the axis and on both sides of each interface
    """
    a, p0, deep = exact.contact_radius, exact.peak_pressure, problem.interfaces
    # r = a sin(phi) resolves the vertical tangent at the edge; weights of dA / (pi a^2).
    s, w = gauss_legendre(96)
    phi = np.pi / 4 * (s + 1)
    r, weight = a * np.sin(phi), np.pi / 2 * w * np.sin(phi) * np.cos(phi)
    p = exact.pressure(r)[:, None]
    # Square patches have eight mirror images of one sector.
    angle = np.pi / 4 * (np.arange(8) + 0.5) / 8
    bounds = np.array([0.0, *deep, max([4 * a, *(2 * z for z in deep)])])
    z = (bounds[:-1, None] + np.diff(bounds)[:, None] * (np.arange(12) + 0.5) / 12).ravel()
    x = 2.5 * a * np.linspace(0, 1, 80)
    places: list[tuple[FloatArray, FloatArray, int | None]] = [(np.zeros_like(z), z, None)]
    for line in lines_of(problem):
        if line.layer is not None and line.depth:
            places.append((x, np.full_like(x, line.depth), line.layer))
    stresses = [exact.stress(x, 0.0, z, layer) for x, z, layer in places]

    def errors(found: ContactSolution) -> dict[str, float]:
        error = found.pressure(r[:, None] * np.cos(angle), r[:, None] * np.sin(angle)) - p
        worst = [
            np.abs(found.stress(x, 0.0, z, layer) - sigma).max()
            for (x, z, layer), sigma in zip(places, stresses, strict=True)
        ]
        scalars = {ALL[q].symbol: abs(getattr(found, q) / getattr(exact, q) - 1) for q in SCALARS}
        return scalars | {
            "pressure": float(np.sqrt(weight @ np.mean(error**2, axis=1))) / p0,
            "stress": float(np.max(worst)) / problem.p_h,
        }

    return errors


def refined_grid(
    problem: CoatedContact,
    patches: Sequence[int] = (33, 65, 129, 257),
    *,
    solid: str = "",
    setting: str = "",
    solve: Callable[..., ContactSolution] = solve_semianalytic,
    **numerics: Any,
) -> Refinement:
    """``problem`` by the semi-analytical method at each number of ``patches`` a side.

    The method's own estimate of its error is left out, since it needs further solutions.
    numerics : any other keyword of semianalytic.solve.   solve : another solver, see ``Source``.
    """
    steps = {f"N = {n}": {"patches": n, **numerics} for n in patches}
    return _refined(Refinement("semianalytic", solid, setting), problem, solve, steps)


def refined_mesh(
    problem: CoatedContact, order: int, *, solid: str, solve: Callable[..., ContactSolution]
) -> Refinement:
    """``problem`` by elements of ``order`` on the fast and the default mesh; else as ``refined_grid``."""
    from fem_reference.element_numbers import QUALITY

    steps = {name: {"order": order, "size": QUALITY[name]} for name in ("fast", "default")}
    return _refined(Refinement("fem_reference", solid, f"order {order}"), problem, solve, steps)


def _refined(
    empty: Refinement, problem: CoatedContact, solve: Callable[..., Any], steps: Mapping[str, dict[str, Any]]
) -> Refinement:
    levels: list[RefinementLevel] = []
    failure = None
    without = {"estimate_uncertainty": False}
    try:
        errors = errors_against(solve_exactly(problem, without), problem)
        for name, numerics in steps.items():
            begin = time.perf_counter()
            found = solve(problem, numerics | without)
            seconds = time.perf_counter() - begin
            resolution = float(numerics.get("patches") or np.sqrt(found.diagnostics.dofs))
            levels.append(RefinementLevel(name, resolution, seconds, errors(found)))
    except Exception as error:  # a message of the report, not a traceback
        failure = f"{[*steps][len(levels)]}: {message_of(error)}"
    return replace(empty, levels=tuple(levels), failure=failure)
