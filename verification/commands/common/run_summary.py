"""Findings of a run, on the terminal and as JSON."""

import os
from collections import Counter
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from verification.commands.common.terminal import STYLE, UNBROKEN, named_table, one_line, while_read
from verification.judging.invariant_verdict import Invariant
from verification.judging.outcome import DECIDED, Outcome
from verification.regression.baseline_change import Regression, State, baseline_message
from verification.regression.manifest import manifest_message
from verification.running.case_result import CaseResult
from verification.running.published_counts import published_message

NARROW = 80  # columns


def run_json(
    results: Sequence[CaseResult],
    page: Path,
    baseline: Mapping[str, Any],
    passed: Mapping[str, bool],
    beyond: Mapping[str, tuple[str, ...]],
    code: int,
    studies: Sequence[Invariant] = (),
) -> dict[str, Any]:
    """The outcome of a run as JSON.

    baseline : comparison with it.   passed : of each self-test.   beyond : see ``Evidence``.
    studies : the judged studies.
    """
    states = {case["name"]: case["state"] for case in baseline["cases"]}
    return {
        "report": str(page),
        "exit_code": code,
        "studies": {study.name: study.outcome for study in studies},
        "self_tests": dict(passed),
        "baseline": baseline,
        "cases": {
            result.name: {
                "outcome": result.outcome,
                "baseline": states.get(result.name),
                "warnings": [*result.warnings, *beyond.get(result.name, ())],
                "verdicts": {o: sum(v.outcome is o for _, v in result.verdicts) for o in DECIDED},
                "invariants": {o: sum(law.outcome is o for law in result.invariants) for o in DECIDED},
            }
            for result in results
        },
    }


@while_read()
def print_run(
    results: Sequence[CaseResult],
    page: Path,
    seconds: float,
    beside: Regression,
    studies: Sequence[Invariant] = (),
) -> None:
    """Print a table of the cases, then a line for each failure and for the run as a whole."""
    console = Console()
    if not console.is_terminal and "COLUMNS" not in os.environ:
        console = Console(width=UNBROKEN)
    console.print(_table(results, beside, narrow=console.width < NARROW))
    # In a pipe each message stays on one line.
    say = partial(console.print, highlight=False, soft_wrap=not console.is_terminal)
    for result in results:
        name = escape(result.name)
        for source in result.sources:
            if source.failure:
                say(f"[bold red]{name}, {source.source}:[/] {escape(one_line(source.failure))}")
        for law in result.invariants:
            if law.outcome is not Outcome.AGREES:
                what = f"{name}, {law.source}, {escape(law.name)}:"
                say(f"[{STYLE[law.outcome]}]{what}[/] {escape(one_line(law.message))}")
    laws = [law for result in results for law in result.invariants]
    if laws:
        say(f"{sum(law.outcome is Outcome.AGREES for law in laws)} of {len(laws)} invariants hold")
    for study in studies:
        if study.outcome is not Outcome.AGREES:
            say(f"[{STYLE[study.outcome]}]study, {escape(study.name)}:[/] {escape(one_line(study.message))}")
    if studies:
        say(f"{sum(one.outcome is Outcome.AGREES for one in studies)} of {len(studies)} judged studies agree")
    if published := [result for result in results if result.published]:
        say(published_message(published))
    known = f"baseline of {beside.update.when[:10]} in {beside.folder}: " if beside.update is not None else ""
    say(escape(f"{known}{baseline_message(beside)}"))
    for rows, style in ((beside.less, "bold red"), (beside.judged, "yellow")):
        if message := manifest_message(rows):
            say(f"[{style}]manifest:[/] {escape(message)}")
            break
    number = "1 case" if len(results) == 1 else f"{len(results)} cases"
    say(f"{number} in {seconds:.0f} s; report: {escape(str(page))}")


def _table(results: Sequence[CaseResult], beside: Regression, *, narrow: bool) -> Table:
    # Fits 80 columns beside the longest name of a shipped case; letters where there are fewer.
    heads = ["agrees", "dis-\nagrees", "incon-\nclusive", "no\nresult", "largest\ndifference"]
    if narrow:
        heads = ["A", "D", "I", "N", "largest"]
    # Without a baseline, or in a narrow terminal, the line below the table is enough.
    states = beside.update is not None and not narrow
    heads += ["baseline"] if states else []
    table = named_table("case")
    for head in heads:
        table.add_column(head, no_wrap=True, vertical="bottom")
    for result in results:
        worst = max((v.difference for _, v in result.verdicts if v.difference is not None), default=None)
        count = Counter(verdict.outcome for _, verdict in result.verdicts)
        counts = [f"[{STYLE[o]}]{count[o]}[/]" if count[o] else "." for o in DECIDED]
        state = [_state(beside, result.name)] if states else []
        table.add_row(escape(result.name), *counts, "-" if worst is None else f"{worst:.1e}", *state)
    return table


def _state(beside: Regression, name: str) -> str:
    found = beside.of(name)
    if found is None:
        return "-"
    return f"[{'green' if found.state is State.SAME else 'yellow'}]{found.state}[/]"
