"""Error of formulas against the exact solution: effective moduli and limits."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import least_squares, minimize_scalar

from verification.problem.array_types import Array
from verification.running.checked_files import write_checked
from verification.running.json_records import decode, encode
from verification.running.pool.pool_task import Task
from verification.sources.references.effective_modulus import (
    FORMULAS,
    I0,
    I1,
    PERRIOT_BARTHEL_N,
    perriot_barthel,
    perriot_barthel_x0,
)
from verification.sources.references.flat_punch import pressed
from verification.sources.references.layer_limits import spring_bed, squeezed_film, thick
from verification.study.usual_correction import BallCurve, curves

Rows = tuple[tuple[float, ...], ...]

SCHEMA = "coatcheck-effective/4"
NU = 0.3  # of film and substrate on the map
RIGID = (1e9, 0.3)  # under a layer of 1 Pa
# Fewer nodes than usual: 1e-8 of kappa on the map.
NODES, TAIL = 24, 14.0


@dataclass(frozen=True)
class Limit:
    """One curve of a limit: exact over limit, less 1, over a/h.

    panel : the quantity and the limit.   name : the solid.
    """

    panel: str
    name: str
    a_over_h: tuple[float, ...]
    excess: tuple[float, ...]


@dataclass(frozen=True)
class EffectiveStudy:
    """E_eff/E2* over ``ratio`` = E1/E2 (rows) and ``thickness`` = h/a, exact and by each of ``formulas``.

    weights : largest error of Gao's I0 and I1 against the exact first derivatives.
    refitted : E1/E2, x0 of Perriot and Barthel, x0 and n fitted to the exact solution, a row for each ratio.
    balls : contacts with an elastic ball against the usual correction.
    """

    ratio: tuple[float, ...] = ()
    thickness: tuple[float, ...] = ()
    exact: Rows = ()
    formulas: tuple[tuple[str, Rows], ...] = ()
    limits: tuple[Limit, ...] = ()
    weights: tuple[float, ...] = ()
    refitted: tuple[tuple[float, ...], ...] = ()
    balls: tuple[BallCurve, ...] = ()
    seconds: float = 0.0
    failure: str = ""


def measure(points: int = 21) -> EffectiveStudy:
    """The whole study, on a map of ``points`` x ``points``."""
    started = time.perf_counter()
    ratio, thickness = np.logspace(-2, 2, points), np.logspace(np.log10(0.05), np.log10(20), points)
    exact = np.array([[_effective(r, NU, h) for h in thickness] for r in ratio])
    scale = 1 / (1 - NU**2)
    maps = [
        (f.name, _rows(np.array([f.modulus((r, NU), (1.0, NU), thickness) for r in ratio]) / scale))
        for f in FORMULAS
    ]
    theirs, refitted = _perriot_barthel(ratio, thickness, exact)
    maps.insert(1, ("Perriot and Barthel 2004", _rows(theirs / scale)))
    return EffectiveStudy(
        ratio=tuple(ratio.tolist()),
        thickness=tuple(thickness.tolist()),
        exact=_rows(exact / scale),
        formulas=tuple(maps),
        limits=(*_thin(), *_thick()),
        weights=_weights(),
        refitted=refitted,
        balls=curves(),
        seconds=time.perf_counter() - started,
    )


def _effective(ratio: float, nu: float, h: float, base: float = NU) -> float:
    """E_eff = S/2a at a = 1 of a film of modulus ``ratio`` on a substrate of modulus 1."""
    return ratio / (1 - nu**2) * pressed(1.0, ((ratio, nu, h),), (1.0, base), NODES, TAIL).kappa


def _weights() -> tuple[float, float]:
    """Error of Gao's I0 and I1 against differences of the exact stiffness about the homogeneous solid."""
    step, first, second = 1e-4, [], []
    for nu in (0.0, NU):
        for h in (0.2, 1.0, 4.0):
            up, down = (np.log(_effective(1 + s, nu, h, nu)) for s in (step, -step))
            first.append(abs((up - down) / np.log((1 + step) / (1 - step)) - I0(np.array(h), nu)))
            # A change of nu at constant shear modulus, of the film alone and of the whole solid.
            at = nu + 2 * step
            film = [np.log(_stiffness(at + s, at, h)) for s in (step, -step)]
            whole = [np.log(_stiffness(at + s, at + s, h)) for s in (step, -step)]
            second.append(abs((film[0] - film[1]) / (whole[0] - whole[1]) - I1(np.array(h))))
    return float(max(first)), float(max(second))


