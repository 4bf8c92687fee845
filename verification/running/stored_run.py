"""Stored results: that of one case, which need not be computed again, and a run by its report.json."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from verification.running.case_result import CaseResult, RunInfo, describe, from_json, to_json
from verification.running.checked_files import StoreError, read_bounded, read_checked, write_checked
from verification.running.json_records import decode, plain
from verification.running.provenance import fingerprint

MAX_BYTES = 1_000_000_000  # of all the results of a run: half a megabyte a case, up to 3 with an elastic ball


def write_result(path: Path, result: CaseResult) -> None:
    """Store ``result`` with the fingerprint of the code that made it."""
    write_checked(path, to_json(result) | {"made_by": fingerprint()})


def result_of(case: Any, data: dict[str, Any]) -> CaseResult:
    """The stored result of ``case``. Raises ValueError where it is that of another file or problem."""
    result = from_json(data)
    if (result.name, result.text, result.problem) != (case.name, case.text, plain(describe(case.problem))):
        raise ValueError(f"holds the result of another case file than {case.name} is now")
    return result


def read_stored(path: Path, case: Any) -> CaseResult:
    """The result of ``case`` at ``path``, made by this code.

    Raises StoreError, naming the file, where there is none that can be used.
    """
    data = read_checked(path)
    if data.get("made_by") != fingerprint():
        raise StoreError(f"{path}: made by another version of this program")
    try:
        return result_of(case, data)
    except ValueError as error:
        raise StoreError(f"{path}: {error}") from None


@dataclass(frozen=True, eq=False)
class StoredRun:
    """The ``results`` of a run with its provenance; ``path`` is that of its report.json."""

    path: Path
    info: RunInfo
    results: tuple[CaseResult, ...]

    def result(self, name: str) -> CaseResult | None:
        """The result of the case ``name``; None where the run has none."""
        return next((result for result in self.results if result.name == name), None)


def read_run(place: Path) -> StoredRun:
    """The run in the directory ``place``, or in the report.json ``place`` itself.

    Raises StoreError with a message that names the file.
    """
    path = place / "report.json" if place.is_dir() else place
    try:
        raw = read_bounded(path, MAX_BYTES)
    except StoreError as error:
        raise StoreError(f"{error}; give the directory of a run, or its report.json") from None
    try:
        data = json.loads(raw)
        return StoredRun(path, decode(RunInfo, data["run"]), tuple(from_json(case) for case in data["cases"]))
    except (ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError) as error:
        reason = " ".join(str(error).split())[:120]
        raise StoreError(f"{path}: not a report of this program ({reason}); run the cases again") from None


def confirm(run: StoredRun) -> None:
    """Raises StoreError where a case of the report is not the one stored beside it with its checksum."""
    for result in run.results:
        path = run.path.parent / "cases" / f"{result.name}.json"
        if to_json(from_json(read_checked(path))) != to_json(result):
            raise StoreError(f"{path}: of another run than {run.path}; run the cases again")
