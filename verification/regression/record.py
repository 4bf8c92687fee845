"""The baseline as one checked file, its numbers to twelve digits."""

from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from verification.regression.baseline import Baseline, Update
from verification.regression.drift import Numbers
from verification.running.records import plain
from verification.running.store import StoreError, read_checked, write_checked

__all__ = ["path_in", "read_baseline", "write_baseline"]

SCHEMA = "coatcheck-baseline/1"


def path_in(folder: Path) -> Path:
    """Where the baseline of ``folder`` lies."""
    return folder / "baseline.json"


def write_baseline(folder: Path, baseline: Baseline) -> Path:
    """Store the baseline in ``folder``, whole or not at all, to twelve digits. Raises StoreError."""
    path = path_in(folder)
    cases = {
        name: {
            "digest": baseline.digests[name],
            # Every profile of a line has the same points.
            "lines": {n.line: _row(n.position, float(np.abs(n.position).max())) for n in found},
            "profiles": [_profile(n) for n in found],
        }
        for name, found in baseline.cases.items()
    }
    history = [asdict(update) for update in baseline.history]
    write_checked(path, plain({"schema": SCHEMA, "cases": cases, "history": history}))
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
        return Baseline(
            {
                name: tuple(_numbers(p, case["lines"][p["line"]]) for p in case["profiles"])
                for name, case in data["cases"].items()
            },
            {name: str(case["digest"]) for name, case in data["cases"].items()},
            tuple(
                Update(**{**u, "changes": {n: (int(k), c) for n, (k, c) in u["changes"].items()}})
                for u in data["history"]
            ),
        )
    except (KeyError, TypeError, ValueError) as error:
        raise StoreError(f"{path}: not a baseline ({error}); restore it or update it") from None


def _profile(numbers: Numbers) -> dict[str, Any]:
    return {
        "source": numbers.source,
        "quantity": numbers.quantity,
        "line": numbers.line,
        "size": numbers.size,
        "scale": _shortened(numbers.scale, numbers.scale),
        "rms": _shortened(numbers.rms, numbers.scale),
        "U": None if numbers.uncertainty is None else float(f"{numbers.uncertainty:.3g}"),
        "value": _row(numbers.value, numbers.scale),
    }


def _numbers(data: dict[str, Any], position: list[Any]) -> Numbers:
    return Numbers(
        str(data["source"]),
        str(data["quantity"]),
        str(data["line"]),
        np.array([float(x) for x in position]),
        np.array([float(v) for v in data["value"]]),
        float(data["scale"]),
        float(data["rms"]),
        int(data["size"]),
        None if data["U"] is None else float(data["U"]),
    )


def _row(values: NDArray[np.float64], scale: float) -> list[float]:
    return [_shortened(value, scale) for value in values.tolist()]


def _shortened(value: float, scale: float) -> float:
    """``value`` to twelve digits of ``scale``: what lies below is never looked at."""
    if abs(value) <= 1e-12 * scale:
        return 0.0
    if not np.isfinite(value):
        return value
    digits = 13 + min(0, int(np.floor(np.log10(abs(value) / scale)))) if scale else 13
    return float(f"{value:.{max(digits, 1)}g}")
