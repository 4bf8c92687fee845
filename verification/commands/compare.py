"""coatcheck compare: two runs side by side."""

from dataclasses import asdict
from pathlib import Path

from rich.markup import escape

from verification.commands.common.command_error import CommandError
from verification.commands.common.known_folders import nearest_run
from verification.commands.common.shared_options import AsJson, Quiet
from verification.commands.common.terminal import (
    STYLE,
    named_table,
    one_line,
    print_json,
    print_out,
    with_exit_code,
)
from verification.judging.verdict import Outcome
from verification.regression.number_drift import State
from verification.regression.run_comparison import RunComparison, compare_runs, comparison_message
from verification.regression.run_exit_codes import DRIFTED, EXIT
from verification.running.checked_files import StoreError
from verification.running.json_records import plain
from verification.running.stored_run import read_run

MOST_SHOWN = 8


@with_exit_code
def compare(first: Path, second: Path, *, quiet: Quiet = False, as_json: AsJson = False) -> int:
    """Show two runs side by side: verdicts that changed, numbers that drifted, versions, times.

    Exit codes: 0 nothing changed, 5 numbers differ, 1 a comparison no longer agrees, 2 bad input.

    Args:
        first: Directory of a run, or its report.json.
        second: The run that is compared with it.
    """
    try:
        found = compare_runs(read_run(first), read_run(second))
    except StoreError as error:
        raise CommandError(f"{error}{nearest_run(first) or nearest_run(second)}") from None
    if as_json:
        print_json({**plain(asdict(found)), "drifted": found.drifted, "worse": found.worse})
    elif not quiet:
        _print(found)
    return EXIT[Outcome.DISAGREES] if found.worse else DRIFTED if found.drifted else EXIT[Outcome.AGREES]


def _print(found: RunComparison) -> None:
    states = [state for state in State if any(case.count(state) for case in found.cases)]
    table = named_table("case", "state", *states, "largest change", "first s", "second s")
    times = {name: (then, now) for name, then, now in found.seconds}
    for case in found.cases:
        colour = "green" if case.state is State.SAME else "yellow"
        seconds = ["-" if s is None else f"{s:.1f}" for s in times.get(case.name, (None, None))]
        largest = "-" if case.change is None else f"{case.change:.1e}"
        counts = [str(case.count(state) or ".") for state in states]
        table.add_row(escape(case.name), f"[{colour}]{case.state}[/]", *counts, largest, *seconds)
    print_out(table)
    for change in sorted(found.verdicts, key=lambda c: not c.worse)[:MOST_SHOWN]:
        outcomes = " to ".join(
            "no claim" if o is None else f"[{STYLE[o]}]{o}[/]" for o in (change.before, change.after)
        )
        what = f"{change.case}, {change.quantity} on {change.line}, {' against '.join(change.between)}"
        print_out(f"{escape(what)}: {outcomes}; {escape(one_line(change.reason))}")
    if (more := len(found.verdicts) - MOST_SHOWN) > 0:
        print_out(f"... with {more} more, which --json shows")
    for name, then, now in found.versions:
        print_out(escape(f"{name}: {one_line(then)} to {one_line(now)}"))
    print_out(comparison_message(found))
