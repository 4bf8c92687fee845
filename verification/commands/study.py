"""coatcheck study: parameter studies."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from cyclopts import Parameter
from rich.markup import escape
from rich.progress import TaskID

from verification.commands.common.command_error import STOPPED, CommandError
from verification.commands.common.named_files import path_of
from verification.commands.common.shared_options import AsJson, Jobs, Output, Quiet, Scheduler, Strict
from verification.commands.common.task_progress import executor_at, worker_count
from verification.commands.common.terminal import (
    print_error,
    print_json,
    print_out,
    print_warnings,
    with_exit_code,
)
from verification.commands.common.terminal_bar import progress_bar, require_gmsh
from verification.judging.verdict import Outcome
from verification.regression.run_exit_codes import EXIT
from verification.running.provenance import commit, hardware
from verification.sources.source_registry import SOURCES
from verification.study.study_plan import Study, read_study_file, shipped_studies

if TYPE_CHECKING:
    from verification.study.study_engine import StudyRun

LABELS = {name: source.label for name, source in SOURCES.items()}
FIGURE_GROUPS = 5


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of a study of either kind."""

    output: Output = Path("reports/study")
    """Directory of the table, PLAN.parquet, and of the cache."""
    jobs: Jobs = None
    scheduler: Scheduler = None
    cross_check: bool = True
    """Solve every k-th point by finite elements and by the exact reference too."""
    figures: bool = True
    """Draw figures for the page, PLAN.html, and for print, in figures/PLAN."""
    strict: Strict = False
    quiet: Quiet = False
    as_json: AsJson = False


DEFAULT = Options()


@with_exit_code
def thickness(plan: str = "default", *, options: Options = DEFAULT) -> int:
    """Which thickness? Stresses of a coating against thickness, stiffness and friction, cross-checked.

    A stopped study resumes where it was stopped; no point is solved twice.

    Args:
        plan: Name of a shipped study, or the path of a .toml study file.
    """
    return _study(plan, options, loads=False)


@with_exit_code
def load(plan: str = "dlc_load", *, options: Options = DEFAULT) -> int:
    """Which load? The load at which each failure mode reaches its strength, over thickness and friction.

    A stopped study resumes where it was stopped; no point is solved twice.

    Args:
        plan: Name of a shipped study with sweep.load, or the path of a .toml study file.
    """
    return _study(plan, options, loads=True)


TEMPLATES = {"thickness": "dlc_on_chromium", "load": "dlc_load", "stiffness": "default"}


@with_exit_code
def init(kind: Literal["thickness", "load", "stiffness"], file: Path | None = None, /) -> int:
    """Write a commented study file that runs as it is, to be changed.

    Args:
        kind: What the study is to find.
        file: Where to write it; my_KIND.toml unless given. A file that exists is left as it is.
    """
    path = file or Path(f"my_{kind}.toml")
    try:
        with path.open("x", encoding="utf-8") as written:
            written.write(shipped_studies()[TEMPLATES[kind]].read_text(encoding="utf-8"))
    except FileExistsError:
        raise CommandError(f"{path}: exists already; give another name") from None
    except OSError as error:
        raise CommandError(f"{path}: {error.strerror}; give a path that can be written") from None
    command = "load" if kind == "load" else "thickness"
    print_out(escape(f"{path} is written; change it, then run: coatcheck study {command} {path}"))
    return EXIT[Outcome.AGREES]


