"""Tasks side by side, each in a process of its own with a time limit.

A process ends with this one however that ends, and before it where memory ends: see ``confined``.
"""

import os
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from verification.cases.contact import Case
from verification.cases.published import PublishedCase
from verification.judging.verdict import Outcome
from verification.running import published
from verification.running.contact import failed
from verification.running.fields import read_fields
from verification.running.planes import plane_path, read_plane
from verification.running.pool import Task, run_tasks
from verification.running.provenance import fingerprint
from verification.running.result import CaseResult, describe, from_json, plain
from verification.running.store import StoreError, read_checked

__all__ = ["case_task", "kept_result", "published_task", "result_path", "run_cases"]


def result_path(folder: Path, case: Case | PublishedCase) -> Path:
    """Where the checked result of ``case`` lies in a run directory."""
    return folder / "cases" / f"{case.name}.json"


def case_task(case: Case, folder: Path, *, fields: bool = False) -> Task[CaseResult]:
    """Solving ``case`` with its result stored under ``folder``, and its ``fields`` where they are wanted."""
    path = result_path(folder, case)
    words = ["verification.running.worker", case.name, str(path), str(plane_path(folder, case.name))]
    if fields:
        words.append(str(folder))
    return Task(case.name, tuple(words), path, partial(_of, case), partial(failed, case), case.text.encode())


def published_task(case: PublishedCase, folder: Path) -> Task[CaseResult]:
    """Holding both methods against what ``case`` printed, its result stored under ``folder``."""
    path = result_path(folder, case)
    words = ("verification.running.published_worker", str(case.path), str(path))
    return Task(case.name, words, path, partial(_of, case), partial(published.failed, case))


def _of(case: Case | PublishedCase, data: dict[str, Any]) -> CaseResult:
    """The stored result of ``case``. Raises ValueError where it is that of another file or problem."""
    result = from_json(data)
    if (result.name, result.text, result.problem) != (case.name, case.text, plain(describe(case.problem))):
        raise ValueError(f"holds the result of another case file than {case.name} is now")
    return result


def kept_result(folder: Path, case: Case | PublishedCase, *, fields: bool = False) -> CaseResult | None:
    """The result of ``case`` in a run directory that need not be computed again; None where there is none.

    It is whole, of the same case file, made by the same code, and a result; so is what is drawn of it, and
    so are its ``fields`` where they are wanted.
    Raises StoreError, naming the file, where there is one that cannot be used.
    """
    path = result_path(folder, case)
    if not os.path.lexists(path):
        return None
    data = read_checked(path)
    if data.get("made_by") != fingerprint():
        raise StoreError(f"{path}: made by another version of this program")
    try:
        result = _of(case, data)
    except ValueError as error:
        raise StoreError(f"{path}: {error}") from None
    if isinstance(case, Case):
        read_plane(plane_path(folder, case.name), case.text)
        if fields:
            read_fields(folder, case.name, case.text)
    return result if result.outcome is not Outcome.NO_RESULT else None


def run_cases(cases: Sequence[Case], folder: Path, *, jobs: int, time_limit: float) -> list[CaseResult]:
    """Run ``cases`` as ``run_tasks`` does; their results in order, stored under ``folder``."""
    return run_tasks([case_task(case, folder) for case in cases], jobs=jobs, time_limit=time_limit)
