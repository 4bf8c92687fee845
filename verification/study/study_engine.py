"""A study from its plan to its table.

Processes answer the requests and store each answer before it is counted. The table is written whole from the
stored answers in the order of the points, so that it depends neither on the order of the answers nor on
interruptions.
"""

import math
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass, field
from functools import partial
from itertools import groupby
from pathlib import Path
from statistics import median
from typing import Any

from verification.running.checked_files import StoreError, locked
from verification.running.pool.pool_task import Task
from verification.running.pool.process_pool import run_tasks
from verification.sources.source_registry import SOURCES as RECORDS
from verification.study.solve_cache import read_answer, stored_path, write_answer
from verification.study.study_plan import Solve, Study
from verification.study.study_point import answer, failed_rows, table_rows
from verification.study.study_table import SOURCES, write_table

USUAL = dict(zip(SOURCES, (0.6, 2.0, 0.3), strict=True))  # s of the processor, with the search for stresses
ELLIPSE = dict(zip(SOURCES, (9.0, 40.0, 0.0), strict=True))  # the same of an ellipse
THIN, PER_FILM = 0.1, 1.8  # h/a_h below which a film takes so many times as long as ``USUAL``, measured

Report = Callable[[str, int, int], None]  # source, points done, points in all


@dataclass
class StudyRun:
    """Outcome of a run of a study, brought up to date while it runs.

    done, kept : solves answered by this run, found in the cache.
    damaged : messages on damaged stored answers.   failed : rows with a failure.
    lost : message, by key, on each solve whose process left no answer.
    """

    table: Path
    points: int
    rows: int = 0
    failed: int = 0
    done: int = 0
    kept: int = 0
    damaged: list[str] = field(default_factory=list)
    lost: dict[str, str] = field(default_factory=dict)
    complete: bool = False


def forecast(study: Study, folder: Path) -> tuple[dict[str, tuple[int, int]], float]:
    """By source the solves of ``study`` and how many ``folder`` holds; the usual seconds of the others."""
    solves = list(study.solves())
    every = Counter(one.source for one in solves)
    stored = Counter(one.source for one in solves if stored_path(folder, one.key).is_file())
    usual = ELLIPSE if study.indenter else USUAL
    seconds = sum(usual[source] * (count - stored[source]) for source, count in every.items())
    held = [h for *_, h in (*study.held, *(study.ball[2] if study.ball else ()))]
    thin = sum(h < THIN * study.bare.a_h for h in (median(study.thicknesses), *held))
    counts = {source: (count, stored[source]) for source, count in every.items()}
    return counts, seconds * (1 + PER_FILM * thin)


def table_path(folder: Path, study: Study) -> Path:
    """Path of the table of ``study`` in a run directory."""
    return folder / f"{study.name}.parquet"


def run_study(
    study: Study,
    folder: Path,
    jobs: int,
    *,
    executor: Executor | None = None,
    report: Report = lambda source, done, total: None,
) -> StudyRun:
    """Solve the part of ``study`` that is not in the cache under ``folder`` and write its table.

    jobs : processes side by side.   executor : as in ``run_tasks``.
    Raises StoreError where ``folder`` cannot be written or another run holds it, KeyboardInterrupt after
    writing the table of the stored answers.
    """
    solves, run = list(study.solves()), StudyRun(table_path(folder, study), study.points)
    with locked(folder):
        try:
            _solve_missing(run, solves, folder, report, jobs, executor)
            run.complete = True
        finally:
            about = {"name": study.name, "text": study.text, "points": run.points, "complete": run.complete}
            run.rows = write_table(run.table, _rows(run, solves, folder), about)
    return run


def _solve_missing(
    run: StudyRun, solves: list[Solve], folder: Path, report: Report, jobs: int, executor: Executor | None
) -> None:
    """Solve what is not in the cache, equal solves once: first the curves, then their checks."""
    total, done = Counter[str](), Counter[str]()
    for one in solves:
        total[one.source] += one.points

    def count(one: Solve) -> None:
        done[one.source] += one.points
        report(one.source, done[one.source], total[one.source])

    for source in total:
        report(source, 0, total[source])
    waiting: dict[str, list[Solve]] = {}
    for one in sorted(solves, key=lambda one: SOURCES.index(one.source)):
        if one.key not in waiting and _kept(run, stored_path(folder, one.key), one.request):
            count(one)
        else:
            waiting.setdefault(one.key, []).append(one)

    def finished(key: str, reason: str | None) -> None:
        # A solver's failure is an answer; that of a process is not stored, and the next run solves again.
        if reason is None:
            run.done += 1
        else:
            run.lost[key] = reason
        for one in waiting[key]:
            count(one)

    tasks: list[Task[str | None]] = [
        Task(
            key,
            partial(_solve_and_store, stored_path(folder, key), one.request),
            stored_path(folder, key),
            read=lambda stored: None,
            failed=lambda reason, seconds: reason,
            ahead=(RECORDS[one.source].package,),
        )
        for key, (one, *_) in waiting.items()
    ]
    run_tasks(tasks, jobs=jobs, time_limit=math.inf, executor=executor, finished=finished)


def _solve_and_store(path: Path, request: dict[str, Any]) -> None:
    write_answer(path, request, answer(request))


def _kept(run: StudyRun, path: Path, request: dict[str, Any]) -> bool:
    """Whether the answer is stored; a damaged one is named."""
    if not path.is_file():
        return False
    try:
        read_answer(path, request)
    except StoreError as error:
        run.damaged.append(str(error))
        return False
    run.kept += 1
    return True


def _rows(run: StudyRun, solves: list[Solve], folder: Path) -> Iterator[dict[str, Any]]:
    """Rows of everything stored, in the order of the points."""
    for _, sources in groupby(solves, key=lambda one: one.first):
        rows = [row for one in sources for row in _rows_of(run, one, folder)]
        for row in sorted(rows, key=lambda row: row["point"]):
            run.failed += row["status"] == "failed"
            yield row


def _rows_of(run: StudyRun, one: Solve, folder: Path) -> list[dict[str, Any]]:
    if one.key in run.lost:
        failed = failed_rows(one.request, run.lost[one.key])
        found: dict[str, Any] = {"rows": failed, "seconds": 0.0, "versions": {}}
    else:
        try:
            found = read_answer(stored_path(folder, one.key), one.request)
        except StoreError:
            return []  # not solved yet
    return table_rows(one.first, one.key, one.request, found, one.places)
