"""The baseline as one compressed file, its numbers to a hundredth of what counts as a change."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from verification.problem.array_types import Array
from verification.regression.baseline_change import Baseline, RecordedCase, Update
from verification.regression.manifest import Manifest
from verification.regression.number_drift import RELATIVE, TOLERANCE, Numbers
from verification.running.checked_files import StoreError
from verification.running.json_records import RecordFile

DIGITS = 0.01  # of the least change that counts


@dataclass(frozen=True, eq=False)
class _Profile:
    """``Numbers`` without its points, which all profiles of a line share.

    value : whole multiples of ``step`` [SI].   U : uncertainty to two digits.
    """

    source: str
    quantity: str
    line: str
    scale: float
    step: float
    value: Array
    U: Array | None


@dataclass(frozen=True, eq=False)
class _Case:
    digest: str
    manifest: Manifest
    lines: dict[str, Array]
    profiles: tuple[_Profile, ...]


@dataclass(frozen=True, eq=False)
class _BaselineFile:
    cases: dict[str, _Case]
    history: tuple[Update, ...]
    self_tests: dict[str, int] = field(default_factory=dict)


_FILE = RecordFile(
    _BaselineFile, "baseline.json.xz", ("coatcheck-baseline/2",), "the baseline", "restore it or update it"
)


def path_in(folder: Path) -> Path:
    """Path of the baseline in ``folder``."""
    return _FILE.path_in(folder)


def write_baseline(folder: Path, baseline: Baseline) -> Path:
    """Store the baseline in ``folder``, whole or not at all. Raises StoreError.

    Raises ValueError where two profiles have one key, or a line has two sets of points.
    """
    cases = {
        name: _Case(c.digest, c.manifest, points_by_line(name, c.numbers), tuple(map(_profile, c.numbers)))
        for name, c in baseline.cases.items()
    }
    return _FILE.write(folder, _BaselineFile(cases, baseline.history, dict(baseline.self_tests)))


def read_baseline(folder: Path) -> Baseline | None:
    """The baseline in ``folder``, None where there is none. Raises StoreError where it is damaged."""
    file = _FILE.read(folder)
    if file is None:
        return None
    try:
        cases = {
            name: RecordedCase(c.digest, c.manifest, tuple(_numbers(p, c) for p in c.profiles))
            for name, c in file.cases.items()
        }
    except KeyError as error:
        raise StoreError(f"{path_in(folder)}: no points of line {error}; restore it or update it") from None
    return Baseline(cases, file.history, file.self_tests)


def points_by_line(case: str, found: tuple[Numbers, ...]) -> dict[str, Array]:
    """The points of each line of a case."""
    lines: dict[str, Array] = {}
    for n in found:
        there = lines.setdefault(n.line, _digits(n.position, 12))
        if there.shape != n.position.shape or not np.allclose(there, n.position, rtol=1e-11, atol=0):
            raise ValueError(f"{case}: line {n.line!r} has other points for {n.quantity}; name it otherwise")
    if len({n.key for n in found}) < len(found):
        raise ValueError(f"{case}: two profiles have the same source, quantity and line; name lines apart")
    return lines


def _profile(n: Numbers) -> _Profile:
    U = None if n.uncertainty is None else _digits(n.uncertainty, 2)
    least = RELATIVE * n.scale if n.uncertainty is None else float(np.min(n.uncertainty))
    step = DIGITS * min(max(least, TOLERANCE * n.scale), RELATIVE * n.scale)
    # No step of a scale that is 0, NaN or infinite.
    step = float(f"{step:.3g}") if 0 < step < np.inf else 1.0
    return _Profile(n.source, n.quantity, n.line, n.scale, step, np.round(n.value / step), U)


def _numbers(p: _Profile, case: _Case) -> Numbers:
    return Numbers(p.quantity, p.line, case.lines[p.line], p.value * p.step, p.source, p.U, p.scale)


def _digits(values: Array, digits: int) -> Array:
    return np.array([float(f"{value:.{digits}g}") for value in values.tolist()])
