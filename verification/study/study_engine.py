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
from itertools import groupby, takewhile
from pathlib import Path
from statistics import median
from typing import Any

from verification.running.checked_files import StoreError, locked
from verification.running.pool.pool_task import Task
from verification.running.pool.process_pool import run_tasks
from verification.sources.source_registry import SOURCES as RECORDS
from verification.study.solve_cache import Cache
from verification.study.study_plan import Solve, Study
from verification.study.study_point import answer, failed_rows, table_rows
from verification.study.study_table import SOURCES, write_table

USUAL = dict(zip(SOURCES, (0.6, 2.0, 0.3), strict=True))  # s of the processor, with the search for stresses
THIN, PER_FILM = 0.1, 1.8  # h/a_h below which a film takes so many times as long as ``USUAL``, measured

Report = Callable[[str, int, int], None]  # source, points done, points in all


@dataclass
class Outcome:
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


def forecast(
    study: Study, folder: Path, limit: int | None = None
) -> tuple[Counter[str], Counter[str], float]:
    """Solves of ``study`` by source, those that are missing in ``folder``, the usual seconds of these."""
    cache, solves = Cache(folder / "cache"), _requested(study, limit)
    missing = Counter(one.source for one in solves if not cache.has(one.key))
    seconds = sum(USUAL[source] * count for source, count in missing.items())
    return Counter(one.source for one in solves), missing, seconds * _effort(study)


def _effort(study: Study) -> float:
    """Usual time of a solve of ``study`` over ``USUAL``, by its thin films, at the middle thickness."""
    on_ball = study.ball[2] if study.ball else ()
    held = [h for *_, h in (*study.above, *study.below, *on_ball)]
    return 1 + PER_FILM * sum(h < THIN * study.bare.a_h for h in (median(study.thicknesses), *held))


def _requested(study: Study, limit: int | None) -> list[Solve]:
    """The solves of the first ``limit`` points, in the order of the table."""
    return list(takewhile(lambda one: limit is None or one.first < limit, study.solves()))


def table_path(folder: Path, study: Study) -> Path:
    """Path of the table of ``study`` in a run directory."""
    return folder / f"{study.name}.parquet"


def run_study(
    study: Study,
    folder: Path,
    jobs: int,
    *,
    executor: Executor | None = None,
    limit: int | None = None,
    report: Report = lambda source, done, total: None,
) -> Outcome:
    """Solve the part of ``study`` that is not in the cache under ``folder`` and write its table.

    jobs : processes side by side.   executor : as in ``run_tasks``.   limit : only the first so many points.
    Raises StoreError where ``folder`` cannot be written or another run holds it, KeyboardInterrupt after
    writing the table of the stored answers.
    """
    with locked(folder):
        run = _Run(study, folder, limit, report)
        try:
            run.solve_missing(jobs, executor)
            run.outcome.complete = limit is None
        finally:
            run.write_table()
    return run.outcome


class _Run:
    """State of one run."""

    def __init__(self, study: Study, folder: Path, limit: int | None, report: Report) -> None:
        points = study.points if limit is None else min(limit, study.points)
        self.study, self.report, self.cache = study, report, Cache(folder / "cache")
        self.solves = _requested(study, limit)
        self.outcome = Outcome(table_path(folder, study), points)
        self.total, self.finished = Counter[str](), Counter[str]()
        for one in self.solves:
            self.total[one.source] += self.covered(one)
        for source, total in self.total.items():
            report(source, 0, total)

    def covered(self, one: Solve) -> int:
        """Number of requested points that a solve covers."""
        return min(one.points, self.outcome.points - one.first)

    def solve_missing(self, jobs: int, executor: Executor | None) -> None:
        """Solve what is not in the cache, equal solves once: first the curves, then their checks."""
        waiting: dict[str, list[Solve]] = {}
        for one in sorted(self.solves, key=lambda one: SOURCES.index(one.source)):
            if one.key in waiting or not self._stored(one):
                waiting.setdefault(one.key, []).append(one)
            else:
                self._count(one)

        def finished(key: str, reason: str | None) -> None:
            # A solver's failure is an answer; that of a process is not stored, and the next run solves again.
            if reason is None:
                self.outcome.done += 1
            else:
                self.outcome.lost[key] = reason
            for one in waiting[key]:
                self._count(one)

        tasks = [self._task(equal[0]) for equal in waiting.values()]
        run_tasks(tasks, jobs=jobs, time_limit=math.inf, executor=executor, finished=finished)

    def _task(self, one: Solve) -> Task[str | None]:
        """Storing the answer to ``one``; its result is the reason why there is none, else None."""
        return Task(
            one.key,
            partial(_solve_and_store, self.cache, one.key, one.request),
            self.cache.path(one.key),
            read=lambda stored: None,
            failed=lambda reason, seconds: reason,
            ahead=(RECORDS[one.source].package,),
        )

    def _stored(self, one: Solve) -> bool:
        if not self.cache.has(one.key):
            return False
        try:
            self.cache.get(one.key, one.request)
        except StoreError as error:
            self.outcome.damaged.append(str(error))
            return False
        self.outcome.kept += 1
        return True

    def _count(self, one: Solve) -> None:
        """Report the points that a finished solve covers."""
        self.finished[one.source] += self.covered(one)
        self.report(one.source, self.finished[one.source], self.total[one.source])

    def write_table(self) -> None:
        """Write the rows of everything stored, in the order of the points."""
        outcome = self.outcome
        about: dict[str, Any] = {"name": self.study.name, "text": self.study.text}
        about |= {"points": outcome.points, "complete": outcome.complete}
        outcome.rows = write_table(outcome.table, self._rows(), about)

    def _rows(self) -> Iterator[dict[str, Any]]:
        for _, sources in groupby(self.solves, key=lambda one: one.first):
            rows = [row for one in sources for row in self._rows_of(one)]
            for row in sorted(rows, key=lambda row: row["point"]):
                self.outcome.failed += row["status"] == "failed"
                yield row

    def _rows_of(self, one: Solve) -> list[dict[str, Any]]:
        if one.key in self.outcome.lost:
            failed = failed_rows(one.request, self.outcome.lost[one.key])
            found: dict[str, Any] = {"rows": failed, "seconds": 0.0, "versions": {}}
        else:
            try:
                found = self.cache.get(one.key, one.request)
            except StoreError:
                return []  # not solved yet
        return table_rows(one.first, one.key, one.request, found, one.places)[: self.covered(one)]


def _solve_and_store(cache: Cache, key: str, request: dict[str, Any]) -> None:
    cache.put(key, request, answer(request))
