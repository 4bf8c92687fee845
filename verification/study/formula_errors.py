"""Error of formulas: effective moduli, and the usual correction for an elastic ball.

The usual correction takes the ball into account by E* of the substrates alone: a, p0 and stresses are those
over the scales a_h, p_h of the coated flat under a rigid sphere, at the same h/a_h and E1/E2, with

    1/E* = (1 - nu_f^2)/E_f + (1 - nu_b^2)/E_b

in the scales. It is exact for uncoated bodies and for a rigid ball. By the exact reference, nu = 0.3.
"""

import time
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact
from verification.running.checked_files import write_checked
from verification.running.json_records import decode, encode
from verification.running.pool.pool_task import Task
from verification.sources.exact_sources import solve_exactly
from verification.sources.references.effective_modulus import FORMULAS, PERRIOT_BARTHEL_N, perriot_barthel
from verification.sources.references.flat_punch import pressed

COATINGS = (4.0, 0.25)  # E1/E2 of the coating on the flat
THICKNESSES = (0.1, 0.5, 1.0)  # h / a_h
FRICTION = 0.25
QUANTITIES = ("p0 / p_h", "a / a_h", "sigma_xx(-a) / p_h")


@dataclass(frozen=True)
class BallCurve:
    """``value`` of ``quantity`` over ``ratio`` = E_ball/E_flat; ``usual`` is that by the usual correction.

    coating : E1/E2.   thickness : h/a_h.
    """

    quantity: str
    coating: float
    thickness: float
    ratio: tuple[float, ...]
    value: tuple[float, ...]
    usual: float


def curves(points: int = 13) -> tuple[BallCurve, ...]:
    """Curves of peak pressure, contact radius, tension at the trailing edge; E_ball/E_flat from 0.1 to 100.

    points : of each curve.
    """
    ratio = np.geomspace(0.1, 100, points).tolist()
    found = []
    for coating in COATINGS:
        for thickness in THICKNESSES:
            values = [_numbers(coating, thickness, r) for r in ratio]
            for i, (name, usual) in enumerate(
                zip(QUANTITIES, _numbers(coating, thickness, None), strict=True)
            ):
                along = tuple(value[i] for value in values)
                found.append(BallCurve(name, coating, thickness, tuple(ratio), along, usual))
    return tuple(found)


def _numbers(coating: float, thickness: float, ratio: float | None) -> tuple[float, float, float]:
    """p0/p_h, a/a_h and sigma_xx(-a, 0, 0)/p_h; ``ratio`` None is the rigid ball."""
    E, nu = 210e9, 0.3
    bare = CoatedContact(10e-3, 20.0, (), (E, nu), FRICTION, None if ratio is None else (ratio * E, nu, ()))
    problem = replace(bare, coatings=((coating * E, nu, thickness * bare.a_h),))
    found = solve_exactly(problem, {"estimate_uncertainty": False})
    a = found.contact_radius
    tension = found.stress(np.array([-a]), 0.0, 0.0, layer=0)[0, 0, 0]
    return found.peak_pressure / bare.p_h, a / bare.a_h, float(tension) / bare.p_h


Rows = tuple[tuple[float, ...], ...]

SCHEMA = "coatcheck-effective/4"
NU = 0.3  # of film and substrate on the map
# Fewer nodes than usual: 1e-8 of kappa on the map.
NODES, TAIL = 24, 14.0


@dataclass(frozen=True)
class EffectiveStudy:
    """E_eff/E2* over ``ratio`` = E1/E2 (rows) and ``thickness`` = h/a, exact and by each of ``formulas``.

    balls : contacts with an elastic ball against the usual correction.
    """

    ratio: tuple[float, ...] = ()
    thickness: tuple[float, ...] = ()
    exact: Rows = ()
    formulas: tuple[tuple[str, Rows], ...] = ()
    balls: tuple[BallCurve, ...] = ()
    seconds: float = 0.0
    failure: str = ""


def measure(points: int = 21) -> EffectiveStudy:
    """The whole study, on a map of ``points`` x ``points``."""
    started = time.perf_counter()
    ratio, thickness = np.logspace(-2, 2, points), np.logspace(np.log10(0.05), np.log10(20), points)
    # E_eff = S/2a at a = 1 of a film on a substrate of modulus 1.
    punch = [[pressed(1.0, ((r, NU, h),), (1.0, NU), NODES, TAIL).kappa for h in thickness] for r in ratio]
    exact = ratio[:, None] / (1 - NU**2) * np.array(punch)
    tables = [(f.name, np.array([f.modulus((r, NU), (1.0, NU), thickness) for r in ratio])) for f in FORMULAS]
    theirs = np.array([_perriot_barthel(float(r), thickness, e) for r, e in zip(ratio, exact, strict=True)])
    tables.insert(1, ("Perriot and Barthel 2004", theirs))
    scale = 1 / (1 - NU**2)
    return EffectiveStudy(
        ratio=tuple(ratio.tolist()),
        thickness=tuple(thickness.tolist()),
        exact=_rows(exact / scale),
        formulas=tuple((name, _rows(table / scale)) for name, table in tables),
        balls=curves(),
        seconds=time.perf_counter() - started,
    )


def _perriot_barthel(ratio: float, thickness: Array, exact: Array) -> Array:
    """E_eff by their formula, with the n within their bounds of the smallest error."""

    def formula(n: float) -> Array:
        return perriot_barthel((ratio, NU), (1.0, NU), thickness, n)

    def largest(n: float) -> float:
        return float(np.abs(formula(n) / exact - 1).max())

    return formula(float(minimize_scalar(largest, bounds=PERRIOT_BARTHEL_N, method="bounded").x))


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
