"""coatcheck baseline: the stored numbers that every run is compared with."""

import datetime
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from rich.markup import escape

from verification.cases.case_file import default_cases
from verification.commands.common.command_error import CommandError
from verification.commands.common.known_folders import BASELINE, require_checkout
from verification.commands.common.shared_options import BaselineFolder, Quiet
from verification.commands.common.terminal import print_out, with_exit_code
from verification.credibility.self_tests import self_tests
from verification.judging.verdict import Outcome
from verification.regression.baseline_change import updated
from verification.regression.baseline_file import read_baseline, write_baseline
from verification.running.checked_files import locked
from verification.running.stored_run import StoredRun, confirm, read_run


@with_exit_code
def update(*runs: Path, why: str = "", baseline: BaselineFolder = BASELINE, quiet: Quiet = False) -> int:
    """Make stored runs the baseline, with their manifest; no other command changes it.

    Together the runs must hold every shipped case, and these must agree throughout. Published cases may be
    among them; published cases that are absent, or do not agree, keep their numbers.

    Args:
        runs: Directories of the runs, or their report.json; reports without any.
        why: The reason, stored with date, commit and versions in the baseline's history; required.
    """
    if not why.strip():
        raise CommandError('--why is empty; give the reason: coatcheck baseline update --why "..."')
    require_checkout(baseline, "--baseline")
    found = [read_run(run) for run in runs or (Path("reports"),)]
    _refuse_unfit(found)
    for run in found:
        confirm(run)
    info = found[0].info
    results = [r for run in found for r in run.results if not r.published or r.outcome is Outcome.AGREES]
    tests = {test.name: test.answers for test in self_tests()}
    now = datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds")
    with locked(baseline):
        made = updated(read_baseline(baseline), results, info, " ".join(why.split()), now, tests)
        path = write_baseline(baseline, made)
    if not quiet:
        changed = made.last.changes
        size = path.stat().st_size / 1e3
        print_out(escape(f"{len(made.cases)} cases, {made.last.numbers} numbers, {size:.0f} kB: {path}"))
        for name, (count, change) in changed.items():
            by = "" if change is None else f", by up to {change:.1e} of their scale"
            print_out(escape(f"{name}: {count} numbers changed{by}"))
        for row in made.last.less:
            print_out(escape(f"no longer judged: {row.case or 'harness'}, {row.message} ({row.count})"))
        if not changed and len(made.history) > 1:
            print_out("no number changed")
    return 0


def _refuse_unfit(runs: Sequence[StoredRun]) -> None:
    """Raises CommandError with the reason why the runs cannot be a baseline."""
    run = runs[0]
    names = Counter(result.name for run in runs for result in run.results)
    lacking = [name for name in default_cases() if name not in names]
    twice = [name for name, count in names.items() if count > 1]
    other = [
        one for one in runs if (one.info.machine, one.info.versions) != (run.info.machine, run.info.versions)
    ]
    if twice:
        raise CommandError(f"{run.path}: {twice[0]} is in two of the runs; name one of them")
    if other:
        raise CommandError(f"{other[0].path}: of another machine or of other versions than {run.path}")
    if lacking:
        raise CommandError(
            f"{run.path}: lacks {len(lacking)} of the shipped cases, first {lacking[0]}; a baseline is made "
            "from a default run: coatcheck run"
        )
    for result in (result for run in runs for result in run.results if not result.published):
        if result.outcome is not Outcome.AGREES:
            raise CommandError(
                f"{run.path}: {result.name} {result.outcome}; a baseline is made where every case agrees"
            )
