"""What the commands share: exit codes, colours of outcomes, one-sentence complaints, a bar with time left."""

import datetime
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.progress import Task as RichTask
from rich.table import Column
from rich.text import Text

import verification
from verification.judging.verdict import Outcome
from verification.running.pool import cores
from verification.running.provenance import commit, machine, missing_libraries, versions
from verification.running.result import CaseResult, RunInfo

__all__ = [
    "BAD_INPUT",
    "BASELINE",
    "DRIFTED",
    "EXIT",
    "RECORDS",
    "STOPPED",
    "STYLE",
    "BaselineFolder",
    "RecordsFolder",
    "exit_code",
    "no_gmsh",
    "one_line",
    "print_error",
    "progress_bar",
    "refuse_installed",
    "run_info",
    "within_package",
]

NARROW = 60  # columns
PACKAGE = Path(verification.__file__).parent
BASELINE = PACKAGE / "regression" / "shipped"
RECORDS = PACKAGE / "credibility" / "shipped"
BaselineFolder = Annotated[Path, Parameter(name=["--baseline", "-b"], show_default=False)]
RecordsFolder = Annotated[Path, Parameter(show_default=False)]
BAD_INPUT = 2
STOPPED = 130  # as a shell has it of SIGINT
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


def print_error(sentence: str) -> int:
    """Say on standard error, in one line, what is wrong; the exit code of bad input."""
    sys.stderr.write(f"coatcheck: {one_line(sentence)}\n")
    return BAD_INPUT


def one_line(sentence: str, most: int = 1000) -> str:
    """``sentence`` as a terminal may show it: no control character of a stranger's file gets through."""
    shown = "".join(c if c.isprintable() else repr(c)[1:-1] for c in sentence)
    return shown if len(shown) <= most else f"{shown[: most - 3]}..."


def no_gmsh() -> int | None:
    """The exit code where gmsh cannot be loaded here, having said what to install; None where it can."""
    if not (lacking := missing_libraries()):
        return None
    print_error(f"gmsh lacks system libraries here; install them with: apt-get install {' '.join(lacking)}")
    return EXIT[Outcome.NO_RESULT]


def refuse_installed(folder: Path, option: str) -> int | None:
    """The exit code where ``folder`` is the package's own and not of a source checkout, after a message."""
    if folder not in (BASELINE, RECORDS) or commit() is not None:
        return None
    return print_error(f"this coatcheck is installed, not a source checkout; name a directory with {option}")


def within_package(folder: Path) -> str:
    """``folder`` as a report names it: the package's own without the place where it is installed."""
    return str(folder.relative_to(PACKAGE.parent) if folder.is_relative_to(PACKAGE) else folder)


def run_info(command: str, started: datetime.datetime, jobs: int) -> RunInfo:
    """What a report says of the run that ends now."""
    return RunInfo(
        command=command,
        started=started.isoformat(timespec="seconds"),
        seconds=(datetime.datetime.now(datetime.UTC) - started).total_seconds(),
        jobs=jobs,
        commit=commit(),
        machine=f"{machine()}, {cores()} cores",
        versions=versions(),
    )


class _Description(ProgressColumn):
    """What is at work, on one line."""

    def render(self, task: RichTask) -> Text:
        return Text(task.description, no_wrap=True, overflow="ellipsis")


def progress_bar(console: Console, *more: ProgressColumn, silent: bool = False) -> Progress:
    """A bar that counts, with time gone and left; nothing at all where ``console`` is not a terminal.

    more : columns behind the count.
    """
    return Progress(
        # Words and bar give way where the terminal is narrow; counts and times stay whole.
        _Description(table_column=Column(no_wrap=False)),
        *([BarColumn(table_column=Column(no_wrap=False))] if console.width >= NARROW else []),
        MofNCompleteColumn(),
        *more,
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=console,
        transient=True,
        disable=silent or not console.is_terminal,
    )
