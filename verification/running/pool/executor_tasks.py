"""Tasks on the workers of an executor of concurrent.futures: a pool, Dask, whatever a cluster has.

A worker runs them in a process of its own, with the time limit, as a run without a cluster does; only names
and digests travel. Its files must be seen here: the directory of the run lies on a shared disk.
"""

import hashlib
import json
import select
import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import Executor, Future, as_completed
from typing import Any, TypeVar

from verification.running.checked_files import StoreError, read_checked
from verification.running.pool.pool_task import Task
from verification.running.pool.process_slot import Group, Slot, read_result
from verification.running.provenance import fingerprint

T = TypeVar("T")
Answer = str | tuple[str, float]  # digest of the file; of a task that left none, reason and seconds

_here = threading.local()  # the slot of each thread of a worker: what is imported stays imported


def solved_by(
    executor: Executor,
    waiting: deque[Group[T]],
    time_limit: float,
    started: Callable[[str], None],
    ended: Callable[[int, T], None],
    meanwhile: Callable[[], object],
) -> tuple[deque[Group[T]], str]:
    """Run the groups of tasks by ``executor``; the groups that it lost, with the reason of the last.

    ended : called with number and result of each task.   Others as in ``run_tasks``.
    """
    lost, why = deque[Group[T]](), ""
    sent: dict[Future[list[Answer]], Group[T]] = {}
    try:
        for group in waiting:
            plain = [Task[Answer](t.name, t.work, t.path, _digest, _reason, ahead=t.ahead) for _, t in group]
            try:
                sent[executor.submit(_on_worker, plain, time_limit, fingerprint())] = group
            except RuntimeError as error:  # a pool that lost a worker takes no more
                lost.append(group)
                why = str(error)
        meanwhile()
        for future in as_completed(sent):
            try:
                found = [
                    _result(task, one) for (_, task), one in zip(sent[future], future.result(), strict=True)
                ]
            except Exception as error:
                lost.append(sent[future])
                why = str(error) or type(error).__name__
            else:
                for (number, task), result in zip(sent[future], found, strict=True):
                    started(task.name)
                    ended(number, result)
    finally:
        for future in sent:
            future.cancel()
    return lost, why


def _on_worker(tasks: list[Task[Answer]], time_limit: float, made_by: str) -> list[Answer]:
    """Run on a worker: the answers of ``tasks``, one after the other in one process."""
    if made_by != fingerprint():
        raise RuntimeError("a worker has other versions; install there what is installed here")
    if not hasattr(_here, "slot"):
        _here.slot = Slot[Answer](1)
    slot: Slot[Answer] = _here.slot
    slot.owed = deque(enumerate(tasks))
    answers = []
    while slot.owed:
        slot.start()
        while (found := slot.poll(time_limit)) is None:
            select.select([end for end in (slot.replies,) if end is not None], [], [], 0.05)
        answers.append(found[1])
    return answers


def _digest(data: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(data, sort_keys=True).encode()).hexdigest()


def _reason(reason: str, seconds: float) -> tuple[str, float]:
    return reason, seconds


def _result(task: Task[T], answer: Answer) -> T:
    """Result of ``task``. Raises StoreError where the file that a worker wrote is not seen here."""
    if not isinstance(answer, str):
        return task.failed(*answer)
    if _digest(read_checked(task.path)) != answer:
        raise StoreError(f"{task.path}: not what a worker wrote; give an --output that all workers share")
    return read_result(task, 0.0)
