"""Refinement studies: the error of each method against the exact solution, level by level.

A study that fails at some level keeps the coarser levels with the message of the failure.
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from verification.problem.array_types import FloatArray
from verification.problem.coated_contact import CoatedContact, Solution
from verification.problem.gauss_legendre import gauss_legendre
from verification.problem.line_profile import lines_of
from verification.problem.quantity import QUANTITIES as ALL
from verification.problem.quantity import SCALARS
from verification.sources.exact_sources import solve_exactly
from verification.sources.method_sources import solve_elements, solve_semianalytic

QUANTITIES = (*(ALL[name].symbol for name in SCALARS), "pressure", "stress")
# An error within this factor of the smallest of all levels has stopped falling.
SETTLED = 3.0
# Between two levels much closer than a doubling, noise looks like an order.
SPAN = 1.9


@dataclass(frozen=True)
class Level:
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
    levels: tuple[Level, ...]
    failure: str | None = None

    def falls(self, quantity: str) -> bool:
        """True where the finest level has less than a third, ``SETTLED``, of the error of the coarsest."""
        return bool(self.levels[-1].errors[quantity] * SETTLED < self.levels[0].errors[quantity])

    def order(self, quantity: str) -> float | None:
        """Observed order of ``quantity``, see ``order_of``."""
        return order_of(
            [one.resolution for one in self.levels], [one.errors[quantity] for one in self.levels]
        )


def settled(error: Sequence[float]) -> int | None:
    """The first level whose error is within a factor ``SETTLED`` of where the fall ends; None without one.

    An error that a finer level exceeds by more than that factor crosses zero by chance and is passed over.
    """
    found = np.asarray(error, dtype=float)
    monotone = _monotone(found)
    if not monotone.any():
        return None
    return int(np.argmax(monotone & (found <= SETTLED * found[-1])))


def order_of(resolution: Sequence[float], error: Sequence[float]) -> float | None:
    """Slope s of error ~ resolution^-s by least squares, down to the level where the error is ``settled``.

    Finer levels are left out, where another numerical parameter dominates. None where the error falls by
    less than the factor ``SETTLED``, or where the levels span less than the factor ``SPAN``.
    """
    last = settled(error)
    if not last:
        return None
    found = np.asarray(error, dtype=float)[: last + 1]
    used = _monotone(np.asarray(error, dtype=float))[: last + 1]
    N = np.asarray(resolution, dtype=float)[: last + 1][used]
    if N.size < 2 or not (np.isfinite(N) & (N > 0)).all() or N.max() < SPAN * N.min():
        return None
    return float(-np.polyfit(np.log(N), np.log(found[used]), 1)[0])


def _monotone(found: FloatArray) -> NDArray[np.bool_]:
    """Marks the errors that no finer level exceeds by more than ``SETTLED``; none where one is not finite."""
    if found.size < 2 or not np.isfinite(found).all() or found.min() < 0 or found.max() == 0:
        return np.zeros(found.shape, dtype=bool)
    largest_after = np.maximum.accumulate(found[::-1])[::-1]
    return (found > 0) & (SETTLED * found >= largest_after)


@dataclass(frozen=True, eq=False)
class Reference:
    """The exact solution of ``problem`` at the points of comparison, evaluated once."""

    problem: CoatedContact
    exact: Solution

    @cached_property
    def _disc(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """r = a sin(phi), which resolves the vertical tangent at the edge; weights of dA / (pi a^2); p."""
        s, w = gauss_legendre(96)
        phi = np.pi / 4 * (s + 1)
        r = self.exact.contact_radius * np.sin(phi)
        return r, np.pi / 2 * w * np.sin(phi) * np.cos(phi), self.exact.pressure(r)

    @cached_property
    def _stresses(self) -> list[tuple[FloatArray, FloatArray, int | None, FloatArray]]:
        """x, z, layer, stress along the axis, inside the layers, and along both sides of each interface."""
        a, deep = self.exact.contact_radius, self.problem.interfaces
        bounds = np.array([0.0, *deep, max([4 * a, *(2 * z for z in deep)])])
        z = (bounds[:-1, None] + np.diff(bounds)[:, None] * (np.arange(12) + 0.5) / 12).ravel()
        x = 2.5 * a * np.linspace(0, 1, 80)
        places: list[tuple[FloatArray, FloatArray, int | None]] = [(np.zeros_like(z), z, None)]
        for line in lines_of(self.problem):
            if line.layer is not None and line.depth:
                places.append((x, np.full_like(x, line.depth), line.layer))
        return [(x, z, layer, self.exact.stress(x, 0.0, z, layer)) for x, z, layer in places]

    def errors(self, found: Solution) -> dict[str, float]:
        """Error of each of ``QUANTITIES``: p0, a, approach relative, and

        pressure = [ int (p - p_exact)^2 dA / (pi a^2) ]^(1/2) / p0  over the disc of the exact radius a
        stress = max |sigma - sigma_exact| / p_h  on the axis and on both sides of each interface
        """
        exact, p0 = self.exact, self.exact.peak_pressure
        r, weight, p = self._disc
        # Square patches have eight mirror images of one sector.
        angle = np.pi / 4 * (np.arange(8) + 0.5) / 8
        error = found.pressure(r[:, None] * np.cos(angle), r[:, None] * np.sin(angle)) - p[:, None]
        worst = [np.abs(found.stress(x, 0.0, z, layer) - s).max() for x, z, layer, s in self._stresses]
        scalars = {
            ALL[q].symbol: abs(ALL[q].value(found, self.problem) / ALL[q].value(exact, self.problem) - 1)
            for q in SCALARS
        }
        return scalars | {
            "pressure": float(np.sqrt(weight @ np.mean(error**2, axis=1))) / p0,
            "stress": float(np.max(worst)) / self.problem.p_h,
        }


def refined_grid(
    problem: CoatedContact,
    patches: Sequence[int] = (33, 65, 129, 257),
    *,
    solid: str = "",
    setting: str = "",
    solve: Callable[..., Solution] | None = None,
    **numerics: Any,
) -> Refinement:
    """``problem`` by the semi-analytical method at each number of ``patches`` a side.

    The method's own estimate of its error is left out, since it needs further solutions.
    numerics : any other keyword of semianalytic.solve.   solve : another solver, see ``Source``.
    """
    steps = [(f"N = {n}", {"patches": n, **numerics}, float(n)) for n in patches]
    empty = Refinement("semianalytic", solid, setting, ())
    return _refined(problem, empty, solve or solve_semianalytic, steps)


def refined_mesh(
    problem: CoatedContact,
    order: int,
    quality: Sequence[str] = ("fast", "default"),
    *,
    solid: str = "",
    solve: Callable[..., Solution] | None = None,
) -> Refinement:
    """``problem`` by elements of ``order`` on meshes of each ``quality``; else as ``refined_grid``."""
    from fem_reference.solver import QUALITY

    steps = [(name, {"order": order, "size": QUALITY[name]}, None) for name in quality]
    empty = Refinement("fem_reference", solid, f"order {order}", ())
    return _refined(problem, empty, solve or solve_elements, steps)


def _refined(
    problem: CoatedContact,
    empty: Refinement,
    solve: Callable[..., Any],
    steps: Sequence[tuple[str, dict[str, Any], float | None]],
) -> Refinement:
    levels: list[Level] = []
    failure = None
    try:
        without = {"estimate_uncertainty": False}
        reference = Reference(problem, solve_exactly(problem, without))
        for name, numerics, resolution in steps:
            begin = time.perf_counter()
            found = solve(problem, numerics | without)
            seconds = time.perf_counter() - begin
            size = resolution or float(np.sqrt(found.diagnostics.dofs))
            levels.append(Level(name, size, seconds, reference.errors(found)))
    except Exception as error:  # a message of the report, not a traceback
        failure = f"{steps[len(levels)][0]}: {failure_message(error)}"
    return replace(empty, levels=tuple(levels), failure=failure)


def failure_message(error: Exception) -> str:
    """The message of ``error`` in one line."""
    return " ".join(str(error).split())[:400]
