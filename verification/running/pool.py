"""A pool of subprocesses: tasks side by side, each with a time limit."""

import io
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Generic, TypeVar

from verification.running.guard import UNWRITABLE
from verification.running.store import StoreError, read_checked

__all__ = ["POLL", "THREAD_VARIABLES", "T", "T_co", "Task", "cores", "run_tasks"]

T = TypeVar("T")


T_co = TypeVar("T_co", covariant=True)


THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "DUCC0_NUM_THREADS")


POLL = 0.05  # s


def cores() -> int:
    """Processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


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


def run_tasks(
    tasks: Sequence[Task[T]],
    *,
    jobs: int,
    time_limit: float,
    started: Callable[[str], None] = lambda name: None,
    finished: Callable[[str, T], None] = lambda name, result: None,
) -> list[T]:
    """Run ``tasks`` on ``jobs`` processes, each of a name of its own; results in their order.

    A process that fails, hangs beyond ``time_limit`` [s] or dies leaves what its task makes of the reason,
    and the file of an earlier run as it was. Raises StoreError where results cannot be written.
    """
    threads = max(1, cores() // jobs)
    waiting = list(enumerate(tasks))
    running: dict[int, _Job[T]] = {}
    results: dict[int, T] = {}
    with _lifeline() as lifeline, _reaped(running):
        while waiting or running:
            while waiting and len(running) < jobs:
                number, task = waiting.pop(0)
                running[number] = _Job(task, threads, lifeline)
                started(task.name)
            time.sleep(POLL)
            for number, job in list(running.items()):
                result = job.poll(time_limit)
                if result is not None:
                    del running[number]
                    results[number] = result
                    finished(job.task.name, result)
    return [results[number] for number in range(len(tasks))]


class _Job(Generic[T]):
    def __init__(self, task: Task[T], threads: int, lifeline: int) -> None:
        self.task, self.begin = task, time.monotonic()
        self.earlier = _identity(task.path)
        self.process: subprocess.Popen[bytes] | None = None
        self.refused = ""
        self.said: IO[bytes] = io.BytesIO()
        try:
            self.said = tempfile.TemporaryFile()  # noqa: SIM115 - lives as long as the process
            with tempfile.TemporaryFile() as question:
                question.write(task.question)
                question.seek(0)
                self.process = subprocess.Popen(
                    [sys.executable, "-m", "verification.running.guard", str(lifeline), *task.command],
                    stdin=question,
                    stdout=subprocess.DEVNULL,
                    stderr=self.said,
                    # Tasks run side by side, so each may use its share of the cores, no more.
                    env=os.environ | dict.fromkeys(THREAD_VARIABLES, str(threads)),
                    start_new_session=True,
                    pass_fds=(lifeline,),
                )
        except OSError as error:
            self.said.close()
            self.refused = f"its process could not be started ({error.strerror}); free memory and space"

    def poll(self, time_limit: float) -> T | None:
        seconds = time.monotonic() - self.begin
        if self.process is None:
            return self.task.failed(self.refused, seconds)
        code = self.process.poll()
        if code is None:
            if seconds < time_limit:
                return None
            self.stop()
            return self.task.failed(
                f"not finished after {seconds:.0f} s; raise --time-limit or coarsen the case", seconds
            )
        self.stop(close=False)
        with self.said:
            if code == UNWRITABLE:
                raise StoreError(_last_words(self.said))
            if code != 0:
                return self.task.failed(f"its process {_death(code, self.said)}", seconds)
        if _identity(self.task.path) == self.earlier:
            return self.task.failed("its process left no result; run the case alone", seconds)
        try:
            return self.task.read(read_checked(self.task.path))
        except (StoreError, ValueError, KeyError, TypeError, AttributeError) as error:
            return self.task.failed(" ".join(str(error).split()), seconds)

    def stop(self, *, close: bool = True) -> None:
        """End the process with all that it started."""
        if self.process is None:
            return
        with suppress(OSError):
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        if close:
            self.said.close()


def _identity(path: Path) -> tuple[int, int] | None:
    """What changes when ``path`` is written anew; None where there is nothing."""
    try:
        found = path.stat(follow_symlinks=False)
    except OSError:
        return None
    return found.st_ino, found.st_mtime_ns


def _death(code: int, said: IO[bytes]) -> str:
    if code == -9:
        return "was killed (signal 9), most likely for want of memory; run fewer --jobs"
    if code < 0:
        return f"crashed with signal {-code}; run the case alone to see whether it repeats"
    return f"ended with code {code}: {_last_words(said)}"


def _last_words(said: IO[bytes]) -> str:
    said.seek(max(0, said.seek(0, os.SEEK_END) - 2000))
    last = said.read().decode(errors="replace").strip().splitlines()
    return last[-1] if last else "no message"


@contextmanager
def _lifeline() -> Iterator[int]:
    """A pipe that processes listen to: closed when this process ends, even by kill -9."""
    listen, held = os.pipe()
    try:
        yield listen
    finally:
        os.close(listen)
        os.close(held)


@contextmanager
def _reaped(running: dict[int, _Job[T]]) -> Iterator[None]:
    """No process outlives the run, however it ends."""
    try:
        yield
    finally:
        for job in running.values():
            job.stop()
