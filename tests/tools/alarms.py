"""False alarms: verdicts other than AGREES on random problems that contain no error."""

import datetime
from collections.abc import Sequence
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path

import numpy as np
from drawn_problems import Draw, draw, draw_ellipse
from rich.markup import escape

from verification.cases.case_file import Case, parse_case
from verification.commands.common.command_error import CommandError
from verification.commands.common.known_folders import RECORDS, require_checkout
from verification.commands.common.shared_options import (
    AsJson,
    Flag,
    Jobs,
    Output,
    Quiet,
    RecordsFolder,
    Resume,
    Scheduler,
)
from verification.commands.common.task_progress import (
    executor_at,
    kept_results,
    run_info,
    solve,
    worker_count,
)
from verification.commands.common.terminal import (
    STYLE,
    named_table,
    one_line,
    print_json,
    print_out,
    with_exit_code,
)
from verification.commands.common.terminal_bar import require_gmsh
from verification.evidence.alarm_record import (
    DECADES,
    KINDS,
    Alarm,
    AlarmRecord,
    Campaign,
    Ratios,
    read_record,
    write_record,
    wrong_first,
)
from verification.evidence.judged_source import source_hash
from verification.judging.verdict import Outcome, compare
from verification.regression.junit_xml import junit_xml
from verification.regression.run_exit_codes import exit_code
from verification.running.case_result import CaseResult, RunInfo
from verification.running.case_tasks import case_task
from verification.running.checked_files import locked, write_atomically
from verification.running.json_records import plain
from verification.sources.source_registry import EXACT, METHODS

MOST_SHOWN = 12
LEAST = 1e-9  # of the largest reference value of a profile: smaller errors are rounding


