"""One process of a pool: it starts, takes tasks, and is ended where it hangs."""

import base64
import json
import os
import pickle
import select
import signal
import subprocess
import sys
import tempfile
import time
from collections import deque
from contextlib import suppress
from pathlib import Path
from typing import IO, Generic, TypeVar

from verification.running.checked_files import StoreError, read_checked
from verification.running.pool.fork_guard import UNWRITABLE
from verification.running.pool.pool_task import Task

T = TypeVar("T")
Group = deque[tuple[int, Task[T]]]  # tasks of one process, each with its number

THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "DUCC0_NUM_THREADS")
# glibc keeps freed memory for the next array. Else the kernel clears each page anew: a tenth of the time.
MEMORY_VARIABLES = {
    "MALLOC_MMAP_THRESHOLD_": str(32 * 2**20),
    "MALLOC_TRIM_THRESHOLD_": str(2**30),
    "MALLOC_TOP_PAD_": str(64 * 2**20),
}


class Slot(Generic[T]):
    """One of the processes, its ``task`` at work, those still ``owed`` of its group."""

    def __init__(self, threads: int) -> None:
        self.threads = threads
        self.owed: Group[T] = deque()
        self.task: Task[T] | None = None
        self.number = -1
        self.process: subprocess.Popen[bytes] | None = None
        self.errors = tempfile.TemporaryFile()  # noqa: SIM115 - lives as long as the slot

    @property
    def replies(self) -> int | None:
        """Handle of the answers of the process; None where it does not run."""
        return None if self.process is None else _pipe(self.process.stdout).fileno()

    def start(self) -> Task[T]:
        """Begin the next task that is owed."""
        self.number, self.task = self.owed.popleft()
        self.begin, self.earlier = time.monotonic(), _identity(self.task.path)
        self.taken, self.refused = False, ""
        try:
            process = self.process or self._launch()
            self.errors.seek(0)
            self.errors.truncate()
            work = self.task.work
            request = {
                "work": base64.b64encode(pickle.dumps(work)).decode(),
                "ahead": [*self.task.ahead, work.func.__module__],
                "more": bool(self.owed),
            }
            with suppress(BrokenPipeError):  # it has died, as its end of file will tell
                _pipe(process.stdin).write(json.dumps(request).encode() + b"\n")
        except OSError as error:
            self.stop()
            self.refused = f"its process could not be started ({error.strerror}); free memory and space"
        return self.task

    def _launch(self) -> subprocess.Popen[bytes]:
        # Without the working directory, where a folder may have the name of a method, unless it is this one.
        safe = [] if Path.cwd() == Path(__file__).resolve().parents[3] else ["-P"]
        self.process = subprocess.Popen(
            [sys.executable, *safe, "-m", "verification.running.pool.fork_guard"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self.errors,
            # Tasks run side by side, so each may use its share of the cores, no more.
            env=os.environ | MEMORY_VARIABLES | dict.fromkeys(THREAD_VARIABLES, str(self.threads)),
            bufsize=0,
            start_new_session=True,
        )
        self.unread, self.child = b"", 0
        return self.process

    def poll(self, time_limit: float) -> tuple[int, T] | None:
        """Number and result of a task that has ended; None while none has."""
        if self.task is None:
            return None
        task, seconds = self.task, time.monotonic() - self.begin
        code = None if self.refused else self._code()
        if code is None and not self.refused and seconds < time_limit:
            return None
        result = self._result(task, code, seconds)
        self.task = None
        return self.number, result

    def _result(self, task: Task[T], code: int | None, seconds: float) -> T:
        if self.refused:
            return task.failed(self.refused, seconds)
        if code is None:
            self.stop()
            limit = f"not finished after {seconds:.0f} s; raise --time-limit or coarsen the case"
            return task.failed(limit, seconds)
        if code == UNWRITABLE:
            raise StoreError(_last_line(self.errors))
        if code != 0:
            return task.failed(f"its process {_death(code, self.errors)}", seconds)
        if _identity(task.path) == self.earlier:
            return task.failed("its process left no result; run the case alone", seconds)
        return read_result(task, seconds)

    def _code(self) -> int | None:
        """Exit code of the task at work, negative for a signal; None while it runs."""
        assert self.process is not None
        replies = _pipe(self.process.stdout)
        ready = bool(select.select([replies], [], [], 0)[0])
        more = replies.read(4096) if ready else b""
        *lines, self.unread = (self.unread + more).split(b"\n")
        code = None
        for line in lines:
            kind, child, *ended = line.split()
            if kind == b"taken":
                self.child, self.taken = int(child), True
            elif kind == b"done":
                code = 0
            else:
                # A child that dies between two tasks has not taken the second, which another child takes.
                code = int(ended[0]) if self.taken else None
                self.child = 0
        if code is None and ready and not more:
            code = self.process.wait()
            self.stop()
        return code

    def stop(self) -> None:
        """End the process with all that it started."""
        if self.process is None:
            return
        for group in filter(None, (self.child, self.process.pid)):
            with suppress(OSError):
                os.killpg(group, signal.SIGKILL)
        with self.process:  # closes its pipes, waits
            self.process = None


def read_result(task: Task[T], seconds: float) -> T:
    """Result in the file of ``task``; what ``failed`` makes of the reason where it cannot be used."""
    try:
        return task.read(read_checked(task.path))
    except (StoreError, ValueError, KeyError, TypeError, AttributeError) as error:
        return task.failed(" ".join(str(error).split()), seconds)


def _pipe(end: IO[bytes] | None) -> IO[bytes]:
    assert end is not None
    return end


def _identity(path: Path) -> tuple[int, int] | None:
    """Identity of ``path``, another one when it is written anew; None where there is nothing."""
    try:
        found = path.stat(follow_symlinks=False)
    except OSError:
        return None
    return found.st_ino, found.st_mtime_ns


def _death(code: int, errors: IO[bytes]) -> str:
    if code == -9:
        return "was killed (signal 9), most likely for want of memory; run fewer --jobs"
    if code < 0:
        return f"crashed with signal {-code}; run the case alone to see whether it repeats"
    return f"ended with code {code}: {_last_line(errors)}"


def _last_line(errors: IO[bytes]) -> str:
    errors.seek(max(0, errors.seek(0, os.SEEK_END) - 2000))
    lines = errors.read().decode(errors="replace").strip().splitlines()
    return lines[-1] if lines else "no message"
