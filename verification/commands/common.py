"""What the commands share: exit codes, colours of outcomes, one-sentence complaints, a bar with time left."""

import sys
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from verification.result import CaseResult
from verification.verdict import Outcome

__all__ = [
    "BAD_INPUT",
    "BASELINE",
    "DRIFTED",
    "EXIT",
    "RECORDS",
    "STYLE",
    "complain",
    "exit_code",
    "one_line",
    "progress_bar",
]

BASELINE = Path("reports/baseline")
RECORDS = Path("reports/credibility")
BAD_INPUT = 2
DRIFTED = 5  # all agree, but not with the digits of the baseline
EXIT = {Outcome.DISAGREES: 1, Outcome.NO_RESULT: 3, Outcome.INCONCLUSIVE: 4, Outcome.AGREES: 0}
STYLE = {
    Outcome.AGREES: "green",
    Outcome.DISAGREES: "bold red",
    Outcome.NO_RESULT: "bold red",
    Outcome.INCONCLUSIVE: "yellow",
}


def exit_code(results: Sequence[CaseResult]) -> int:
    """The code of the worst outcome: disagreement before a missing result before inconclusive."""
    found = {result.outcome for result in results}
    for outcome in (Outcome.DISAGREES, Outcome.NO_RESULT, Outcome.INCONCLUSIVE):
        if outcome in found:
            return EXIT[outcome]
    return EXIT[Outcome.AGREES] if found else EXIT[Outcome.NO_RESULT]


def complain(sentence: str) -> int:
    """Say on standard error, in one line, what is wrong; the exit code of bad input."""
    sys.stderr.write(f"coatcheck: {one_line(sentence)}\n")
    return BAD_INPUT


def one_line(sentence: str, most: int = 1000) -> str:
    """``sentence`` as a terminal may show it: no control character of a stranger's file gets through."""
    shown = "".join(c if c.isprintable() else repr(c)[1:-1] for c in sentence)
    return shown if len(shown) <= most else f"{shown[: most - 3]}..."


def progress_bar(console: Console, *, silent: bool = False) -> Progress:
    """A bar that counts, with time gone and left; nothing at all where ``console`` is not a terminal."""
    return Progress(
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=console,
        transient=True,
        disable=silent or not console.is_terminal,
    )