def _stiffness(nu1: float, nu2: float, h: float) -> float:
    """E_eff of two materials of one shear modulus."""
    E1, E2 = 2 * (1 + nu1), 2 * (1 + nu2)
    return E1 / (1 - nu1**2) * pressed(1.0, ((E1, nu1, h),), (E2, nu2)).kappa


def _perriot_barthel(ratio: Array, thickness: Array, exact: Array) -> tuple[Array, Rows]:
    """Their map, for each ratio with the n within their bounds of the smallest error; for each ratio E1/E2,
    their x0, then x0 and n fitted to the exact solution by least squares."""
    table, fits = np.empty_like(exact), []
    for i, r in enumerate(ratio.tolist()):
        film, base = (r, NU), (1.0, NU)

        def largest(n: float, film: Any = film, row: Array = exact[i]) -> float:
            return float(np.abs(perriot_barthel(film, (1.0, NU), thickness, n) / row - 1).max())

        best = minimize_scalar(largest, bounds=PERRIOT_BARTHEL_N, method="bounded").x
        table[i] = perriot_barthel(film, base, thickness, float(best))
        if abs(np.log(r)) < 1e-9:
            continue
        share = (exact[i] * (1 - NU**2) - r) / (1 - r)

        def misfit(c: Array, share: Array = share) -> Array:
            return np.asarray(1 / (1 + (10 ** c[0] * thickness) ** c[1]) - share)

        theirs = perriot_barthel_x0(1 / r)
        fit = least_squares(misfit, (np.log10(theirs), 1.2))
        fits.append((r, theirs, float(10 ** fit.x[0]), float(fit.x[1])))
    return table, tuple(fits)


def _thin() -> list[Limit]:
    a = np.geomspace(0.5, 50, 15)
    found = []
    for nu in (0.0, 0.3, 0.45, 0.5):
        exact = [pressed(r, ((1.0, nu, 1.0),), RIGID) for r in a]
        law = [squeezed_film(r, 1.0, 1.0) if nu == 0.5 else spring_bed(r, 1.0, nu, 1.0) for r in a]
        for panel, n in (("stiffness, thin layer", 0), ("load of the sphere, thin layer", 1)):
            stiffness = [2 * r * one.kappa / (1 - nu**2) for r, one in zip(a, exact, strict=True)]
            value = [one.load for one in exact] if n else stiffness
            found.append(_limit(panel, f"nu = {nu:g}", a, value, [by_law[n] for by_law in law]))
    return found


def _thick() -> list[Limit]:
    a = np.geomspace(0.02, 2, 15)
    found = []
    for ratio in (0.25, 0.5, 2.0, 4.0):
        layer, base = ((ratio, NU, 1.0),), (1.0, NU)
        exact = [pressed(r, layer, base, NODES, TAIL).kappa for r in a]
        laws = [thick(r, layer, base) for r in a]
        for n, law in enumerate(("Hertz", "first correction")):
            panel, values = f"stiffness, thick coating: {law}", [by_law[n] for by_law in laws]
            found.append(_limit(panel, f"E1/E2 = {ratio:g}", a, exact, values))
    return found


def _limit(panel: str, name: str, a: Array, exact: Sequence[float], law: Sequence[float]) -> Limit:
    excess = tuple(float(one / by_law - 1) for one, by_law in zip(exact, law, strict=True))
    return Limit(panel, name, tuple(a.tolist()), excess)


def _rows(table: Array) -> Rows:
    return tuple(tuple(row) for row in table.tolist())


def task(folder: Path) -> Task[EffectiveStudy]:
    """The study as a task beside the cases of a run."""
    path = folder / "effective-modulus.json"
    return Task("effective moduli", partial(main, path), path, from_json, _failed)


def _failed(reason: str, seconds: float) -> EffectiveStudy:
    return EffectiveStudy(failure=reason, seconds=seconds)


def to_json(study: EffectiveStudy) -> dict[str, Any]:
    """The study as strict JSON."""
    return {"schema": SCHEMA, **encode(study)}


def from_json(data: dict[str, Any]) -> EffectiveStudy:
    """The inverse of ``to_json``. Raises ValueError for another schema or a field that does not fit."""
    if data.get("schema") != SCHEMA:
        raise ValueError(f"schema = {data.get('schema')!r}; this version reads {SCHEMA!r}, run it again")
    return decode(EffectiveStudy, data)


def main(path: Path) -> None:
    """Measure and store at ``path``."""
    write_checked(path, to_json(measure()))
