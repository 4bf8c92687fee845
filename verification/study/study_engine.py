"""A study from its plan to its table, on Dask.

The client process holds plan, cache and table; workers answer requests and need only the package. A bounded
number of solves is submitted at a time, so that memory does not grow with the study. An answer is stored
before it is counted, and the table is written whole from the stored answers in the order of the points, so
that it depends neither on the order of the answers nor on interruptions.
"""

import json
import os
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import closing, nullcontext
from dataclasses import dataclass, field
from itertools import chain, groupby, takewhile
from pathlib import Path
from statistics import median
from typing import Any

from verification.running.checked_files import StoreError, locked
from verification.study.dask_cluster import REMEDY, Lost, SchedulerError, answers
from verification.study.solve_cache import Cache, code_version
from verification.study.study_plan import Solve, Study
from verification.study.study_point import answer, failed_rows, peak_memory, table_rows
from verification.study.study_table import SOURCES, write_table

PAUSE = 5.0  # s between two writings of the table
USUAL = dict(zip(SOURCES, (0.6, 2.0, 0.3), strict=True))  # s of the processor, with the search for stresses
THIN, PER_FILM = 0.1, 1.8  # h/a_h below which a film takes so many times as long as ``USUAL``, measured
SHARE = 0.02  # of the time, at most, is spent on writing the table while it grows

Report = Callable[[str, int, int], None]  # source, points done, points in all


