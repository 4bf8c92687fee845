"""Tasks side by side, each in a process of its own with a time limit."""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import IO, Any, Generic, TypeVar

from verification import printed_run
from verification.case import Case
from verification.printed import PublishedCase
from verification.result import CaseResult, from_json
from verification.run import failed
from verification.store import StoreError, read_checked

__all__ = ["Task", "case_task", "cores", "published_task", "result_path", "run_cases", "run_tasks"]

T = TypeVar("T")
T_co = TypeVar("T_co", covariant=True)

THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "DUCC0_NUM_THREADS")
POLL = 0.05  # s


def cores() -> int:
    """Processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def result_path(folder: Path, case: Case | PublishedCase) -> Path:
    """Where the checked result of ``case`` lies in a run directory."""
    return folder / "cases" / f"{case.name}.json"


@dataclass(frozen=True)
class Task(Generic[T_co]):
    """Work for a process of its own, ``python -m`` and ``command``, that leaves a checked file at ``path``.

    question : its standard input.   read : from what the file holds to the result.
    failed : the result of a process that left none, from the reason and its seconds.
    """

    name: str
    command: tuple[str, ...]
    path: Path
    read: Callable[[dict[str, Any]], T_co]
    failed: Callable[[str, float], T_co]
    question: bytes = b""


def case_task(case: Case, folder: Path) -> Task[CaseResult]:
    """Solving ``case`` with its result stored under ``folder``."""
    path = result_path(folder, case)
    words = ("verification.worker", case.name, str(path))
    return Task(case.name, words, path, from_json, partial(failed, case), case.text.encode())


def published_task(case: PublishedCase, folder: Path) -> Task[CaseResult]:
    """Holding both methods against what ``case`` printed, its result stored under ``folder``."""
    path = result_path(folder, case)
    words = ("verification.printed_worker", str(case.path), str(path))
    return Task(case.name, words, path, from_json, partial(printed_run.failed, case))


def run_cases(cases: Sequence[Case], folder: Path, *, jobs: int, time_limit: float) -> list[CaseResult]:
    """Run ``cases`` as ``run_tasks`` does; their results in order, stored under ``folder``."""
    return run_tasks([case_task(case, folder) for case in cases], jobs=jobs, time_limit=time_limit)


def run_tasks(
    tasks: Sequence[Task[T]],
    *,
    jobs: int,
    time_limit: float,
    started: Callable[[str], None] = lambda name: None,
    finished: Callable[[str, T], None] = lambda name, result: None,
) -> list[T]:
    """Run ``tasks`` on ``jobs`` processes, each of a name of its own; results in their order.

    A process that fails, hangs beyond ``time_limit`` [s] or dies leaves what its task makes of the reason.
    """
    threads = max(1, cores() // jobs)
    waiting = list(tasks)
    running: list[_Job] = []
    results: dict[str, T] = {}
    with _reaped(running):
        while waiting or running:
            while waiting and len(running) < jobs:
                task = waiting.pop(0)
                running.append(_Job(task, threads))
                started(task.name)
            time.sleep(POLL)
            for job in list(running):
                result = job.poll(time_limit)
                if result is not None:
                    running.remove(job)
                    results[job.task.name] = result
                    finished(job.task.name, result)
    return [results[task.name] for task in tasks]


class _Job(Generic[T]):
    def __init__(self, task: Task[T], threads: int) -> None:
        self.task, self.begin = task, time.monotonic()
        task.path.unlink(missing_ok=True)
        self.said: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 - lives as long as the process
        with tempfile.TemporaryFile() as question:
            question.write(task.question)
            question.seek(0)
            self.process = subprocess.Popen(
                [sys.executable, "-m", *task.command],
                stdin=question,
                stdout=subprocess.DEVNULL,
                stderr=self.said,
                # Tasks run side by side, so each may use its share of the cores, no more.
                env=os.environ | dict.fromkeys(THREAD_VARIABLES, str(threads)),
                start_new_session=True,
            )

    def poll(self, time_limit: float) -> T | None:
        seconds = time.monotonic() - self.begin
        code = self.process.poll()
        if code is None:
            if seconds < time_limit:
                return None
            self.stop()
            return self.task.failed(
                f"not finished after {seconds:.0f} s; raise --time-limit or coarsen the case", seconds
            )
        with self.said:
            if code != 0:
                return self.task.failed(f"its process {_death(code, self.said)}", seconds)
            try:
                return self.task.read(read_checked(self.task.path))
            except (StoreError, ValueError) as error:
                return self.task.failed(str(error), seconds)

    def stop(self) -> None:
        self.process.kill()
        self.process.wait()
        self.said.close()


def _death(code: int, said: IO[bytes]) -> str:
    if code == -9:
        return "was killed (signal 9), most likely for want of memory; run fewer --jobs"
    if code < 0:
        return f"crashed with signal {-code}; run the case alone to see whether it repeats"
    said.seek(max(0, said.seek(0, os.SEEK_END) - 2000))
    last = said.read().decode(errors="replace").strip().splitlines()
    return f"ended with code {code}: {last[-1] if last else 'no message'}"


@contextmanager
def _reaped(running: list[_Job]) -> Iterator[None]:
    """No process outlives the run, however it ends."""
    try:
        yield
    finally:
        for job in running:
            job.stop()
