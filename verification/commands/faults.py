"""coatcheck faults: plant one mistake at a time and see which checks of the default run catch it."""

import datetime
import json
import sys
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from verification.commands.common import EXIT, RECORDS, RecordsFolder, no_gmsh, print_error, refuse_installed
from verification.commands.solving import kept_results, solve
from verification.judging.verdict import Outcome
from verification.running.pool import cores
from verification.running.provenance import commit, machine, versions
from verification.running.store import StoreError, locked, write_atomically
from verification.running.tasks import case_task

if TYPE_CHECKING:
    from verification.credibility.faults.planting import Fault
    from verification.credibility.faults.record import Record

__all__ = ["faults"]


def faults(
    *names: str,
    group: str | None = None,
    listed: Annotated[bool, Parameter(name="--list", negative="")] = False,
    output: Annotated[Path, Parameter(name=["--output", "-o"])] = Path("reports/faults"),
    record: Annotated[bool, Parameter(negative="")] = False,
    records: RecordsFolder = RECORDS,
    jobs: Annotated[int | None, Parameter(name=["--jobs", "-j"])] = None,
    time_limit: float = 300.0,
    resume: Annotated[bool, Parameter(negative="")] = False,
    quiet: Annotated[bool, Parameter(name=["--quiet", "-q"], negative="")] = False,
    as_json: Annotated[bool, Parameter(name="--json", negative="")] = False,
) -> int:
    """Plant one mistake at a time in the running code; report which checks of the default run catch it.

    Without arguments every fault is tried, then the same with nothing planted, which nothing may catch. The
    source on disk is never touched. Examples:

        coatcheck faults --record
        coatcheck faults --group finite_elements
        coatcheck faults kap_sign no_padding

    Exit codes: 0 at least 95 % are caught, every survivor explained; 1 not so; 2 bad input.

    Parameters
    ----------
    names
        Names of faults, see --list; all of them unless given.
    group
        Try one group: material, frf, conversion_fft, conjugate_gradients, stress, finite_elements,
        references, harness.
    listed
        List the faults instead of trying them.
    output
        Directory of the matrix, faults.html with faults.json, of the clean runs, of the trials.
    record
        Store the matrix of all faults as RECORDS/faults.json, which the credibility page of a report reads.
    records
        Directory of the records; in a source checkout that of the package unless given.
    jobs
        Faults tried side by side; all cores unless given.
    time_limit
        Seconds one fault may take before it is stopped and counted as not tried.
    resume
        Keep the trials already in the output directory that belong to the same faults, the same code.
    quiet
        Print nothing but errors.
    as_json
        Print the matrix as JSON.
    """
    jobs = cores() if jobs is None else jobs
    if jobs < 1 or not time_limit > 0:
        return print_error(f"--jobs = {jobs}, --time-limit = {time_limit:g}; both must be positive")
    from verification.credibility.faults.catalogue import GROUPS, chosen

    if group is not None and (group not in GROUPS or names):
        said = "give a group or names, not both" if names else f"choose one of {', '.join(GROUPS)}"
        return print_error(f"--group = {group}: {said}")
    try:
        wanted = chosen(names, group)
    except KeyError as error:
        return print_error(f"{error.args[0]}: no fault has this name; see coatcheck faults --list")
    if listed:
        _list(wanted, as_json)
        return 0
    if record and (names or group):
        return print_error("--record stores the matrix of all faults; leave names and --group out")
    if record and (code := refuse_installed(records, "--records")) is not None:
        return code
    if (code := no_gmsh()) is not None:
        return code

    from verification.credibility.faults import campaign
    from verification.credibility.faults.record import to_json
    from verification.report.credibility.faults import faults_page

    begin, started = time.perf_counter(), datetime.datetime.now(datetime.UTC)
    try:
        with locked(output):
            cases = campaign.clean_cases(wanted)
            stood = kept_results(cases, campaign.clean_folder(output)) if resume else {}
            tasks = [case_task(c, campaign.clean_folder(output)) for c in cases if c.name not in stood]
            if said := campaign.unfit([*stood.values(), *solve(tasks, jobs, time_limit, quiet or as_json)]):
                print_error(said)
                return EXIT[Outcome.NO_RESULT]
            kept = {f.name: t for f in wanted if resume and (t := campaign.kept_trial(f, output))}
            # the long ones first, so that no core waits at the end
            order = sorted((f for f in wanted if f.name not in kept), key=campaign.cost, reverse=True)
            trials = [campaign.trial_task(fault, output) for fault in order]
            fresh = {trial.fault: trial for trial in solve(trials, jobs, time_limit, quiet or as_json)}
            found = campaign.record_of(
                [kept.get(f.name) or fresh[f.name] for f in wanted],
                started=started.isoformat(timespec="seconds"),
                seconds=time.perf_counter() - begin,
                commit=commit(),
                machine=f"{machine()}, {cores()} cores, {jobs} jobs",
                versions=versions(),
            )
            campaign.write_record(output / campaign.RECORD, found)
            page = output / "faults.html"
            write_atomically(page, faults_page(found))
            if record:
                campaign.write_record(records / campaign.RECORD, found)
    except StoreError as error:
        return print_error(str(error))
    if as_json:
        sys.stdout.write(json.dumps(to_json(found), indent=2) + "\n")
    elif not quiet:
        _print(found, page)
    return 0 if found.passed else 1


def _list(wanted: Sequence["Fault"], as_json: bool) -> None:
    if as_json:
        rows = [{"name": f.name, "group": f.group, "where": f.where, "sentence": f.sentence} for f in wanted]
        sys.stdout.write(json.dumps(rows, indent=2) + "\n")
        return
    table = Table("fault", "group", "what is wrong", box=None, header_style="bold")
    for fault in wanted:
        table.add_row(fault.name, fault.group, escape(fault.sentence))
    Console().print(table)


def _print(found: "Record", page: Path) -> None:
    from verification.credibility.faults.catalogue import GROUPS
    from verification.credibility.faults.record import Catch

    shown = [catch for catch in Catch if any(row.catch is catch for row in found.rows)]
    table = Table("group", "faults", *shown, "as foretold", box=None, header_style="bold")
    for group, title in GROUPS.items():
        rows = [row for row in found.rows if row.group == group]
        if rows:
            count = Counter(row.catch for row in rows)
            cells = [str(count[catch]) if count[catch] else "." for catch in shown]
            table.add_row(title, str(len(rows)), *cells, str(sum(row.as_expected for row in rows)))
    console = Console()
    if found.rows:
        console.print(table)
    for row in found.survivors:
        why = (
            f"{row.reason}; {row.cure} would catch it" if row.reason else row.failure or "nobody has said why"
        )
        console.print(
            f"[bold red]{row.catch}[/] {row.name}: {escape(row.sentence)}. {escape(why)}", highlight=False
        )
    for row in found.idle:
        console.print(f"[bold red]changes nothing[/] {row.name}", highlight=False)
    for row in found.alarms:
        console.print(f"[bold red]alarm[/] {row.name}, nothing planted: {escape(row.by)}", highlight=False)
    for said in found.already:
        console.print(f"[bold red]fails without a fault[/] {escape(said)}", highlight=False)
    said = f"{found.caught} of {len(found.rows)} faults caught ({100 * found.share:.0f} %), "
    said += f"{found.as_expected} by a check named for it beforehand"
    if found.blanks:
        said += f"; {len(found.alarms)} alarms in {len(found.blanks)} trials with nothing planted"
    console.print(f"{said}; {found.seconds:.0f} s; matrix: {escape(str(page))}", highlight=False)
