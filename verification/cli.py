"""The command line of coatcheck.

Exit codes: 0 all agree, 1 a disagreement, 2 bad input, 3 a missing result, 4 inconclusive.
"""

import datetime
import json
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, TypeVar

from cyclopts import App, CycloptsError, Parameter
from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.table import Table

from verification.case import Case, CaseError, read_case, shipped_cases
from verification.printed import PublishedCase, is_published, published_cases, read_published
from verification.result import CaseResult, RunInfo, from_json
from verification.schedule import Task, case_task, cores, published_task, result_path, run_tasks
from verification.store import StoreError, locked, read_checked
from verification.surroundings import commit, machine, missing_libraries, versions
from verification.verdict import Outcome

__all__ = ["app", "exit_code", "main"]

T = TypeVar("T")
BAD_INPUT = 2
EXIT = {Outcome.DISAGREES: 1, Outcome.NO_RESULT: 3, Outcome.INCONCLUSIVE: 4, Outcome.AGREES: 0}
STYLE = {
    Outcome.AGREES: "green",
    Outcome.DISAGREES: "bold red",
    Outcome.NO_RESULT: "bold red",
    Outcome.INCONCLUSIVE: "yellow",
}

app = App(
    name="coatcheck",
    help="Verify coated point contact: two independent methods, Hertz and an exact reference in one report.",
    help_epilogue="Exit codes: 0 all agree, 1 disagreement, 2 bad input, 3 no result, 4 inconclusive.",
    version=lambda: version("coatcheck"),
    help_format="plaintext",
)


def exit_code(results: Sequence[CaseResult]) -> int:
    """The code of the worst outcome: disagreement before a missing result before inconclusive."""
    found = {result.outcome for result in results}
    for outcome in (Outcome.DISAGREES, Outcome.NO_RESULT, Outcome.INCONCLUSIVE):
        if outcome in found:
            return EXIT[outcome]
    return EXIT[Outcome.AGREES] if found else EXIT[Outcome.NO_RESULT]


@app.command
def run(
    *cases: str,
    output: Annotated[Path, Parameter(name=["--output", "-o"])] = Path("reports"),
    jobs: Annotated[int | None, Parameter(name=["--jobs", "-j"])] = None,
    time_limit: float = 600.0,
    resume: Annotated[bool, Parameter(negative="")] = False,
    quiet: Annotated[bool, Parameter(name=["--quiet", "-q"], negative="")] = False,
    as_json: Annotated[bool, Parameter(name="--json", negative="")] = False,
) -> int:
    """Solve cases by every method and reference, judge every claim, write the report.

    Without arguments all shipped cases are run, and the convergence of both methods is measured. Examples:

        coatcheck run
        coatcheck run 05_ratio_4 my_coating.toml --output reports/mine
        coatcheck run published

    Parameters
    ----------
    cases
        Names of shipped cases (see coatcheck list) or paths of .toml case files; "published" stands for all
        results that others printed.
    output
        Directory of the report: report.html, report.json, junit.xml and one file per case.
    jobs
        Cases solved side by side; all cores unless given. Each gets its share of the threads.
    time_limit
        Seconds one case may take before it is stopped and reported as having no result.
    resume
        Keep the whole results already in the output directory that belong to the same case files.
    quiet
        Print nothing but complaints.
    as_json
        Print one JSON object with the outcome of each case instead of a table.
    """
    jobs = cores() if jobs is None else jobs
    if jobs < 1 or not time_limit > 0:
        return _complain(f"--jobs = {jobs}, --time-limit = {time_limit:g}; both must be positive")
    try:
        chosen = _choose(cases)
    except CaseError as error:
        return _complain(str(error))
    lacking = missing_libraries()
    if lacking:
        _complain(f"gmsh lacks system libraries here; install them with: apt-get install {' '.join(lacking)}")
        return EXIT[Outcome.NO_RESULT]

    from verification import accuracy_study  # SciPy and matplotlib take a second to load
    from verification.accuracy_study import AccuracyStudy
    from verification.report import write_report

    begin, started = time.perf_counter(), datetime.datetime.now(datetime.UTC)
    try:
        with locked(output):
            kept = {c.name: r for c in chosen if resume and (r := _stored(output, c)) is not None}
            study = accuracy_study.stored(output) if resume and not cases else None
            tasks: list[Task[CaseResult | AccuracyStudy]] = []
            if not cases and study is None:
                tasks.append(accuracy_study.task(output))
            tasks += [_task(c, output) for c in chosen if c.name not in kept]
            solved = _solve(tasks, jobs, time_limit, quiet or as_json)
            results = {r.name: r for r in solved if isinstance(r, CaseResult)}
            study = next((r for r in solved if isinstance(r, AccuracyStudy)), study)
            ordered = [kept.get(case.name) or results[case.name] for case in chosen]
            info = RunInfo(
                command=" ".join(["coatcheck run", *cases]),
                started=started.isoformat(timespec="seconds"),
                seconds=time.perf_counter() - begin,
                jobs=jobs,
                commit=commit(),
                machine=f"{machine()}, {cores()} cores",
                versions=versions(),
            )
            page = write_report(ordered, output, info, study)
    except StoreError as error:
        return _complain(str(error))
    if as_json:
        sys.stdout.write(json.dumps(_summary(ordered, page), indent=2) + "\n")
    elif not quiet:
        _print_table(ordered, page, time.perf_counter() - begin)
    return exit_code(ordered)


