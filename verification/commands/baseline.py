"""coatcheck baseline: the stored numbers that every run is held against."""

import datetime
import json
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from verification.cases.contact import shipped_cases
from verification.commands.common import BASELINE, BaselineFolder, print_error, refuse_installed
from verification.judging.verdict import Outcome
from verification.regression.baseline import Baseline, Update, updated
from verification.regression.record import path_in, read_baseline, write_baseline
from verification.running.store import StoreError, locked
from verification.running.stored import StoredRun, confirm, read_run

__all__ = ["show", "update"]


def update(
    run: Path = Path("reports"),
    *,
    why: str = "",
    baseline: BaselineFolder = BASELINE,
    quiet: Annotated[bool, Parameter(name=["--quiet", "-q"], negative="")] = False,
) -> int:
    """Make a stored default run the baseline; nothing else ever changes it.

    The run must be whole, hold every shipped case, and agree throughout. Example:

        coatcheck run && coatcheck baseline update --why "finer grids: p0 nearer to exact by 3e-7"

    Parameters
    ----------
    run
        Directory of the run, or its report.json.
    why
        The reason, kept with date, commit and versions in the baseline's history. There is no update without.
    baseline
        Directory of the baseline; in a source checkout that of the package unless given.
    quiet
        Print nothing but errors.
    """
    if not why.strip():
        return print_error('--why is empty; give the reason: coatcheck baseline update --why "..."')
    if (code := refuse_installed(baseline, "--baseline")) is not None:
        return code
    try:
        found = read_run(run)
        unfit = _unfit(found)
        if unfit:
            return print_error(unfit)
        confirm(found)
        with locked(baseline):
            made = updated(read_baseline(baseline), found.results, found.info, " ".join(why.split()), _now())
            path = write_baseline(baseline, made)
    except StoreError as error:
        return print_error(str(error))
    if not quiet:
        console = Console()
        changed = made.last.changes
        size = path.stat().st_size / 1e3
        said = f"{len(made.cases)} cases, {made.last.numbers} numbers, {size:.0f} kB: {path}"
        console.print(escape(said), highlight=False)
        for name, (count, change) in changed.items():
            by = "" if change is None else f", by up to {change:.1e} of their scale"
            console.print(escape(f"{name}: {count} numbers are not what they were{by}"), highlight=False)
        if not changed and len(made.history) > 1:
            console.print("no number changed", highlight=False)
    return 0


def show(
    *,
    baseline: BaselineFolder = BASELINE,
    as_json: Annotated[bool, Parameter(name="--json", negative="")] = False,
) -> int:
    """Show what the baseline holds and every update it has seen, with its reason.

    Parameters
    ----------
    baseline
        Directory of the baseline; that of the package unless given.
    as_json
        Print one JSON object instead of tables.
    """
    try:
        stored = read_baseline(baseline)
    except StoreError as error:
        return print_error(str(error))
    if stored is None:
        return print_error(
            f'{path_in(baseline)}: there is no baseline; make one with: coatcheck baseline update --why "..."'
        )
    if as_json:
        content = {
            "path": str(path_in(baseline)),
            "cases": {name: sum(n.count for n in found) for name, found in stored.cases.items()},
            "history": [asdict(update) for update in stored.history],
        }
        sys.stdout.write(json.dumps(content, indent=2) + "\n")
        return 0
    _print(stored)
    return 0


def _unfit(run: StoredRun) -> str | None:
    """Why a run cannot be a baseline, in one sentence; None where it can."""
    names = {result.name for result in run.results}
    lacking = [name for name in shipped_cases() if name not in names]
    if lacking:
        return (
            f"{run.path}: lacks {len(lacking)} of the shipped cases, first {lacking[0]}; a baseline is made "
            "from a default run: coatcheck run"
        )
    for result in run.results:
        if result.outcome is not Outcome.AGREES:
            return f"{run.path}: {result.name} {result.outcome}; a baseline is made where every case agrees"
    return None


def _now() -> str:
    return datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds")


def _print(stored: Baseline) -> None:
    console = Console()
    last = stored.last
    numbers = Table("case", "profiles", "numbers", box=None, header_style="bold")
    for name, found in stored.cases.items():
        numbers.add_row(escape(name), str(len(found)), str(sum(n.count for n in found)))
    history = Table("when", "commit", "changed", "largest", "why", box=None, header_style="bold")
    for item in stored.history:
        history.add_row(item.when, item.commit or "-", *_changed(item), escape(item.why))
    console.print(numbers, "", history, "")
    console.print(f"{last.numbers} numbers, on {last.machine}", highlight=False)
    console.print(", ".join(f"{name} {version}" for name, version in last.versions.items()), highlight=False)


def _changed(item: Update) -> tuple[str, str]:
    if not item.changes:
        return "-", "-"
    largest = [change for _, change in item.changes.values() if change is not None]
    return str(sum(count for count, _ in item.changes.values())), f"{max(largest):.1e}" if largest else "-"
