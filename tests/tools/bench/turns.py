"""Work timed in turn: a process for each piece, which does it whenever its turn comes, one at a time.

Whatever slows the machine meets all of them alike, so that ratios hold where seconds do not.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

import verification

__all__ = ["HERE", "Times", "Work", "in_turn"]

HERE = Path(verification.__file__).parents[1]
_CHILD = Path(__file__).with_name("child.py")
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


@dataclass(frozen=True)
class Work:
    """A function of ``child`` with its arguments, on the packages below ``root``.

    threads : set from outside.
    """

    name: str
    arguments: tuple[str | float | bool, ...] = ()
    root: Path = HERE
    python: str = sys.executable
    threads: int = 1


@dataclass(frozen=True)
class Times:
    """Wall and processor seconds of the turns of a work.

    growth : of the peak resident set by the first turn [bytes].
    residual : of the last result, by the judge; 0 where it has none to judge.
    ratios : of a work that measures them itself.
    """

    seconds: tuple[float, ...]
    processor: tuple[float, ...]
    growth: float
    residual: float
    ratios: tuple[float, ...] = ()

    def of(self, processor: bool) -> tuple[float, ...]:
        """Processor seconds or wall seconds."""
        return self.processor if processor else self.seconds


def in_turn(
    works: Mapping[str, Work],
    rounds: int,
    *,
    enough: float = 1200.0,
    progress: Callable[[str], None] = lambda name: None,
) -> dict[str, Times]:
    """Do every one of the ``works`` in each of the ``rounds``, in their order; the first round is not timed.

    enough : seconds after which no further round begins.   progress : called with a name before each turn.
    Raises RuntimeError with the last line of a child that fails.
    """
    answers: dict[str, list[dict[str, float]]] = {name: [] for name in works}
    began = time.monotonic()
    with ExitStack() as stack:
        children = {name: stack.enter_context(_Child(name, work)) for name, work in works.items()}
        for turn in range(rounds + 1):
            if turn > 1 and time.monotonic() - began > enough:
                break
            for name, child in children.items():
                progress(name)
                answers[name].append(child.answer(str(turn)))
        residuals = {name: child.answer("judge")["residual"] for name, child in children.items()}
    return {
        name: Times(
            tuple(answer["seconds"] for answer in timed),
            tuple(answer["processor"] for answer in timed),
            timed[0]["peak"] - first["peak"],
            residuals[name],
            tuple(answer["ratio"] for answer in timed if "ratio" in answer),
        )
        for name, (first, *timed) in answers.items()
    }


class _Child:
    """The process of a work, ended with the context."""

    def __init__(self, name: str, work: Work) -> None:
        self._name = name
        self._messages = tempfile.TemporaryFile()  # noqa: SIM115  closed with the context
        threads = dict.fromkeys(_THREADS, str(work.threads))
        self._process = subprocess.Popen(
            # -P: the modules beside the child's file are not those of the packages measured
            [work.python, "-P", str(_CHILD), work.name, json.dumps(work.arguments)],
            env=os.environ | threads | {"PYTHONPATH": str(work.root)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._messages,
            text=True,
        )

    def __enter__(self) -> "_Child":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._process.kill()
        self._process.communicate()
        self._messages.close()

    def answer(self, line: str) -> dict[str, Any]:
        """The child's answer to ``line``. Raises RuntimeError with its last line where it gives none."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        try:
            self._process.stdin.write(f"{line}\n")
            self._process.stdin.flush()
            content: dict[str, Any] = json.loads(self._process.stdout.readline())
        except (OSError, ValueError):
            self._process.wait()
            self._messages.seek(0)
            lines = self._messages.read().decode(errors="replace").strip().splitlines()
            raise RuntimeError(f"{self._name} failed: {(lines or ['no message'])[-1]}") from None
        return content
