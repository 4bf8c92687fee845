"""coatcheck run: solve cases, judge every claim, write the report."""

import datetime
import shlex
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter
from rich.markup import escape

from verification.cases.case_file import Case
from verification.cases.published_file import PublishedCase
from verification.commands.common.command_error import STOPPED
from verification.commands.common.known_folders import BASELINE, RECORDS, within_package
from verification.commands.common.named_files import chosen_cases
from verification.commands.common.run_summary import print_run, run_json
from verification.commands.common.shared_options import (
    AsJson,
    BaselineFolder,
    Flag,
    Jobs,
    Output,
    Quiet,
    RecordsFolder,
    Resume,
    Scheduler,
    Strict,
)
from verification.commands.common.task_progress import (
    executor_at,
    kept_results,
    run_info,
    solve,
    worker_count,
)
from verification.commands.common.terminal import (
    print_error,
    print_json,
    print_out,
    print_warnings,
    with_exit_code,
)
from verification.commands.common.terminal_bar import require_gmsh
from verification.credibility import accuracy_study
from verification.credibility.accuracy_study import AccuracyStudy
from verification.credibility.self_tests import self_tests
from verification.desk.layer_limits import Designed, designed
from verification.regression.baseline_change import regression, regression_json
from verification.regression.baseline_file import read_baseline
from verification.regression.junit_xml import junit_xml
from verification.regression.run_exit_codes import run_code
from verification.running.case_result import CaseResult, message_of
from verification.running.case_tasks import case_task, kept_result
from verification.running.checked_files import StoreError, locked
from verification.running.json_records import encode
from verification.running.pool.pool_task import Task
from verification.running.stored_fields import read_planes
from verification.sources.source_registry import METHODS

if TYPE_CHECKING:
    from verification.report.report_material import Evidence


