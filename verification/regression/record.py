"""The baseline as one checked file, its numbers to twelve digits."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from verification.problem.arrays import Array
from verification.regression.baseline import Baseline, Update
from verification.regression.drift import Numbers
from verification.running.records import decode, encode
from verification.running.store import StoreError, read_checked, write_checked

SCHEMA = "coatcheck-baseline/1"


@dataclass(frozen=True, eq=False)
class _Profile:
    """``Numbers`` without its points, which all profiles of a line share; U is the uncertainty."""

    source: str
    quantity: str
    line: str
    size: int
    scale: float
    rms: float
    U: float | None
    value: Array


@dataclass(frozen=True, eq=False)
class _Case:
    digest: str
    lines: dict[str, Array]
    profiles: tuple[_Profile, ...]


@dataclass(frozen=True, eq=False)
class _File:
    schema: str
    cases: dict[str, _Case]
    history: tuple[Update, ...]


def path_in(folder: Path) -> Path:
    """Path of the baseline in ``folder``."""
    return folder / "baseline.json"


def write_baseline(folder: Path, baseline: Baseline) -> Path:
    """Store the baseline in ``folder``, whole or not at all, to twelve digits. Raises StoreError."""
    path = path_in(folder)
    cases = {
        name: _Case(
            baseline.digests[name],
            {n.line: _rounded(n.position, float(np.abs(n.position).max())) for n in found},
            tuple(_stored(n) for n in found),
        )
        for name, found in baseline.cases.items()
    }
    write_checked(path, encode(_File(SCHEMA, cases, baseline.history)))
    return path


def read_baseline(folder: Path) -> Baseline | None:
    """The baseline in ``folder``, None where there is none. Raises StoreError where it is damaged."""
    path = path_in(folder)
    if not path.exists():
        return None
    data = read_checked(path)
    if data.get("schema") != SCHEMA:
        raise StoreError(f"{path}: schema = {data.get('schema')!r}; this version reads {SCHEMA!r}")
    try:
        file = decode(_File, data)
        numbers = {name: tuple(_numbers(p, c) for p in c.profiles) for name, c in file.cases.items()}
    except (KeyError, ValueError) as error:
        raise StoreError(f"{path}: not a baseline ({error}); restore it or update it") from None
    return Baseline(numbers, {name: case.digest for name, case in file.cases.items()}, file.history)


def _stored(n: Numbers) -> _Profile:
    uncertainty = None if n.uncertainty is None else float(f"{n.uncertainty:.3g}")
    scale, rms = _rounded(np.array([n.scale, n.rms]), n.scale).tolist()
    return _Profile(n.source, n.quantity, n.line, n.size, scale, rms, uncertainty, _rounded(n.value, n.scale))


def _numbers(p: _Profile, case: _Case) -> Numbers:
    position = case.lines[p.line]
    return Numbers(p.source, p.quantity, p.line, position, p.value, p.scale, p.rms, p.size, p.U)


def _rounded(values: Array, scale: float) -> Array:
    """``values`` to twelve digits of ``scale``, smaller ones as zero."""
    return np.array([_to_twelve_digits(value, scale) for value in values.tolist()])


def _to_twelve_digits(value: float, scale: float) -> float:
    if abs(value) <= 1e-12 * scale:
        return 0.0
    if not np.isfinite(value):
        return value
    digits = 13 + min(0, int(np.floor(np.log10(abs(value) / scale)))) if scale else 13
    return float(f"{value:.{max(digits, 1)}g}")
