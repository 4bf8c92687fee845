"""Cases side by side, each in a process of its own with a time limit."""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from verification.case import Case
from verification.result import CaseResult, from_json
from verification.run import failed
from verification.store import StoreError, read_checked

__all__ = ["cores", "result_path", "run_cases"]

THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "DUCC0_NUM_THREADS")
POLL = 0.05  # s


def cores() -> int:
    """Processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def result_path(folder: Path, case: Case) -> Path:
    """Where the checked result of ``case`` lies in a run directory."""
    return folder / "cases" / f"{case.name}.json"


def run_cases(
    cases: Sequence[Case],
    folder: Path,
    *,
    jobs: int,
    time_limit: float,
    started: Callable[[Case], None] = lambda case: None,
    finished: Callable[[CaseResult], None] = lambda result: None,
) -> list[CaseResult]:
    """Run ``cases`` on ``jobs`` processes; results in the order of ``cases``, stored under ``folder``.

    A process that fails, hangs beyond ``time_limit`` [s] or dies leaves NO_RESULT with its reason.
    """
    threads = max(1, cores() // jobs)
    waiting = list(cases)
    running: list[_Job] = []
    results: dict[str, CaseResult] = {}
    with _reaped(running):
        while waiting or running:
            while waiting and len(running) < jobs:
                case = waiting.pop(0)
                running.append(_Job(case, result_path(folder, case), threads))
                started(case)
            time.sleep(POLL)
            for job in list(running):
                result = job.poll(time_limit)
                if result is not None:
                    running.remove(job)
                    results[job.case.name] = result
                    finished(result)
    return [results[case.name] for case in cases]


class _Job:
    def __init__(self, case: Case, path: Path, threads: int) -> None:
        self.case, self.path, self.begin = case, path, time.monotonic()
        path.unlink(missing_ok=True)
        self.said: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 - lives as long as the process
        with tempfile.TemporaryFile() as question:
            question.write(case.text.encode())
            question.seek(0)
            self.process = subprocess.Popen(
                [sys.executable, "-m", "verification.worker", case.name, str(path)],
                stdin=question,
                stdout=subprocess.DEVNULL,
                stderr=self.said,
                # Cases run side by side, so each may use its share of the cores, no more.
                env=os.environ | dict.fromkeys(THREAD_VARIABLES, str(threads)),
                start_new_session=True,
            )

    def poll(self, time_limit: float) -> CaseResult | None:
        seconds = time.monotonic() - self.begin
        code = self.process.poll()
        if code is None:
            if seconds < time_limit:
                return None
            self.stop()
            return failed(
                self.case,
                f"not finished after {seconds:.0f} s; raise --time-limit or coarsen the case",
                seconds,
            )
        with self.said:
            if code != 0:
                return failed(self.case, f"its process {_death(code, self.said)}", seconds)
            try:
                return from_json(read_checked(self.path))
            except (StoreError, ValueError) as error:
                return failed(self.case, str(error), seconds)

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