@app.command(name="list")
def list_cases(*, as_json: Annotated[bool, Parameter(name="--json", negative="")] = False) -> int:
    """List the shipped cases with title and source, then the published results with their year.

    Parameters
    ----------
    as_json
        Print a JSON array instead of tables.
    """
    cases = [read_case(path) for path in shipped_cases().values()]
    published = [read_published(path) for path in published_cases().values()]
    if as_json:
        rows = [_listed(case) for case in cases]
        rows += [
            _listed(p) | {"year": p.citation["year"], "primary_read": p.citation["primary_read"]}
            for p in published
        ]
        sys.stdout.write(json.dumps(rows, indent=2) + "\n")
        return 0
    table = Table("case", "title", "claims", "source", box=None, header_style="bold")
    for case in cases:
        table.add_row(case.name, case.title, str(len(case.claims)), case.source)
    printed = Table("published", "title", "values", "year", "source", box=None, header_style="bold")
    for result in published:
        values = sum(int(item.counted.sum()) for item in result.printed)
        printed.add_row(result.name, result.title, str(values), str(result.citation["year"]), result.source)
    Console().print(table)
    Console().print()
    Console().print(printed)
    return 0


def _listed(case: Case | PublishedCase) -> dict[str, object]:
    return {"name": case.name, "title": case.title, "source": case.source, "claims": len(case.claims)}


@app.command
def bench(
    *,
    sizes: Annotated[
        tuple[int, ...], Parameter(name=["--sizes", "-N"], consume_multiple=True, negative="")
    ] = (
        128,
        256,
        512,
    ),
    threads: Annotated[tuple[int, ...], Parameter(consume_multiple=True, negative="")] = (1, 2),
    repeats: int = 5,
    coated: Annotated[bool, Parameter(negative="")] = False,
    as_json: Annotated[bool, Parameter(name="--json", negative="")] = False,
) -> int:
    """Time the semi-analytical contact beside tamaas (extra "bench"), both held to one judge; ratios first.

    The full set takes half an hour: coatcheck bench --sizes 128 256 512 1024 2048 --coated

    Parameters
    ----------
    sizes
        Patches along a side of the square [-2a, 2a]^2.
    threads
        Numbers of threads to measure with.
    repeats
        Measurements of each; the median counts.
    coated
        Also count the iterations of coated solids on 512 x 512 patches.
    as_json
        Print everything measured as JSON.
    """
    if min(sizes) < 16 or max(sizes) > 4096 or min(threads) < 1 or repeats < 1:
        return _complain("--sizes from 16 to 4096, --threads and --repeats from 1")
    from verification.bench import ratios, run_bench, run_coated

    console = Console(stderr=True)
    rows = run_bench(sizes=sizes, threads=threads, repeats=repeats, progress=lambda line: console.print(line))
    found = ratios(rows)
    layered = run_coated() if coated else []
    if as_json:
        content = {
            "rows": [asdict(r) for r in rows],
            "ratios": dict(found),
            "coated": [asdict(r) for r in layered],
        }
        sys.stdout.write(json.dumps(content, indent=2) + "\n")
        return 0
    figures = Table("figure", "value", box=None, header_style="bold")
    for name, value in found:
        figures.add_row(name, f"{value:.4g}")
    measured = Table("solver", "N", "threads", "s, median", "gap", "penetration", "load", "judge", box=None)
    for r in rows:
        judge = (f"{r.gap:.1e}", f"{r.penetration:.1e}", f"{r.load:.1e}", "meets" if r.passes else "FAILS")
        measured.add_row(r.solver, str(r.patches), str(r.threads), f"{r.seconds:.3f}", *judge)
    Console().print(figures, "", measured)
    if layered:
        table = Table("E1/E2", "h/a", "iterations", "convolutions", "s", "of it coefficients", box=None)
        for c in layered:
            counts = (str(c.iterations), str(c.convolutions), f"{c.seconds:.3f}", f"{c.setup_seconds:.3f}")
            table.add_row(f"{c.modulus_ratio:g}", f"{c.thickness:g}", *counts)
        Console().print("", table)
    return 0 if all(row.passes for row in rows) else EXIT[Outcome.DISAGREES]


