"""What the commands share: exit codes, colours of outcomes, messages of one line.

The command line imports this for each command, so nothing here needs numpy or rich.
"""

import datetime
import json
import sys
from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

import verification
from verification.judging.outcome import Outcome

if TYPE_CHECKING:
    from rich.table import Table

    from verification.running.result import CaseResult, RunInfo

UNBROKEN = 100_000  # columns of a file or pipe
PACKAGE = Path(verification.__file__).parent
BASELINE = PACKAGE / "regression" / "shipped"
RECORDS = PACKAGE / "credibility" / "shipped"
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

Flag = Annotated[bool, Parameter(negative="")]
Output = Annotated[Path, Parameter(name=["--output", "-o"])]
BaselineFolder = Annotated[
    Path,
    Parameter(
        name=["--baseline", "-b"],
        help="Directory of the baseline; that of the package unless given.",
        show_default=False,
    ),
]
RecordsFolder = Annotated[
    Path,
    Parameter(
        help="Directory of the credibility records; that of the package unless given.", show_default=False
    ),
]
Jobs = Annotated[
    int | None, Parameter(name=["--jobs", "-j"], help="Processes side by side; all cores unless given.")
]
Resume = Annotated[bool, Parameter(negative="", help="Keep the valid results in the output directory.")]
Quiet = Annotated[bool, Parameter(name=["--quiet", "-q"], negative="", help="Print nothing but errors.")]
AsJson = Annotated[bool, Parameter(name="--json", negative="", help="Print JSON instead of text.")]


def exit_code(results: Sequence["CaseResult"]) -> int:
    """The code of the worst outcome: disagreement before a missing result before inconclusive."""
    found = {result.outcome for result in results}
    for outcome in (Outcome.DISAGREES, Outcome.NO_RESULT, Outcome.INCONCLUSIVE):
        if outcome in found:
            return EXIT[outcome]
    return EXIT[Outcome.AGREES] if found else EXIT[Outcome.NO_RESULT]


def print_error(message: str) -> int:
    """Print ``message`` on standard error, in one line. Returns the exit code of bad input."""
    sys.stderr.write(f"coatcheck: {one_line(message)}\n")
    return BAD_INPUT


def print_json(content: Any) -> None:
    """Print ``content`` on standard output as JSON."""
    sys.stdout.write(json.dumps(content, indent=2) + "\n")


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """ "; did you mean ...?" with the names nearest to a mistyped ``name``; "" where none is near."""
    near = get_close_matches(name.casefold(), list(known), n=2)
    return f"; did you mean {' or '.join(near)}?" if near else ""


def nearest_run(path: Path) -> str:
    """The run directories that a path of no directory may have meant, as ``did_you_mean``."""
    if path.exists() or not path.parent.is_dir():
        return ""
    runs = {folder.name: str(folder) for folder in path.parent.iterdir() if (folder / "report.json").exists()}
    return did_you_mean(path.name, runs)


def named_table(*heads: str) -> "Table":
    """A table for ``print_out``; its first column holds names that users type."""
    from rich.table import Column, Table

    return Table(Column(heads[0], overflow="fold"), *heads[1:], box=None, header_style="bold")


def print_out(*items: "Table | str") -> None:
    """Print tables with lines of markup. Names in a first column are never cut, in a file or pipe no line."""
    from rich.console import Console
    from rich.table import Table

    console = Console(highlight=False)
    if not console.is_terminal:
        console = Console(highlight=False, width=UNBROKEN)
    for item in items:
        if isinstance(item, Table):
            # The other columns give way first, unless the names fill half of the terminal.
            longest = max((len(str(cell)) for cell in item.columns[0].cells), default=0)
            item.columns[0].no_wrap = longest <= console.width / 2
        console.print(item)


def one_line(message: str, most: int = 1000) -> str:
    """``message`` in one line without control characters, which an untrusted file may hold."""
    shown = "".join(c if c.isprintable() else repr(c)[1:-1] for c in message)
    return shown if len(shown) <= most else f"{shown[: most - 3]}..."


def no_gmsh() -> int | None:
    """None where gmsh can be loaded; else prints the packages to install and returns the exit code."""
    from verification.running.provenance import missing_libraries

    if not (lacking := missing_libraries()):
        return None
    print_error(f"gmsh lacks system libraries here; install them with: apt-get install {' '.join(lacking)}")
    return EXIT[Outcome.NO_RESULT]


def refuse_installed(folder: Path, option: str) -> int | None:
    """The exit code where ``folder`` is the package's own and not of a source checkout, after a message."""
    from verification.running.provenance import commit

    if folder not in (BASELINE, RECORDS) or commit() is not None:
        return None
    return print_error(f"this coatcheck is installed, not a source checkout; name a directory with {option}")


def within_package(folder: Path) -> str:
    """``folder`` as a report names it: the package's own without the place where it is installed."""
    return str(folder.relative_to(PACKAGE.parent) if folder.is_relative_to(PACKAGE) else folder)


def run_info(command: str, started: datetime.datetime, jobs: int) -> "RunInfo":
    """Command, time, commit, machine and versions of the run that ends now."""
    from verification.running.pool import cores
    from verification.running.provenance import commit, machine, versions
    from verification.running.result import RunInfo

    return RunInfo(
        command=command,
        started=started.isoformat(timespec="seconds"),
        seconds=(datetime.datetime.now(datetime.UTC) - started).total_seconds(),
        jobs=jobs,
        commit=commit(),
        machine=f"{machine()}, {cores()} cores",
        versions=versions(),
    )