@dataclass
class Outcome:
    """Outcome of a run of a study, brought up to date while it runs.

    done, kept : solves answered by this run, found in the cache.
    damaged : messages on damaged stored answers.   failed : rows with a failure.
    lost : message, by key, on each solve that no worker could answer.
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
    seconds: float = 0.0


@dataclass(frozen=True)
class Forecast:
    """Solves of one source, the ``missing`` ones of them, and the usual ``seconds`` of one on a core."""

    solves: int
    missing: int
    seconds: float


def forecast(study: Study, folder: Path, limit: int | None = None) -> dict[str, Forecast]:
    """What a run of ``study`` in ``folder`` has to solve, by source.

    A solve takes as long as the median of those recorded in ``folder``, or ``USUAL`` seconds.
    """
    points = study.points if limit is None else min(limit, study.points)
    cache, seconds = Cache(folder / "cache"), _recorded(folder / "ledger.jsonl")
    counts = {source: [0, 0] for source in SOURCES}
    for one in takewhile(lambda one: one.first < points, study.solves()):
        counts[one.source][0] += 1
        counts[one.source][1] += not cache.has(one.key)
    return {
        source: Forecast(count[0], count[1], seconds.get(source, USUAL[source] * _effort(study)))
        for source, count in counts.items()
        if count[0]
    }


def _effort(study: Study) -> float:
    """Usual time of a solve of ``study`` over ``USUAL``, by its thin films, at the middle thickness."""
    on_ball = study.ball[2] if study.ball else ()
    held = [h for *_, h in (*study.above, *study.below, *on_ball)]
    return 1 + PER_FILM * sum(h < THIN * study.bare.a_h for h in (median(study.thicknesses), *held))


def _recorded(ledger: Path) -> dict[str, float]:
    """Median seconds of a solve by source, from a ledger; {} without a readable one."""
    found: dict[str, list[float]] = {}
    try:
        for line in ledger.read_text(encoding="utf-8").splitlines()[-1000:]:
            note = json.loads(line)
            if note["event"] == "stored":
                found.setdefault(note["source"], []).append(float(note["seconds"]))
    except (OSError, ValueError, KeyError, TypeError):
        return {}
    return {source: median(seconds) for source, seconds in found.items()}


def table_path(folder: Path, study: Study) -> Path:
    """Path of the table of ``study`` in a run directory."""
    return folder / f"{study.name}.parquet"


def run_study(
    study: Study,
    folder: Path,
    client: Callable[[], Any],
    *,
    limit: int | None = None,
    report: Report = lambda source, done, total: None,
    solve: Callable[[dict[str, Any]], dict[str, Any]] = answer,
) -> Outcome:
    """Solve the part of ``study`` that is not in the cache under ``folder`` and write its table.

    client : opens a client of a Dask cluster, a context; called only where there is something to solve.
    limit : only the first so many points.   solve : answers a request in place of ``point.answer``.
    Raises StoreError where ``folder`` cannot be written or another run holds it, SchedulerError where the
    cluster fails, KeyboardInterrupt after writing the table of the stored answers.
    """
    with locked(folder):
        run = _Run(study, folder, limit, report)
        waiting = run.missing()
        first = next(waiting, None)
        with nullcontext() if first is None else client() as open_client:
            try:
                if first is not None:
                    run.solve(chain([first], waiting), open_client, solve)
                run.outcome.complete = limit is None
            finally:
                run.write_table()
    return run.outcome


class _Run:
    """State of one run."""

    def __init__(self, study: Study, folder: Path, limit: int | None, report: Report) -> None:
        points = study.points if limit is None else min(limit, study.points)
        self.study, self.report = study, report
        self.cache, self.ledger = Cache(folder / "cache"), folder / "ledger.jsonl"
        self.outcome = Outcome(table_path(folder, study), points)
        self.requested: set[bytes] = set()
        self.total, self.finished = dict.fromkeys(SOURCES, 0), dict.fromkeys(SOURCES, 0)
        for one in self.solves():
            self.total[one.source] += self.covered(one)
        for source, total in self.total.items():
            if total:
                report(source, 0, total)
        self.spent = 0.0  # s, in writing the table
        self.begin = self.written = time.perf_counter()

    def solves(self) -> Iterator[Solve]:
        """The solves of the requested points, in the order of the table."""
        return takewhile(lambda one: one.first < self.outcome.points, self.study.solves())

    def covered(self, one: Solve) -> int:
        """Number of requested points that a solve covers."""
        return min(one.points, self.outcome.points - one.first)

    def missing(self) -> Iterator[Solve]:
        """The distinct solves that are not in the cache: first the curves, then their checks."""
        for source in SOURCES:
            for one in self.solves():
                if one.source != source:
                    continue
                digest = bytes.fromhex(one.key)
                if digest in self.requested or self._stored(one):
                    self.count(one)
                else:
                    self.requested.add(digest)
                    yield one

    def solve(self, waiting: Iterator[Solve], client: Any, function: Callable[..., Any]) -> None:
        """Submit a bounded number of solves at a time until none is left; store each answer."""
        with closing(answers(client, function, self._requests(waiting))) as arriving:
            for one, found in arriving:
                self._take(one, found)

    def _requests(self, waiting: Iterator[Solve]) -> Iterator[tuple[str, dict[str, Any], Solve]]:
        for one in waiting:
            self._note("sent", one)
            # A key of its own: a worker may still be at the same solve of a study that was stopped.
            yield f"{one.source}-{one.key}-{uuid.uuid4().hex}", one.request, one

    def _take(self, one: Solve, found: dict[str, Any] | Lost) -> None:
        if isinstance(found, Lost):
            # A solver's failure is an answer; a worker's is not stored, so that the next run solves again.
            self.outcome.lost[one.key] = found.reason
            self._note("lost", one)
            self.count(one)
            return
        if found.get("code", code_version(one.source)) != code_version(one.source):
            raise SchedulerError(f"a worker runs other code than this process; {REMEDY}")
        self.cache.put(one.key, one.request, found)
        self._note("stored", one, seconds=found["seconds"], memory=found.get("memory", 0))
        self.outcome.done += 1
        self.count(one)
        now = time.perf_counter()
        if now - self.written > PAUSE and self.spent < SHARE * (now - self.begin):
            self.write_table()

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

    def count(self, one: Solve) -> None:
        """Report the points that a finished solve covers."""
        self.finished[one.source] += self.covered(one)
        self.report(one.source, self.finished[one.source], self.total[one.source])

    def _note(self, event: str, one: Solve, **more: float) -> None:
        """A line of the ledger, with this process and, once stored, the worker's seconds and peak memory."""
        line = {"event": event, "key": one.key, "source": one.source, "process": os.getpid(), **more}
        line |= {"at": round(time.perf_counter() - self.begin, 3), "client_memory": peak_memory()}
        with self.ledger.open("a") as file:
            file.write(json.dumps(line) + "\n")

    def write_table(self) -> None:
        """Write the rows of everything stored, in the order of the points."""
        begin, outcome = time.perf_counter(), self.outcome
        outcome.failed = 0
        about: dict[str, Any] = {"name": self.study.name, "text": self.study.text}
        about |= {"points": outcome.points, "complete": outcome.complete}
        outcome.rows = write_table(outcome.table, self._rows(), about)
        self.written = time.perf_counter()
        self.spent += self.written - begin
        outcome.seconds = self.written - self.begin

    def _rows(self) -> Iterator[dict[str, Any]]:
        for _, sources in groupby(self.solves(), key=lambda one: one.first):
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
