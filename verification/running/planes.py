"""Stored stresses of a case in the plane y = 0."""

from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

import numpy as np

from verification.problem.quantity import IN_PLANE
from verification.running.result import CaseResult, plain
from verification.running.store import StoreError, read_checked, write_checked
from verification.sampling.plane import Plane

__all__ = ["SCHEMA", "plane_path", "read_plane", "read_planes", "write_plane"]

SCHEMA = "coatcheck-plane/1"


def plane_path(folder: Path, name: str) -> Path:
    """Where the plane of the case called ``name`` lies in a run directory."""
    return folder / "planes" / f"{name}.json"


def write_plane(path: Path, plane: Plane, case_file: str) -> None:
    """Store ``plane`` with the case file it came from; nine digits, a billionth of the largest stress."""
    peaks = [float(np.max(np.abs(s))) for some in plane.stress.values() for s in some]
    largest = max((peak for peak in peaks if np.isfinite(peak)), default=0.0)
    digits = 0 if not largest > 0 else 9 - int(np.ceil(np.log10(largest)))
    content = {
        "schema": SCHEMA,
        "case_file": case_file,
        "x": plane.x.tolist(),
        "depths": [z.tolist() for z in plane.depths],
        "radius": plane.radius,
        "components": list(IN_PLANE),
        # NaN and infinity become text: what a method gave is kept, and the JSON stays strict.
        "stress": {name: [plain(np.round(s, digits)) for s in some] for name, some in plane.stress.items()},
        "failures": dict(plane.failures),
    }
    write_checked(path, content)


def read_plane(path: Path, case_file: str) -> Plane:
    """The plane stored at ``path``.

    Raises StoreError where it is missing, damaged or of another case file.
    """
    data = read_checked(path)
    if (data.get("schema"), data.get("case_file")) != (SCHEMA, case_file):
        raise StoreError(f"{path}: of another case file or version of this program; run the case again")
    try:
        return Plane(
            np.array(data["x"], dtype=float),
            tuple(np.array(z, dtype=float) for z in data["depths"]),
            float(data["radius"]),
            {
                str(name): tuple(np.array(s, dtype=float) for s in some)
                for name, some in data["stress"].items()
            },
            {str(name): str(sentence) for name, sentence in data["failures"].items()},
        )
    except (ValueError, KeyError, TypeError, AttributeError):
        raise StoreError(f"{path}: not a whole plane; it is damaged, run the case again") from None


def read_planes(folder: Path, results: Iterable[CaseResult]) -> dict[str, Plane]:
    """The planes that a run directory holds of ``results``, by name of the case."""
    found = {}
    for result in results:
        with suppress(StoreError):  # a case without a result, or printed, has no plane
            found[result.name] = read_plane(plane_path(folder, result.name), result.text)
    return found
