"""coatcheck run: solve cases, judge every claim, write the report."""

import datetime
import os
import shlex
import time
import unicodedata
from collections import Counter
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console
from rich.markup import escape
from rich.table import Column, Table

from verification.cases.contact import Case, read_case, shipped_cases
from verification.cases.published import PublishedCase, is_published, published_cases, read_published
from verification.cases.toml import CaseError
from verification.commands.common.exits import DRIFTED, EXIT, STOPPED, exit_code, with_exit_code
from verification.commands.common.folders import BASELINE, RECORDS, within_package
from verification.commands.common.options import (
    AsJson,
    BaselineFolder,
    Flag,
    Jobs,
    Output,
    Quiet,
    RecordsFolder,
    Resume,
)
from verification.commands.common.terminal import STYLE, did_you_mean, one_line, print_error, print_json
from verification.commands.solving import (
    kept_results,
    kept_study,
    require_gmsh,
    run_info,
    solve,
    worker_count,
)
from verification.judging.verdict import Outcome
from verification.regression.baseline import Regression, State, regression, regression_json
from verification.regression.record import read_baseline
from verification.running.pool import Task
from verification.running.result import CaseResult
from verification.running.self_tests import SelfTest, self_tests
from verification.running.store import StoreError, locked
from verification.running.tasks import case_task, kept_result, published_task

NARROW = 80  # columns


