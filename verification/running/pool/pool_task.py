"""Work for another process: a task, and the order in which tasks run."""

from collections import deque
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Generic, TypeVar

from verification.running.checked_files import StoreError, read_checked

T = TypeVar("T")
T_co = TypeVar("T_co", covariant=True)


@dataclass(frozen=True)
class Task(Generic[T_co]):
    """Work for another process, which leaves a checked file at ``path``.

    work : a function of a module with its arguments.
    read : from what the file holds to the result.
    failed : the result of a process that left none, from the reason and its seconds.
    cost : estimate, of any unit; the costliest tasks start first.
    together : tasks of equal value other than None run one after the other in one process, so that they can
        share what they compute. Where one fails, the next starts in a process of its own.
    ahead : modules that all tasks of a process import once.
    """

    name: str
    work: partial[None]
    path: Path
    read: Callable[[dict[str, Any]], T_co]
    failed: Callable[[str, float], T_co]
    cost: float = 0.0
    together: Hashable = None
    ahead: tuple[str, ...] = ()

    def result(self, seconds: float) -> T_co:
        """The result in the file at ``path``; that of ``failed`` where the file cannot be used."""
        try:
            return self.read(read_checked(self.path))
        except (StoreError, ValueError, KeyError, TypeError, AttributeError) as error:
            return self.failed(" ".join(str(error).split()), seconds)


Group = deque[tuple[int, Task[T]]]  # tasks of one process, each with its number


def in_order(tasks: Sequence[Task[T]]) -> deque[Group[T]]:
    """Tasks by process, the costliest first: a long one that starts last would be waited for alone."""
    groups: dict[Hashable, Group[T]] = {}
    for number, task in enumerate(tasks):
        key = (number, None) if task.together is None else task.together
        groups.setdefault(key, deque()).append((number, task))
    return deque(sorted(groups.values(), key=lambda group: -sum(task.cost for _, task in group)))