def _study(plan: str, options: Options, *, loads: bool) -> int:
    output, silent = options.output, options.quiet or options.as_json
    output = output.absolute() if options.scheduler else output  # workers have folders of their own
    jobs, shipped = worker_count(options.jobs), shipped_studies()
    chosen = read_study_file(path_of(plan, shipped, f"study ({', '.join(shipped)})"))
    if loads != (chosen.loads is not None):
        what = "sweeps the load; use coatcheck study load"
        if loads:
            what = "has no sweep.load; use coatcheck study thickness, or coatcheck study init load"
        raise CommandError(f"{plan}: this study {what}")
    if loads and chosen.criteria.strength is None:
        raise CommandError(f"{plan}: criteria.strength is missing; a critical load needs strengths")
    print_warnings(chosen.warnings, chosen.name, strict=options.strict, silent=silent)
    if not options.cross_check:
        chosen = replace(chosen, cross_check=0)
    if chosen.cross_check:
        require_gmsh()

    from verification.study.pages.load_page import write_load_report
    from verification.study.pages.thickness_page import write_study_report
    from verification.study.study_engine import run_study, table_path

    write_report = write_load_report if loads else write_study_report
    begin = time.perf_counter()
    try:
        if not silent:
            sys.stderr.write(f"coatcheck: {_forecast(chosen, output, jobs)}\n")
        with executor_at(options.scheduler) as executor, _bars(silent) as (report, drawing):
            again = partial(run_study, folder=output, jobs=jobs, executor=executor, report=report)
            came = again(chosen)
            if loads:
                chosen, came = _extended(chosen, came, again)
            facts = [
                ("solves", f"{came.done} done, {came.kept} from the cache"),
                ("duration", f"{time.perf_counter() - begin:.0f} s"),
                ("commit", commit() or "not in a repository"),
                ("machine", hardware()),
            ]
            written = write_report(
                came.table, chosen, output, facts, figures=options.figures, drawing=drawing
            )
    except KeyboardInterrupt:
        sys.stderr.write(
            f"\ncoatcheck: stopped; solved points are in {table_path(output, chosen)}, "
            "the same command resumes from there\n"
        )
        return STOPPED
    seconds = time.perf_counter() - begin
    for message in came.damaged:
        print_error(f"{message.split(';')[0]}; solved again")
    if options.as_json:
        content = asdict(came) | {"table": str(came.table), "lost": len(came.lost), "seconds": seconds}
        content |= {
            "warnings": [*chosen.warnings, *written.warnings],
            "page": str(written.page),
            "answer": written.answer,
        }
        print_json(content)
    elif not options.quiet:
        print_out(
            *(f"[bold]{escape(line)}[/]" for line in written.answer),
            f"{came.points} points in {seconds:.0f} s: {came.done} solves done, {came.kept} found in the "
            f"cache, {came.failed} of {came.rows} rows failed; table: {came.table}; page: {written.page}",
        )
    print_warnings(written.warnings, chosen.name, strict=options.strict, silent=silent)
    return EXIT[Outcome.NO_RESULT] if came.failed else EXIT[Outcome.AGREES]


def _extended(chosen: Study, came: "StudyRun", again: "Callable[..., StudyRun]") -> "tuple[Study, StudyRun]":
    """The study of loads with its outcome, begun lower until every mode is below its strength there."""
    from verification.study.choice.critical_load import extended
    from verification.study.study_table import read_columns

    while (lower := extended(chosen, read_columns(came.table))) is not None and lower.loads is not None:
        before, chosen = came, lower
        print_error(
            f"{chosen.name}: a strength is exceeded at the first load already; the ramp is extended down to "
            f"{lower.loads[0]:.3g} N"
        )
        came = again(chosen)
        came.done += before.done
    return chosen, came


def _forecast(chosen: Study, output: Path, jobs: int) -> str:
    """The solves of the study with the time they take, before the first of them starts."""
    from verification.study.study_engine import forecast

    counts, seconds = forecast(chosen, output)
    parts = [
        f"{count} {LABELS[source]}" + (f" ({stored} of them stored)" if stored else "")
        for source, (count, stored) in counts.items()
    ]
    usual = seconds / jobs
    time = f"{usual:.0f} s" if usual < 100 else f"{usual / 60:.0f} min"
    return f"{chosen.title}: solves: {', '.join(parts)}, then figures; about {time} on {jobs} idle cores"


@contextmanager
def _bars(silent: bool) -> Iterator[tuple[Callable[[str, int, int], None], Callable[[str], None]]]:
    """Progress bars, unless ``silent``: points of each source, from the first second; then the figures."""
    tasks: dict[str, TaskID] = {}

    def report(source: str, done: int, total: int) -> None:
        if source not in tasks:
            tasks[source] = bar.add_task(f"points, {LABELS[source]}", total=total)
        bar.update(tasks[source], completed=done, total=total)

    def drawing(name: str) -> None:
        if "drawing" not in tasks:
            tasks["drawing"] = bar.add_task("", total=FIGURE_GROUPS)
        bar.update(tasks["drawing"], advance=1, description=f"drawing: {name}")

    with progress_bar(silent=silent) as bar:
        yield report, drawing
