"""coatcheck study: parameter studies on Dask."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console
from rich.progress import ProgressColumn, Task, TaskID, TextColumn
from rich.text import Text

from verification.commands.common.choice import path_of
from verification.commands.common.exits import EXIT, STOPPED, CommandError, with_exit_code
from verification.commands.common.options import AsJson, Jobs, Output, Quiet, Strict
from verification.commands.common.solving import progress_bar, require_gmsh
from verification.commands.common.terminal import (
    print_error,
    print_json,
    print_out,
    print_warnings,
)
from verification.judging.verdict import Outcome
from verification.running.pool import cores
from verification.running.provenance import commit, machine
from verification.study.plan import Study, read_study_file, shipped_studies

if TYPE_CHECKING:
    from verification.study.engine import Outcome as StudyOutcome


@with_exit_code
def thickness(
    plan: str = "default",
    *,
    output: Output = Path("reports/study"),
    jobs: Jobs = None,
    scheduler: str | None = None,
    limit: int | None = None,
    cross_check: bool = True,
    figures: bool = True,
    strict: Strict = False,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> int:
    """Which thickness? Stresses of a coating against thickness, stiffness and friction, cross-checked.

    A stopped study resumes where it was stopped; no point is solved twice.

    Args:
        plan: Name of a shipped study, or the path of a .toml study file.
        output: Directory of the table, PLAN.parquet, and of the cache.
        scheduler: Address of a running Dask scheduler, in place of a local cluster.
        limit: Only the first so many points.
        cross_check: Solve every k-th point by finite elements and by the exact reference too.
        figures: Draw the table: PLAN.html, and figures/PLAN for print.
    """
    if (jobs is not None and jobs < 1) or (limit is not None and limit < 1):
        raise CommandError(f"--jobs = {jobs}, --limit = {limit}; both must be positive")
    chosen = _choose(plan)
    print_warnings(chosen.warnings, chosen.name, strict=strict, silent=quiet or as_json)
    if not cross_check:
        chosen = replace(chosen, cross_check=0)
    if chosen.cross_check:
        require_gmsh()

    from verification.study.engine import SchedulerError, connected, run_study, table_path

    silent = quiet or as_json
    begin = time.perf_counter()
    try:
        with _bars(silent) as report:
            came = run_study(chosen, output, partial(connected, scheduler, jobs), limit=limit, report=report)
        page = _page(chosen, came, time.perf_counter() - begin) if figures else None
    except SchedulerError as error:
        raise CommandError(str(error)) from None
    except KeyboardInterrupt:
        sys.stderr.write(
            f"\ncoatcheck: stopped; solved points are in {table_path(output, chosen)}, "
            "the same command resumes from there\n"
        )
        return STOPPED
    for message in came.damaged:
        print_error(f"{message.split(';')[0]}; solved again")
    if as_json:
        content = asdict(came) | {"table": str(came.table), "lost": len(came.lost)}
        content["warnings"] = chosen.warnings
        content["page"] = None if page is None else str(page)
        print_json(content)
    elif not quiet:
        seconds = time.perf_counter() - begin
        print_out(
            f"{came.points} points in {seconds:.0f} s: {came.done} solves done, {came.kept} found in the "
            f"cache, {came.failed} of {came.rows} rows failed; table: {came.table}"
            + ("" if page is None else f"; page: {page}")
        )
    return EXIT[Outcome.NO_RESULT] if came.failed else EXIT[Outcome.AGREES]


def _page(chosen: Study, came: "StudyOutcome", seconds: float) -> Path:
    from verification.report.study.page import write_study_report

    facts = [
        ("solves", f"{came.done} done, {came.kept} from the cache"),
        ("duration", f"{seconds:.0f} s"),
        ("commit", commit() or "not in a repository"),
        ("machine", f"{machine()}, {cores()} cores"),
    ]
    return write_study_report(came.table, chosen, came.table.parent, facts)


def _choose(plan: str) -> Study:
    shipped = shipped_studies()
    return read_study_file(path_of(plan, shipped, f"study ({', '.join(shipped)})"))


class _Rate(ProgressColumn):
    """Points a second."""

    def render(self, task: Task) -> Text:
        return Text("" if task.speed is None else f"{task.speed:.2f}/s")


@contextmanager
def _bars(silent: bool) -> Iterator[Callable[[str, int, int], None]]:
    """A progress bar for the points of each source with rate and time left, unless ``silent``."""
    console = Console(stderr=True)
    bar = progress_bar(console, TextColumn("points"), _Rate(), silent=silent)
    tasks: dict[str, TaskID] = {}

    def report(source: str, done: int, total: int) -> None:
        if source not in tasks:
            tasks[source] = bar.add_task(source, total=total)
        bar.update(tasks[source], completed=done, total=total)

    with bar:
        yield report
