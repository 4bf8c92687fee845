"""Stored stresses of a case: the plane y = 0 for the report, files for ParaView.

Every file carries the case file it came from. Those for ParaView, a plane of the finite elements and boxes of
the semi-analytical method, have their checksums in a file beside them that checks itself.
"""

import hashlib
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from verification.cases.case_file import Case
from verification.problem.coated_contact import ContactSolution
from verification.running.case_result import CaseResult
from verification.running.checked_files import (
    MAX_BYTES,
    StoreError,
    read_bounded,
    read_checked,
    write_atomically,
    write_checked,
)
from verification.running.json_records import decode, encode
from verification.sampling.stress_plane import StressPlane
from verification.sampling.vtk_files import WRITERS
from verification.sources.source_registry import SOURCES

SCHEMA = "coatcheck-fields/1"
PLANE = "coatcheck-plane/2"


def plane_path(folder: Path, name: str) -> Path:
    """Path of the plane of the case called ``name`` in a run directory."""
    return folder / "planes" / f"{name}.json"


def write_plane(path: Path, plane: StressPlane, case_file: str) -> None:
    """Store ``plane`` with the case file it came from; nine digits, a billionth of the largest stress."""
    peaks = [float(np.max(np.abs(s))) for some in plane.stress.values() for s in some]
    largest = max((peak for peak in peaks if np.isfinite(peak)), default=0.0)
    digits = 0 if not largest > 0 else 9 - int(np.ceil(np.log10(largest)))
    stress = {name: tuple(np.round(s, digits) for s in some) for name, some in plane.stress.items()}
    content = {"schema": PLANE, "case_file": case_file, "plane": encode(replace(plane, stress=stress))}
    write_checked(path, content)


def read_plane(path: Path, case_file: str) -> StressPlane:
    """The plane stored at ``path``.

    Raises StoreError where it is missing, damaged or of another case file.
    """
    try:
        return decode(StressPlane, _content(path, PLANE, case_file).get("plane"))
    except ValueError:
        raise StoreError(f"{path}: not a whole plane; it is damaged, run the case again") from None


def read_planes(folder: Path, results: Iterable[CaseResult]) -> dict[str, StressPlane]:
    """The planes that a run directory holds of ``results``, by name of the case."""
    found = {}
    for result in results:
        with suppress(StoreError):  # neither a failed case nor a published one has a plane
            found[result.name] = read_plane(plane_path(folder, result.name), result.text)
    return found


def fields_path(folder: Path, name: str) -> Path:
    """Path of the checksums of the fields of the case called ``name`` in a run directory."""
    return folder / "fields" / f"{name}.json"


def write_fields(case: Case, solutions: Mapping[str, ContactSolution], folder: Path) -> None:
    """Write the fields of ``solutions`` into ``folder``/fields, the file of checksums last.

    NAME-fem.vtm : an index of NAME-fem-layer-K.vtr, the plane y = 0 of a layer each, so that what jumps at an
    interface has both its values; NAME-fem-far.vtm, the same ten times as wide; NAME-semi.vtm, boxes. All in
    um, z into the solid; fields "sigma_xx [Pa]" ..., "von_mises [Pa]", "displacement [m]", cells with their
    "layer".
    A method that fails leaves its message. Raises StoreError where files cannot be written.
    """
    path = fields_path(folder, case.name)
    written: dict[str, bytes] = {}
    failures: dict[str, str] = {}
    for source, solution in solutions.items():
        if SOURCES[source].fields:
            try:
                written |= WRITERS[SOURCES[source].fields](case, solution)
            except Exception as error:  # a result does not depend on its files for ParaView
                failures[source] = f"{type(error).__name__}: {' '.join(str(error).split())[:300]}"
    for name, data in written.items():
        write_atomically(path.parent / name, data)
    content = {
        "schema": SCHEMA,
        "case_file": case.text,
        "files": {name: hashlib.sha256(data).hexdigest() for name, data in written.items()},
        "failures": failures,
    }
    write_checked(path, content)


def confirm_fields(folder: Path, name: str, case_file: str) -> None:
    """Confirm the checksum of every file of the fields of the case ``name`` in a run directory.

    Raises StoreError, naming the file, where one is missing, damaged or of another ``case_file``.
    """
    path = fields_path(folder, name)
    for file, stated in _content(path, SCHEMA, case_file)["files"].items():
        place = path.parent / file
        if hashlib.sha256(read_bounded(place, MAX_BYTES)).hexdigest() != stated:
            raise StoreError(f"{place}: its checksum does not hold; run the case again with --fields")


def _content(path: Path, schema: str, case_file: str) -> dict[str, Any]:
    data = read_checked(path)
    if (data.get("schema"), data.get("case_file")) != (schema, case_file):
        raise StoreError(f"{path}: of another case file or version of this program; run the case again")
    return data
