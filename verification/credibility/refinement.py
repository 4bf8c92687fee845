"""How the error of each method against an exact answer falls with its resolution.

Pure: a problem in, frozen records out. A ladder that stops short keeps the levels it reached and the
sentence it failed with.
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from verification.problem.arrays import FloatArray
from verification.problem.contact import CoatedContact, Solution
from verification.problem.profile import lines_of
from verification.problem.quantity import QUANTITIES as ALL
from verification.problem.quantity import SCALARS
from verification.sources.exact import solve_exactly
from verification.sources.methods import solve_elements, solve_semianalytic

__all__ = ["QUANTITIES", "Ladder", "Level", "Yardstick", "elements", "ladder", "order_of", "settled"]

QUANTITIES = (*(ALL[name].symbol for name in SCALARS), "pressure", "stress")
# An error within this factor of the smallest of its ladder has stopped falling.
SETTLED = 3.0
# Between two levels much closer than a doubling, noise looks like an order.
SPAN = 1.9


@dataclass(frozen=True)
class Level:
    """One solution: its ``resolution``, what it cost, its error by quantity.

    resolution : patches a side, or the square root of the degrees of freedom of finite elements.
    errors : of p0, a and approach relative; of pressure (L2 over the disc) over p0; of stress over p_h.
    """

    name: str
    resolution: float
    seconds: float
    errors: dict[str, float]


@dataclass(frozen=True)
class Ladder:
    """Solutions of one problem by one ``method`` in one setting, coarse to fine.

    solid : what the sphere is pressed on, in words.   failure : the sentence the next level failed with.
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
            [level.resolution for level in self.levels], [level.errors[quantity] for level in self.levels]
        )


def settled(error: Sequence[float]) -> int | None:
    """The first level whose error is within a factor ``SETTLED`` of where the fall ends; None without one.

    An error that a finer level exceeds by more than that factor crosses zero by luck and is passed over.
    """
    found = np.asarray(error, dtype=float)
    honest = _honest(found)
    if not honest.any():
        return None
    return int(np.argmax(honest & (found <= SETTLED * found[-1])))


def order_of(resolution: Sequence[float], error: Sequence[float]) -> float | None:
    """Slope s of error ~ resolution^-s by least squares, down to the level where the error is ``settled``.

    Finer levels are left out, for there another knob has taken over, and so is luck. None where the error
    falls less than by the factor ``SETTLED``, or within a ``SPAN`` of resolution too short to tell.
    """
    last = settled(error)
    if not last:
        return None
    found = np.asarray(error, dtype=float)[: last + 1]
    used = _honest(np.asarray(error, dtype=float))[: last + 1]
    N = np.asarray(resolution, dtype=float)[: last + 1][used]
    if N.size < 2 or not (np.isfinite(N) & (N > 0)).all() or N.max() < SPAN * N.min():
        return None
    return float(-np.polyfit(np.log(N), np.log(found[used]), 1)[0])


def _honest(found: FloatArray) -> NDArray[np.bool_]:
    """Marks the errors that no finer level exceeds by more than ``SETTLED``; none where one is no number."""
    if found.size < 2 or not np.isfinite(found).all() or found.min() < 0 or found.max() == 0:
        return np.zeros(found.shape, dtype=bool)
    largest_after = np.maximum.accumulate(found[::-1])[::-1]
    return (found > 0) & (SETTLED * found >= largest_after)


@dataclass(frozen=True, eq=False)
class Yardstick:
    """The exact answer to ``problem`` at the points where solutions are held against it, evaluated once."""

    problem: CoatedContact
    exact: Solution

    @cached_property
    def _disc(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """r = a sin(phi), which resolves the vertical tangent at the edge; weights of dA / (pi a^2); p."""
        s, w = np.polynomial.legendre.leggauss(96)
        phi = np.pi / 4 * (s + 1)
        r = self.exact.contact_radius * np.sin(phi)
        return r, np.pi / 2 * w * np.sin(phi) * np.cos(phi), self.exact.pressure(r)

    @cached_property
    def _stressed(self) -> list[tuple[FloatArray, FloatArray, int | None, FloatArray]]:
        """x, z, layer, stress along the axis, inside the layers, and along both sides of each interface."""
        a, deep = self.exact.contact_radius, self.problem.interfaces
        bounds = np.array([0.0, *deep, max([4 * a, *(2 * z for z in deep)])])
        z = (bounds[:-1, None] + np.diff(bounds)[:, None] * (np.arange(12) + 0.5) / 12).ravel()
        x = 2.5 * a * np.linspace(0, 1, 26)
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
        turn = np.pi / 4 * (np.arange(8) + 0.5) / 8
        gap = found.pressure(r[:, None] * np.cos(turn), r[:, None] * np.sin(turn)) - p[:, None]
        worst = [np.abs(found.stress(x, 0.0, z, layer) - s).max() for x, z, layer, s in self._stressed]
        scalars = {
            ALL[q].symbol: abs(ALL[q].value(found, self.problem) / ALL[q].value(exact, self.problem) - 1)
            for q in SCALARS
        }
        return scalars | {
            "pressure": float(np.sqrt(weight @ np.mean(gap**2, axis=1))) / p0,
            "stress": float(np.max(worst)) / self.problem.p_h,
        }


def ladder(
    problem: CoatedContact,
    patches: Sequence[int] = (33, 65, 129, 257),
    *,
    solid: str = "",
    setting: str = "",
    solve: Callable[..., Solution] | None = None,
    **numerics: Any,
) -> Ladder:
    """``problem`` by the semi-analytical method at each number of ``patches`` a side.

    Without the method's own estimate of its error, for which it would solve again.
    numerics : any other keyword of semianalytic.solve.   solve : another solver, see ``Source``.
    """
    steps = [(f"N = {n}", {"patches": n, **numerics}, float(n)) for n in patches]
    return _climb(problem, "semianalytic", solid, setting, solve or solve_semianalytic, steps)


def elements(
    problem: CoatedContact,
    order: int,
    quality: Sequence[str] = ("fast", "default"),
    *,
    solid: str = "",
    solve: Callable[..., Solution] | None = None,
) -> Ladder:
    """``problem`` by elements of ``order`` on meshes of each ``quality``; ``solve`` as in ``ladder``."""
    steps = [(name, {"order": order, "quality": name}, None) for name in quality]
    return _climb(problem, "fem_reference", solid, f"order {order}", solve or solve_elements, steps)


def _climb(
    problem: CoatedContact,
    method: str,
    solid: str,
    setting: str,
    solve: Callable[..., Any],
    steps: Sequence[tuple[str, dict[str, Any], float | None]],
) -> Ladder:
    levels: list[Level] = []
    try:
        without = {"estimate_uncertainty": False}
        yardstick = Yardstick(problem, solve_exactly(problem, without))
        for name, numerics, resolution in steps:
            begin = time.perf_counter()
            found = solve(problem, numerics | without)
            seconds = time.perf_counter() - begin
            if resolution is None:
                resolution = float(np.sqrt(found.diagnostics.dofs))
            levels.append(Level(name, resolution, seconds, yardstick.errors(found)))
    except Exception as error:  # a level that cannot be had is a sentence of the report, not a traceback
        name = steps[len(levels)][0]
        return Ladder(method, solid, setting, tuple(levels), f"{name}: {' '.join(str(error).split())[:400]}")
    return Ladder(method, solid, setting, tuple(levels))
