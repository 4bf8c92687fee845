"""Work for another process: a task."""

from collections.abc import Callable, Hashable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Generic, TypeVar

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
