"""What a worker of a scheduler keeps between two requests: processes that have imported what tasks need."""

from collections.abc import Callable
from typing import Any

from distributed import get_worker
from distributed.diagnostics.plugin import WorkerPlugin

from verification.running.pool.process_pool import Slot

__all__ = ["Kept", "abandoned", "kept"]


class Kept(WorkerPlugin):
    """Idle processes of a worker. They end with it."""

    name = "coatcheck"
    idempotent = True  # those of an earlier run serve the next

    def __init__(self) -> None:
        self.idle: list[Slot[Any]] = []

    def teardown(self, worker: Any) -> None:
        while self.idle:
            self.idle.pop().close()


def kept() -> Kept | None:
    """That of the worker of this thread; None elsewhere."""
    try:
        found = get_worker().plugins.get(Kept.name)
    except ValueError:  # not a worker's thread
        return None
    return found if isinstance(found, Kept) else None


def abandoned() -> Callable[[], bool]:
    """Whether the scheduler has dropped the task of this thread: its client stopped, or is gone."""
    try:
        worker = get_worker()
    except ValueError:
        return lambda: False
    tasks, key = worker.state.tasks, worker.get_current_task()
    return lambda: key not in tasks or tasks[key].state == "cancelled"
