"""coatcheck compare: two runs side by side."""

import json
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from verification.commands.common import DRIFTED, EXIT, STYLE, one_line, print_error
from verification.judging.verdict import Outcome
from verification.regression.comparison import RunComparison, compare_runs
from verification.regression.drift import State
from verification.running.result import plain
from verification.running.store import StoreError, write_atomically
from verification.running.stored import read_run

__all__ = ["compare"]

MOST_SHOWN = 8


def compare(
    first: Path,
    second: Path,
    *,
    output: Annotated[Path | None, Parameter(name=["--output", "-o"])] = None,
    quiet: Annotated[bool, Parameter(name=["--quiet", "-q"], negative="")] = False,
    as_json: Annotated[bool, Parameter(name="--json", negative="")] = False,
) -> int:
    """Show two runs side by side: verdicts that changed, numbers that drifted, versions, times. Example:

        coatcheck compare reports reports/mine --output compare.html

    Exit codes: 0 nothing changed, 5 numbers differ, 1 a comparison that agreed does so no more, 2 bad input.

    Parameters
    ----------
    first
        Directory of a run, or its report.json.
    second
        The run that is held against it.
    output
        Also write all of it to this HTML file.
    quiet
        Print nothing but errors.
    as_json
        Print everything as JSON.
    """
    try:
        found = compare_runs(read_run(first), read_run(second))
        if output is not None:
            from verification.report.comparison import comparison_page

            write_atomically(output, comparison_page(found).encode("utf-8", errors="replace"))
    except StoreError as error:
        return print_error(str(error))
    if as_json:
        content = {**plain(asdict(found)), "drifted": found.drifted, "worse": found.worse}
        sys.stdout.write(json.dumps(content, indent=2) + "\n")
    elif not quiet:
        _print(found)
        if output is not None:
            Console().print(escape(f"page: {output}"), highlight=False)
    return EXIT[Outcome.DISAGREES] if found.worse else DRIFTED if found.drifted else EXIT[Outcome.AGREES]


def _print(found: RunComparison) -> None:
    console = Console()
    table = Table(
        "case", "state", *State, "largest change", "first s", "second s", box=None, header_style="bold"
    )
    times = {name: (then, now) for name, then, now in found.seconds}
    for case in found.cases:
        colour = "green" if case.state is State.SAME else "yellow"
        seconds = ["-" if s is None else f"{s:.1f}" for s in times.get(case.name, (None, None))]
        largest = "-" if case.change is None else f"{case.change:.1e}"
        counts = [str(case.count(state) or ".") for state in State]
        table.add_row(escape(case.name), f"[{colour}]{case.state}[/]", *counts, largest, *seconds)
    console.print(table)
    for change in sorted(found.verdicts, key=lambda c: not c.worse)[:MOST_SHOWN]:
        said = " to ".join(
            "no claim" if o is None else f"[{STYLE[o]}]{o}[/]" for o in (change.before, change.after)
        )
        what = f"{change.case}, {change.quantity} on {change.line}, {' against '.join(change.between)}"
        console.print(f"{escape(what)}: {said}; {escape(one_line(change.reason))}", highlight=False)
    more = len(found.verdicts) - MOST_SHOWN
    if more > 0:
        console.print(f"... with {more} more, which --output or --json shows", highlight=False)
    for name, then, now in found.versions:
        console.print(escape(f"{name}: {one_line(then)} to {one_line(now)}"), highlight=False)
    from verification.report.comparison import comparison_sentence

    console.print(comparison_sentence(found), highlight=False)