@with_exit_code
def alarms(
    *,
    count: int = 24,
    seed: int = 1,
    films: Flag = False,
    ellipses: Flag = False,
    output: Output = Path("reports/alarms"),
    record: Flag = False,
    records: RecordsFolder = RECORDS,
    jobs: Jobs = None,
    time_limit: float = 600.0,
    scheduler: Scheduler = None,
    resume: Resume = False,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> int:
    """Solve clean random problems; count the verdicts that are not AGREES, each a false alarm.

    One to five coatings, E1/E2 from 0.02 to 50, h/a_h from 0.02 to 10, Poisson ratios to 0.49, friction to
    0.8, every other with an elastic ball; the same seed draws the same problems everywhere. Each is left as
    a case file under OUTPUT/problems, all of them in a report.

    Args:
        count: Number of problems.
        seed: Seed of the random numbers.
        films: A film of h/a_h from 0.001 to 0.02, alone or below one up to 0.2; E1/E2 from 0.1 to 10.
        ellipses: Ellipses 1.5 to 4 : 1 on a coating of E1/E2 from 0.25 to 4, half with an elastic body.
        output: Directory of the report, of the results, of the case files.
        record: Add kind and seed to RECORDS/alarms.json, for the credibility page of every report; what was
            measured on other code is dropped from it.
        time_limit: Seconds one problem may take before it is stopped and counted as alarms.
    """
    jobs = worker_count(jobs, time_limit=time_limit)
    if count < 1 or seed < 0:
        raise CommandError(f"--count = {count}, --seed = {seed}; only the seed may be zero, none negative")
    if films and ellipses:
        raise CommandError("--films with --ellipses; the problems are of one kind, leave one out")
    option, kind = (
        ("--films", KINDS[1]) if films else ("--ellipses", KINDS[2]) if ellipses else ("", KINDS[0])
    )
    if record:
        require_checkout(records, "--records")
    require_gmsh()

    from verification.report.report_material import ReportMaterial
    from verification.report.report_page import write_report

    started = datetime.datetime.now(datetime.UTC)
    output = output.absolute() if scheduler else output  # workers have folders of their own
    with executor_at(scheduler) as executor, locked(output):
        chosen = draw_ellipse if ellipses else partial(draw, films=films)
        cases = [_case(chosen(seed, number), output) for number in range(count)]
        kept = kept_results(cases, output) if resume else {}
        tasks = [case_task(case, output) for case in cases if case.name not in kept]
        solved = {r.name: r for r in solve(tasks, jobs, time_limit, quiet or as_json, executor=executor)}
        results = [kept.get(case.name) or solved[case.name] for case in cases]
        of = f"--count {count} --seed {seed} {option}".rstrip()
        info = run_info(f"tests/tools alarms {of}", started, jobs, scheduler)
        page = write_report(ReportMaterial(results, info), output, junit_xml(results, info))
        found = counted(results, kind, seed, info)
        known = read_record(records) if record else None
        stored = write_record(records, with_campaign(known, found)) if record else None
    if as_json:
        print_json(plain(asdict(found)))
    elif not quiet:
        _print(found, page, stored)
    return exit_code(results)


def _case(drawn: Draw, output: Path) -> Case:
    path = output / "problems" / f"{drawn.name}.toml"
    write_atomically(path, drawn.text)
    return parse_case(drawn.text.encode(), path)


def _print(found: Campaign, page: Path, stored: Path | None) -> None:
    if found.alarms:
        table = named_table("problem", "quantity", "line", "between", "verdict")
        for alarm in wrong_first(found.alarms)[:MOST_SHOWN]:
            verdict = f"[{STYLE[alarm.outcome]}]{alarm.outcome}[/] {escape(one_line(alarm.reason))}"
            table.add_row(alarm.case, alarm.quantity, alarm.line, ", ".join(alarm.between), verdict)
        print_out(table)
        if (more := len(found.alarms) - MOST_SHOWN) > 0:
            print_out(f"... with {more} more in the report")
    print_out(
        f"{len(found.wrong)} of {found.problems} clean problems of seed {found.seed} raised a false alarm, "
        f"{len(found.vague)} are inconclusive (U above its cap), {found.agreeing} agree throughout, in "
        f"{found.comparisons} comparisons and {found.invariants} invariants; largest difference "
        f"{found.largest:.2f} U",
        escape(f"{found.seconds:.0f} s; report: {page}"),
        *([escape(f"recorded: {stored}")] if stored is not None else []),
    )


def counted(results: Sequence[CaseResult], kind: str, seed: int, info: RunInfo) -> Campaign:
    """The alarms in ``results``; a case without any comparison is one."""
    verdicts = [(r, claim, verdict) for r in results for claim, verdict in r.verdicts]
    invariants = [(r, invariant) for r in results for invariant in r.invariants]
    nothing = ("", "", (), Outcome.NO_RESULT, "nothing was compared")
    found: list[tuple[CaseResult, tuple[str, str, tuple[str, ...], Outcome, str]]] = [
        *((r, (c.quantity, c.line, c.between, v.outcome, v.reason)) for r, c, v in verdicts),
        *((r, (i.name, "", (i.source,), i.outcome, i.message)) for r, i in invariants),
        *((r, nothing) for r in results if not r.verdicts),
    ]
    alarms = [Alarm(r.name, r.title, *row) for r, row in found if row[3] is not Outcome.AGREES]
    made = Campaign(
        kind,
        seed,
        len(results),
        sum(result.outcome is Outcome.AGREES for result in results),
        len(verdicts),
        len(invariants),
        tuple(alarms),
        max((_largest(result) for result in results), default=0.0),
        info.started,
        info.seconds,
        info.commit,
        info.machine,
        dict(info.versions),
        tuple(_ratios(results, source) for source in METHODS),
    )
    return replace(made, source=source_hash(made.judged))


def with_campaign(record: AlarmRecord | None, new: Campaign) -> AlarmRecord:
    """``record`` with ``new`` in place of one of its kind and seed; those on other code are left out."""
    kept = [one for one in record.campaigns if one.source == source_hash(one.judged)] if record else []
    kept = [one for one in kept if (one.kind, one.seed) != (new.kind, new.seed)]
    return AlarmRecord(tuple(sorted((*kept, new), key=lambda one: (KINDS.index(one.kind), one.seed))))


def _largest(result: CaseResult) -> float:
    """Largest difference over the sum of both uncertainties in the comparisons of ``result``."""
    profiles, largest = {(p.quantity, p.line, p.source): p for p in result.profiles}, 0.0
    for claim, verdict in result.verdicts:
        if verdict.judged is None:
            continue
        a, b = (profiles[claim.quantity, claim.line, source] for source in claim.between)
        edge = float(profiles["contact_radius", "contact", b.source].value[0]) if claim.edge else 0.0
        excluded = np.abs(np.abs(a.position) - edge) < claim.edge * edge
        compared = compare(a, b, scale=verdict.judged.scale, excluded=excluded)
        if compared.uncertainty is not None:
            difference = np.abs(compared.difference)
            counted = compared.judged & (difference > LEAST)
            U = np.maximum(compared.uncertainty, np.finfo(float).tiny)
            largest = max(largest, float((difference / U)[counted].max(initial=0.0)))
    return largest


def _ratios(results: Sequence[CaseResult], source: str) -> Ratios:
    found = []
    for result in results:
        profiles = {(p.quantity, p.line, p.source): p for p in result.profiles}
        for (quantity, line, name), mine in profiles.items():
            exact = profiles.get((quantity, line, EXACT[0]))
            if name != source or exact is None or mine.uncertainty is None or exact.uncertainty is None:
                continue
            error = np.abs(mine.value - exact.value)
            counted = error > LEAST * np.abs(exact.value).max(initial=0.0)
            U = (mine.uncertainty + exact.uncertainty)[counted]
            found.append(error[counted] / np.maximum(U, np.finfo(float).tiny))
    ratio = np.concatenate(found) if found else np.zeros(0)
    place = np.clip(np.log10(np.maximum(ratio, 1e-99)), DECADES[0], DECADES[-1])
    counts, _ = np.histogram(place, DECADES)
    within, median = (float(np.mean(ratio <= 1)), float(1 / np.median(ratio))) if ratio.size else (1.0, 0.0)
    return Ratios(
        source, int(ratio.size), within, median, tuple(counts.tolist()), float(ratio.max(initial=0.0))
    )