@with_exit_code
def run(
    *cases: str,
    output: Output = Path("reports"),
    jobs: Jobs = None,
    time_limit: float = 600.0,
    baseline: BaselineFolder = BASELINE,
    records: RecordsFolder = RECORDS,
    resume: Resume = False,
    fields: Flag = False,
    verbose: Annotated[bool, Parameter(name=["--verbose", "-v"], negative="")] = False,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> int:
    """Solve cases by every method and reference, judge every claim, write the report.

    Without arguments all shipped cases are run, and the convergence of both methods is measured. The exit
    code is 5 only where a number differs from the baseline on its machine with its versions; elsewhere the
    report shows it.

    Parameters
    ----------
    cases
        Names of shipped cases, see coatcheck list; paths of .toml files; "published" for all printed results.
    output
        Directory of the report: report.html, report.json, junit.xml and one file per case.
    time_limit
        Seconds one case may take before it is stopped and reported as having no result.
    fields
        Also write the fields of each case, for ParaView and coatcheck view, into the folder fields there.
    verbose
        Say the seconds and iterations of every source as the cases finish.
    """
    jobs = worker_count(jobs, time_limit)
    chosen = _choose(cases)
    require_gmsh()

    from verification.credibility import accuracy as accuracy_study
    from verification.credibility.accuracy import AccuracyStudy
    from verification.report.material import Material, gather
    from verification.report.write import write_report
    from verification.running.fields import read_planes
    from verification.study import formulas as effective_study
    from verification.study.formulas import EffectiveStudy

    tests = self_tests()
    for test in tests:
        if not test.passed:
            print_error(f"self-test of the {test.name}: {test.found}; the verdicts of this run mean nothing")
    begin, started = time.perf_counter(), datetime.datetime.now(datetime.UTC)
    try:
        known = read_baseline(baseline)
        with locked(output):
            kept = kept_results(chosen, output, fields=fields) if resume else {}
            study = kept_study(output) if resume and not cases else None
            tasks: list[Task[CaseResult | AccuracyStudy | EffectiveStudy]] = []
            if not cases and study is None:
                tasks.append(accuracy_study.task(output))
            if "published" in cases:
                tasks.append(effective_study.task(output))
            tasks += [_task(c, output, fields) for c in chosen if c.name not in kept]
            solved = solve(tasks, jobs, time_limit, quiet or as_json, verbose=verbose)
            results = {r.name: r for r in solved if isinstance(r, CaseResult)}
            study = next((r for r in solved if isinstance(r, AccuracyStudy)), study)
            formulas = next((r for r in solved if isinstance(r, EffectiveStudy)), None)
            ordered = [kept.get(case.name) or results[case.name] for case in chosen]
            info = run_info(shlex.join(["coatcheck", "run", *cases]), started, jobs)
            beside = regression(ordered, known, within_package(baseline), info, whole=not cases)
            evidence = replace(
                gather(records), accuracy=study, baseline=beside, self_tests=tests, formulas=formulas
            )
            page = write_report(Material(ordered, info, evidence, read_planes(output, ordered)), output)
    except KeyboardInterrupt:
        return _stopped(chosen, output)
    if as_json:
        print_json(_summary(ordered, page, beside, tests))
    elif not quiet:
        _print_table(ordered, page, time.perf_counter() - begin, beside)
    return _code(ordered, beside, tests)


def _code(results: Sequence[CaseResult], beside: Regression, tests: Sequence[SelfTest]) -> int:
    """The worst verdict decides, no better than the harness it comes from; where all agree, the baseline."""
    code = exit_code(results)
    if not all(test.passed for test in tests):
        return code or EXIT[Outcome.DISAGREES]
    return DRIFTED if code == EXIT[Outcome.AGREES] and beside.unexplained else code


def _choose(names: Sequence[str]) -> list[Case | PublishedCase]:
    shipped, published = shipped_cases(), published_cases()
    cases: list[Case | PublishedCase] = []
    for name in names or shipped:
        if name in shipped:
            cases.append(read_case(shipped[name]))
        elif name in published:
            cases.append(read_published(published[name]))
        elif name == "published":
            cases += [read_published(path) for path in published.values()]
        elif name.endswith(".toml") or "/" in name or os.path.lexists(name):
            path = Path(name)
            cases.append(read_published(path) if is_published(path) else read_case(path))
        else:
            near = did_you_mean(name, [*shipped, *published, "published"])
            raise CaseError(f"{name}: neither a shipped case (see coatcheck list) nor a .toml file{near}")
    # Names that a file system may take for one and the same.
    plain = Counter(unicodedata.normalize("NFC", case.name).casefold() for case in cases)
    twice = {c.name for c in cases if plain[unicodedata.normalize("NFC", c.name).casefold()] > 1}
    if twice:
        raise CaseError(f"{sorted(twice)[0]}: named twice; give each case file a name of its own")
    return cases


def _task(case: Case | PublishedCase, output: Path, fields: bool) -> Task[CaseResult]:
    if isinstance(case, Case):
        return case_task(case, output, fields=fields)
    return published_task(case, output)


def _stopped(chosen: Sequence[Case | PublishedCase], output: Path) -> int:
    """Say what a run that was interrupted leaves; 130, as shells have it."""
    finished = 0
    for case in chosen:
        with suppress(StoreError):
            finished += kept_result(output, case) is not None
    print_error(
        f"stopped; {finished} of {len(chosen)} cases are finished and kept in {output}: go on with --resume, "
        f"or see what is there with coatcheck report {output}"
    )
    return STOPPED


def _summary(
    results: Sequence[CaseResult], page: Path, beside: Regression, tests: Sequence[SelfTest]
) -> dict[str, object]:
    states = {case.name: case.state for case in beside.cases}
    return {
        "report": str(page),
        "exit_code": _code(results, beside, tests),
        "self_tests": {test.name: test.passed for test in tests},
        "baseline": regression_json(beside),
        "cases": {
            result.name: {
                "outcome": result.outcome,
                "baseline": states.get(result.name),
                "verdicts": {o: sum(v.outcome is o for _, v in result.verdicts) for o in Outcome},
                "invariants": {o: sum(law.outcome is o for law in result.invariants) for o in Outcome},
            }
            for result in results
        },
    }


def _print_table(results: Sequence[CaseResult], page: Path, seconds: float, beside: Regression) -> None:
    console = Console()
    # Broken by hand to stand in 80 columns beside the longest name of a shipped case; letters in fewer.
    heads = ["agrees", "dis-\nagrees", "incon-\nclusive", "no\nresult", "largest\ndifference"]
    narrow = console.width < NARROW
    if narrow:
        heads = ["A", "D", "I", "N", "largest"]
    # What stands below the table says it for all cases.
    states = beside.update is not None and not narrow
    heads += ["baseline"] if states else []
    table = Table(Column("case", overflow="fold"), box=None, header_style="bold", pad_edge=False)
    for head in heads:
        table.add_column(head, no_wrap=True, vertical="bottom")
    for result in results:
        worst = max((v.difference for _, v in result.verdicts if v.difference is not None), default=None)
        table.add_row(
            escape(result.name),
            *(
                f"[{STYLE[o]}]{n}[/]" if (n := sum(v.outcome is o for _, v in result.verdicts)) else "."
                for o in Outcome
            ),
            "-" if worst is None else f"{worst:.1e}",
            *([_state(beside, result.name)] if states else []),
        )
    console.print(table)
    # What is read by another program stays one line a sentence.
    say = partial(console.print, highlight=False, soft_wrap=not console.is_terminal)
    for result in results:
        for source in result.sources:
            if source.failure:
                say(
                    f"[bold red]{escape(result.name)}, {source.source}:[/] {escape(one_line(source.failure))}"
                )
        for law in result.invariants:
            if law.outcome is not Outcome.AGREES:
                say(
                    f"[{STYLE[law.outcome]}]{escape(result.name)}, {law.source}, {escape(law.name)}:[/] "
                    f"{escape(one_line(law.message))}"
                )
    laws = [law for result in results for law in result.invariants]
    if laws:
        say(f"{sum(law.outcome is Outcome.AGREES for law in laws)} of {len(laws)} invariants hold")
    from verification.report.sections.baseline import baseline_message

    known = f"baseline of {beside.update.when[:10]} in {beside.folder}: " if beside.update is not None else ""
    say(escape(f"{known}{baseline_message(beside)}"))
    number = "1 case" if len(results) == 1 else f"{len(results)} cases"
    say(f"{number} in {seconds:.0f} s; report: {escape(str(page))}")


def _state(beside: Regression, name: str) -> str:
    found = beside.of(name)
    if found is None:
        return "-"
    return f"[{'green' if found.state is State.SAME else 'yellow'}]{found.state}[/]"
