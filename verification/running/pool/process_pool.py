"""A pool of processes: tasks side by side, each with a time limit."""

import os
import select
import signal
import sys
import threading
from collections import deque
from collections.abc import Callable, Hashable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from typing import TypeVar

from verification.running.pool.executor_tasks import solved_by
from verification.running.pool.pool_task import Task
from verification.running.pool.process_slot import THREAD_VARIABLES, Group, Slot
from verification.running.provenance import cores

T = TypeVar("T")


def run_tasks(
    tasks: Sequence[Task[T]],
    *,
    jobs: int,
    time_limit: float,
    executor: Executor | None = None,
    started: Callable[[str], None] = lambda name: None,
    finished: Callable[[str, T], None] = lambda name, result: None,
    meanwhile: Callable[[], object] = lambda: None,
) -> list[T]:
    """Run ``tasks`` on ``jobs`` processes, each of a name of its own; results in their order.

    A task that fails, hangs beyond ``time_limit`` [s] or dies leaves what ``failed`` makes of the reason, and
    the file of an earlier run as it was. Raises StoreError where results cannot be written.
    executor : runs the tasks on workers that see the files of the tasks; what it loses is run here.
    meanwhile : called once, when the first tasks have started.
    """
    waiting = _in_order(tasks)
    results: dict[int, T] = {}

    def ended(number: int, result: T) -> None:
        results[number] = result
        finished(tasks[number].name, result)

    if executor is not None:
        waiting, reason = solved_by(executor, waiting, time_limit, started, ended, meanwhile)
        if waiting:
            count = sum(map(len, waiting))
            sys.stderr.write(f"coatcheck: {count} tasks are run here: {reason}\n")
        meanwhile = lambda: None  # noqa: E731
    slots = [Slot[T](_threads(jobs)) for _ in range(min(jobs, len(waiting)))]
    try:
        with _interrupts() as seen:
            _start_idle(slots, waiting, started)
            meanwhile()
            while len(results) < len(tasks):
                # Until one answers; each time limit is looked at every 0.05 s.
                select.select([end for slot in slots if (end := slot.replies) is not None], [], [], 0.05)
                if seen:
                    raise KeyboardInterrupt
                for slot in slots:
                    if (found := slot.poll(time_limit)) is not None:
                        ended(*found)
                _start_idle(slots, waiting, started)
    finally:  # no process outlives the run, however it ends
        for slot in slots:
            slot.stop()
            slot.errors.close()
    return [results[number] for number in range(len(tasks))]


def _threads(jobs: int) -> int:
    """Threads of each process: its share of the processors, or fewer where the environment says so."""
    stated = [int(given) for name in THREAD_VARIABLES if (given := os.environ.get(name, "")).isdecimal()]
    return max(1, min([cores() // jobs, *stated]))


@contextmanager
def _interrupts() -> Iterator[list[int]]:
    """Each Ctrl-C, noted and raised at the end; the second is raised at once.

    Raised while a module loads, it is dropped in the clean-up of the import, or Python ends by the signal and
    not with the exit code, where a string is executed, as dataclasses do.
    """
    seen: list[int] = []
    before = signal.getsignal(signal.SIGINT)
    if before is not signal.default_int_handler or threading.current_thread() is not threading.main_thread():
        yield seen
        return

    def noticed(number: int, frame: object) -> None:
        seen.append(number)
        if len(seen) > 1:
            raise KeyboardInterrupt

    signal.signal(signal.SIGINT, noticed)
    try:
        yield seen
        if seen:
            raise KeyboardInterrupt
    finally:
        signal.signal(signal.SIGINT, before)


def _in_order(tasks: Sequence[Task[T]]) -> deque[Group[T]]:
    """Tasks by process, the costliest first: a long one that starts last would be waited for alone."""
    groups: dict[Hashable, Group[T]] = {}
    for number, task in enumerate(tasks):
        key = (number, None) if task.together is None else task.together
        groups.setdefault(key, deque()).append((number, task))
    return deque(sorted(groups.values(), key=lambda group: -sum(task.cost for _, task in group)))


def _start_idle(slots: list[Slot[T]], waiting: deque[Group[T]], started: Callable[[str], None]) -> None:
    for slot in slots:
        if slot.task is None and (slot.owed or waiting):
            slot.owed = slot.owed or waiting.popleft()
            started(slot.start().name)