@with_exit_code
def run(
    *cases: str,
    output: Output = Path("reports"),
    jobs: Jobs = None,
    time_limit: float = 600.0,
    baseline: BaselineFolder = BASELINE,
    records: RecordsFolder = RECORDS,
    scheduler: Scheduler = None,
    resume: Resume = False,
    fields: Flag = False,
    strict: Strict = False,
    verbose: Annotated[bool, Parameter(name=["--verbose", "-v"], negative="")] = False,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> int:
    """Solve cases by every method and reference, judge every claim, write the report.

    Without arguments all shipped cases are run, and the convergence of both methods is measured. The exit
    code is 5 where a number differs from the baseline on its machine with its versions, and on any machine
    where it differs by more than its uncertainty or an uncertainty is more than four times that of the
    baseline; it is 6 where less is judged than the manifest of the baseline records.

    Args:
        cases: Names of shipped cases, see coatcheck list; .toml files; "published" for all published results.
        output: Directory of the report: report.html, report.json, junit.xml and one file per case.
        time_limit: Seconds one case may take before it is stopped and reported as having no result.
        fields: Also write the fields of each case, for ParaView, into its folder fields.
        verbose: Print the seconds and iterations of every source as the cases finish.
    """
    jobs, silent = worker_count(jobs, time_limit=time_limit), quiet or as_json
    output = output.absolute() if scheduler else output  # workers have folders of their own
    chosen = chosen_cases(cases)
    for case in chosen:
        if isinstance(case, Case):
            print_warnings(case.warnings, case.name, strict=strict, silent=silent)
    require_gmsh()

    begin, started = time.perf_counter(), datetime.datetime.now(datetime.UTC)
    try:
        known = read_baseline(baseline)
        with executor_at(scheduler) as executor, locked(output):
            kept = kept_results(chosen, output, fields=fields) if resume else {}
            accuracy = _kept_study(output) if resume and not cases else None
            tasks: list[Task[CaseResult | AccuracyStudy]] = [
                case_task(case, output, fields=fields) for case in chosen if case.name not in kept
            ]
            tasks += [accuracy_study.task(output)] if not cases and accuracy is None else []
            standing = cache(partial(_standing, chosen, records))
            solved = solve(
                tasks, jobs, time_limit, silent, executor=executor, verbose=verbose, meanwhile=standing
            )
            found = kept | {one.name: one for one in solved if isinstance(one, CaseResult)}
            results = [found[case.name] for case in chosen]
            info = run_info(shlex.join(["coatcheck", "run", *cases]), started, jobs, scheduler)
            evidence = standing()
            tests = evidence.self_tests
            beside = regression(
                results,
                known,
                within_package(baseline),
                info,
                whole=not cases,
                published="published" in cases,
                self_tests={test.name: test.answers for test in tests},
            )
            messages = {test.name: "" if test.passed else test.found for test in tests}
            junit = junit_xml(results, info, beside, messages)
            accuracy = next((one for one in solved if isinstance(one, AccuracyStudy)), accuracy)
            studies = accuracy.verdicts if accuracy else ()
            code = run_code(
                results,
                beside,
                passed=all(test.passed for test in tests),
                studies=[study.outcome for study in studies],
            )
            from verification.report.report_material import ReportMaterial
            from verification.report.report_page import write_report

            evidence = replace(evidence, accuracy=accuracy, baseline=beside)
            material = ReportMaterial(results, info, evidence, read_planes(output, results))
            page = write_report(material, output, junit)
    except KeyboardInterrupt:
        return _stopped(chosen, output)
    if as_json:
        passed = {test.name: test.passed for test in tests}
        content = run_json(results, page, regression_json(beside), passed, evidence.beyond, code, studies)
        print_json(content | {"designed": {name: encode(one) for name, one in evidence.designed.items()}})
    elif not quiet:
        print_run(results, page, time.perf_counter() - begin, beside, studies)
        for name, found_with in evidence.designed.items():
            print_out(escape(f"{name}, with what it states of its layers: {found_with.summary}"))
    for name, lines in evidence.beyond.items():
        print_warnings(lines, name, strict=False, silent=silent)
    told = {case.name: case.warnings for case in chosen if isinstance(case, Case)}
    for result in results:
        late = [line for line in result.warnings if line not in told.get(result.name, ())]
        stated = evidence.designed.get(result.name)
        late += stated.warnings if stated is not None else ()
        print_warnings(late, result.name, strict=strict, silent=silent)
    return code


def _kept_study(output: Path) -> AccuracyStudy | None:
    """The earlier accuracy study where it can be kept; prints why it cannot."""
    try:
        return accuracy_study.stored(output)
    except StoreError as error:
        print_error(f"{error}; measured again")
        return None


def _standing(chosen: Sequence[Case | PublishedCase], records: Path) -> "Evidence":
    """Evidence that no result changes, self-tests among it; a message for each of these that fails."""
    from verification.report.report_material import Modelled, gather

    tests = self_tests()
    for test in tests:
        if not test.passed:
            print_error(f"self-test of the {test.name}: {test.found}; the verdicts of this run are not valid")
    contacts = [case for case in chosen if isinstance(case, Case)]
    found = gather(records, {case.name: Modelled.of(case) for case in contacts}, tests)
    known = {case.name: _designed(case) for case in contacts}
    return replace(found, designed={name: one for name, one in known.items() if one is not None})


def _designed(case: Case) -> Designed | None:
    try:
        return designed(case, METHODS[0])
    except Exception as error:  # a failed solve is a row of the report besides
        return Designed(f"No largest stresses with what the case states: {message_of(error)}")


def _stopped(chosen: Sequence[Case | PublishedCase], output: Path) -> int:
    """Print what an interrupted run leaves. Returns the exit code of SIGINT."""
    finished = 0
    for case in chosen:
        with suppress(StoreError):
            finished += kept_result(output, case) is not None
    print_error(
        f"stopped; {finished} of {len(chosen)} cases are finished and kept in {output}: go on with --resume, "
        f"or see what is there with coatcheck report {output}"
    )
    return STOPPED
