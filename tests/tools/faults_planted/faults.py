"""Planted faults: mistakes planted one at a time, with the checks of the default run that catch them."""

import datetime
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter
from rich.markup import escape

from verification.commands.common.command_error import CommandError, no_result
from verification.commands.common.known_folders import RECORDS, require_checkout
from verification.commands.common.shared_options import (
    AsJson,
    Flag,
    Jobs,
    Output,
    Quiet,
    RecordsFolder,
    Resume,
)
from verification.commands.common.task_progress import kept_results, run_info, solve, worker_count
from verification.commands.common.terminal import (
    did_you_mean,
    named_table,
    print_json,
    print_out,
    with_exit_code,
)
from verification.commands.common.terminal_bar import require_gmsh
from verification.running.case_tasks import case_task
from verification.running.checked_files import locked

if TYPE_CHECKING:
    from faults_planted.fault_planting import Fault
    from verification.evidence.fault_record import Record


@with_exit_code
def faults(
    *names: str,
    group: str | None = None,
    listed: Annotated[bool, Parameter(name="--list", negative="")] = False,
    output: Output = Path("reports/faults"),
    record: Flag = False,
    records: RecordsFolder = RECORDS,
    jobs: Jobs = None,
    time_limit: float = 300.0,
    resume: Resume = False,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> int:
    """Plant one mistake at a time in the running code; report which checks of the default run catch it.

    Without arguments every fault is tried, then the negative controls: nothing planted, so that no check
    should fail. The source on disk is never changed.

    Exit codes: 0 at least 95 % are caught, every survivor explained; 1 not so; 2 bad input.

    Args:
        names: Names of faults, see --list; all of them unless given.
        group: Try one group: material, ball, frf, conversion_fft, conjugate_gradients, grids, edge,
            stress, rings, finite_elements, fields, references, harness, coverage.
        listed: List the faults instead of trying them.
        output: Directory of the matrix, faults.json, which coatcheck report shows with --records OUTPUT, of
            the clean runs, of the trials.
        record: Store the matrix of all faults as RECORDS/faults.json, for the credibility page of a report.
        time_limit: Seconds one fault may take before it is stopped and counted as not tried.
    """
    jobs = worker_count(jobs, time_limit=time_limit)
    from faults_planted.fault_catalogue import CONTROLS, FAULTS, chosen
    from verification.evidence.fault_record import GROUPS

    if group is not None and (group not in GROUPS or names):
        remedy = "give a group or names, not both" if names else f"choose one of {', '.join(GROUPS)}"
        raise CommandError(f"--group = {group}: {remedy}{did_you_mean(group, GROUPS)}")
    try:
        wanted = chosen(names, group)
    except KeyError as error:
        name = str(error.args[0])
        near = did_you_mean(name, FAULTS | CONTROLS)
        raise CommandError(f"{name}: no fault has this name, see --list{near}") from None
    if listed:
        _list(wanted, as_json)
        return 0
    if record and (names or group):
        raise CommandError("--record stores the matrix of all faults; leave names and --group out")
    if record:
        require_checkout(records, "--records")
    require_gmsh()

    from faults_planted import fault_campaign
    from verification.evidence.fault_record import to_json, write_record

    started = datetime.datetime.now(datetime.UTC)
    with locked(output):
        solve_clean(wanted, output, jobs, time_limit, resume, quiet or as_json)
        kept = {f.name: t for f in wanted if resume and (t := fault_campaign.kept_trial(f, output))}
        # the long ones first, so that no core waits at the end
        order = sorted((f for f in wanted if f.name not in kept), key=fault_campaign.cost, reverse=True)
        trials = [fault_campaign.trial_task(fault, output) for fault in order]
        fresh = {trial.fault: trial for trial in solve(trials, jobs, time_limit, quiet or as_json)}
        info = run_info("tests/tools faults", started, jobs)
        found = fault_campaign.record_of([kept.get(f.name) or fresh[f.name] for f in wanted], info)
        matrix = write_record(output, found)
        if record:
            write_record(records, found)
    if as_json:
        print_json(to_json(found))
    elif not quiet:
        _print(found, matrix)
    return 0 if found.passed else 1


def solve_clean(
    wanted: Sequence["Fault"], output: Path, jobs: int, time_limit: float, resume: bool, silent: bool
) -> None:
    """Solve the cases of ``wanted`` without a fault; ends the command where that fails."""
    from faults_planted import fault_campaign

    folder = fault_campaign.clean_folder(output)
    cases = fault_campaign.clean_cases(wanted)
    clean = kept_results(cases, folder) if resume else {}
    tasks = [case_task(case, folder) for case in cases if case.name not in clean]
    if reason := fault_campaign.failed_source([*clean.values(), *solve(tasks, jobs, time_limit, silent)]):
        raise no_result(reason)


def _list(wanted: Sequence["Fault"], as_json: bool) -> None:
    if as_json:
        keys = ("name", "group", "where", "description")
        return print_json([{key: getattr(fault, key) for key in keys} for fault in wanted])
    table = named_table("fault", "group", "what is wrong")
    for fault in wanted:
        table.add_row(fault.name, fault.group, escape(fault.description))
    return print_out(table)


def _print(found: "Record", matrix: Path) -> None:
    from verification.evidence.fault_record import GROUPS, Catch

    shown = [catch for catch in Catch if any(row.catch is catch for row in found.rows)]
    table = named_table("group", "faults", *shown, "predicted check")
    for group, title in GROUPS.items():
        rows = [row for row in found.rows if row.group == group]
        if rows:
            count = Counter(row.catch for row in rows)
            cells = [str(count[catch] or ".") for catch in shown]
            table.add_row(title, str(len(rows)), *cells, str(sum(row.as_predicted for row in rows)))
    if found.rows:
        print_out(table)
    for row in (row for row in found.rows if not row.caught):
        reason = (
            f"{row.reason}; {row.remedy} would catch it" if row.reason else row.failure or "not explained"
        )
        print_out(f"[bold red]{row.catch}[/] {row.name}: {escape(row.description)}. {escape(reason)}")
    for row in found.idle:
        print_out(f"[bold red]changes nothing[/] {row.name}")
    for row in found.alarms:
        print_out(f"[bold red]alarm[/] {row.name}, nothing planted: {escape(row.by)}")
    for failure in found.failing_clean:
        print_out(f"[bold red]fails without a fault[/] {escape(failure)}")
    text = f"{found.caught} of {len(found.tried)} faults caught ({100 * found.share:.0f} %), "
    text += f"{found.as_predicted} by the predicted check"
    if found.controls:
        text += f"; {len(found.alarms)} alarms in {len(found.controls)} negative controls"
    print_out(f"{text}; {found.seconds:.0f} s; matrix: {escape(str(matrix))}")