def main() -> None:
    """Entry of the ``coatcheck`` command."""
    try:
        code = app(exit_on_error=False, print_error=False, result_action="return_value")
    except CycloptsError as error:
        code = _complain(" ".join(str(error).split()) + " Try: coatcheck --help")
    except KeyboardInterrupt:
        sys.stderr.write("\ncoatcheck: stopped; finished cases are kept, go on with --resume\n")
        code = 130
    sys.exit(code)


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
        elif name.endswith(".toml") or "/" in name or Path(name).exists():
            path = Path(name)
            cases.append(read_published(path) if is_published(path) else read_case(path))
        else:
            raise CaseError(f"{name}: neither a shipped case (see coatcheck list) nor a .toml file")
    twice = {case.name for case in cases if sum(other.name == case.name for other in cases) > 1}
    if twice:
        raise CaseError(f"{sorted(twice)[0]}: named twice; give each case file a name of its own")
    return cases


def _task(case: Case | PublishedCase, output: Path) -> Task[CaseResult]:
    return case_task(case, output) if isinstance(case, Case) else published_task(case, output)


def _stored(output: Path, case: Case | PublishedCase) -> CaseResult | None:
    """A whole earlier result of the very same case file, or None."""
    try:
        result = from_json(read_checked(result_path(output, case)))
    except (StoreError, ValueError, KeyError, TypeError):
        return None
    return result if result.text == case.text else None


def _solve(tasks: Sequence[Task[T]], jobs: int, time_limit: float, silent: bool) -> list[T]:
    console = Console(stderr=True)
    bar = Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=console,
        transient=True,
        disable=silent or not console.is_terminal,
    )
    at_work: list[str] = []
    with bar:
        task = bar.add_task("solving", total=len(tasks))

        def started(name: str) -> None:
            at_work.append(name)
            bar.update(task, description=", ".join(at_work))

        def finished(name: str, result: T) -> None:
            at_work.remove(name)
            bar.update(task, advance=1, description=", ".join(at_work) or "report")
            if not silent and isinstance(result, CaseResult):
                colour = STYLE[result.outcome]
                console.print(
                    f"[{colour}]{result.outcome:<12}[/] {result.name}  {result.seconds:.1f} s",
                    highlight=False,
                )

        return run_tasks(tasks, jobs=jobs, time_limit=time_limit, started=started, finished=finished)


def _summary(results: Sequence[CaseResult], page: Path) -> dict[str, object]:
    return {
        "report": str(page),
        "exit_code": exit_code(results),
        "cases": {
            result.name: {
                "outcome": result.outcome,
                "verdicts": {o: sum(v.outcome is o for _, v in result.verdicts) for o in Outcome},
            }
            for result in results
        },
    }


def _print_table(results: Sequence[CaseResult], page: Path, seconds: float) -> None:
    table = Table(
        "case", *(outcome.lower() for outcome in Outcome), "largest difference", box=None, header_style="bold"
    )
    for result in results:
        worst = max((v.difference for _, v in result.verdicts if v.difference is not None), default=None)
        table.add_row(
            result.name,
            *(
                f"[{STYLE[o]}]{n}[/]" if (n := sum(v.outcome is o for _, v in result.verdicts)) else "."
                for o in Outcome
            ),
            "-" if worst is None else f"{worst:.1e}",
        )
    console = Console()
    console.print(table)
    for result in results:
        for source in result.sources:
            if source.failure:
                console.print(
                    f"[bold red]{result.name}, {source.source}:[/] {source.failure}", highlight=False
                )
    console.print(f"{len(results)} cases in {seconds:.0f} s; report: {page}", highlight=False)


def _complain(sentence: str) -> int:
    sys.stderr.write(f"coatcheck: {sentence}\n")
    return BAD_INPUT


if __name__ == "__main__":
    main()
