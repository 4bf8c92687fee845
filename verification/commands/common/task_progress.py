"""Progress of tasks on the terminal; results of earlier runs that can be kept."""

import datetime
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

from rich.markup import escape

from verification.cases.case_file import Case
from verification.cases.published_file import PublishedCase
from verification.commands.common.command_error import CommandError
from verification.commands.common.terminal import STYLE, one_line, print_error
from verification.commands.common.terminal_bar import progress_bar
from verification.running.case_result import CaseResult, RunInfo
from verification.running.case_tasks import kept_result
from verification.running.checked_files import StoreError
from verification.running.pool.pool_task import Task
from verification.running.pool.process_pool import run_tasks
from verification.running.provenance import commit, cores, fingerprint, hardware, numerical_versions

T = TypeVar("T")


def worker_count(jobs: int | None, **most: float | None) -> int:
    """Processes side by side. Raises CommandError where it is not positive, or one of ``most`` is not."""
    jobs = cores() if jobs is None else jobs
    given = {"jobs": jobs} | {name: value for name, value in most.items() if value is not None}
    if wrong := [f"--{name.replace('_', '-')} = {value:g}" for name, value in given.items() if not value > 0]:
        raise CommandError(f"{', '.join(wrong)}; it must be positive")
    return jobs


@contextmanager
def executor_at(scheduler: str | None) -> Iterator[Executor | None]:
    """The workers of the Dask scheduler at an address; None where none is given."""
    if scheduler is None:
        yield None
        return
    try:
        from distributed import Client
    except ImportError:
        missing = "Dask is not installed here; python -m pip install 'coatcheck[cluster]'"
        raise CommandError(f"--scheduler {scheduler}: {missing}") from None
    try:
        client = Client(scheduler, timeout=10, set_as_default=False)
    except (OSError, ValueError) as error:
        reason = f"no scheduler answers ({error}); start one with: dask scheduler"
        raise CommandError(f"--scheduler {scheduler}: {one_line(reason)}") from None
    with client:
        yield client.get_executor()


def kept_results(
    chosen: Sequence[Case | PublishedCase], output: Path, *, fields: bool = False
) -> dict[str, CaseResult]:
    """Earlier results that can be kept, by name; prints why another one cannot."""
    kept = {}
    for case in chosen:
        try:
            result = kept_result(output, case, fields=fields)
        except StoreError as error:
            print_error(f"{error}; computed again")
            continue
        if result is not None:
            kept[case.name] = result
    return kept


def solve(
    tasks: Sequence[Task[T]],
    jobs: int,
    time_limit: float,
    silent: bool,
    *,
    executor: Executor | None = None,
    verbose: bool = False,
    meanwhile: Callable[[], object] = lambda: None,
) -> list[T]:
    """Run ``tasks`` with a progress bar and a line for each result, unless ``silent``.

    verbose : print seconds, iterations and unknowns of every source.
    executor, meanwhile : as in ``run_tasks``.
    """
    at_work: list[str] = []
    with progress_bar(silent=silent) as bar:
        task = bar.add_task("solving", total=len(tasks))

        def started(name: str) -> None:
            at_work.append(name)
            bar.update(task, description=", ".join(at_work))

        def finished(name: str, result: T) -> None:
            at_work.remove(name)
            bar.update(task, advance=1, description=", ".join(at_work) or "report")
            if not silent and isinstance(result, CaseResult) and result.verdicts:
                colour = STYLE[result.outcome]
                line = f"[{colour}]{result.outcome:<12}[/] {escape(result.name)}  {result.seconds:.1f} s"
                bar.console.print(line, highlight=False)
                if verbose:
                    bar.console.print(escape(_sources(result)), style="dim", highlight=False)

        return run_tasks(
            tasks,
            jobs=jobs,
            time_limit=time_limit,
            executor=executor,
            started=started,
            finished=finished,
            meanwhile=meanwhile,
        )


def _sources(result: CaseResult) -> str:
    """A line for each source of a case: its seconds, iterations and unknowns, or why it failed."""
    lines = []
    for source in result.sources:
        text = f"{'':13}{source.source:<18} {source.seconds:6.2f} s"
        for name in ("iterations", "patches", "dofs"):
            if name in source.diagnostics:
                text += f"  {source.diagnostics[name]} {name}"
        lines.append(text if source.failure is None else f"{text}  {one_line(source.failure)}")
    return "\n".join(lines)


def run_info(command: str, started: datetime.datetime, jobs: int, scheduler: str | None = None) -> RunInfo:
    """Command, time, commit, machine and versions of the run that ends now."""
    return RunInfo(
        command=command,
        started=started.isoformat(timespec="seconds"),
        seconds=(datetime.datetime.now(datetime.UTC) - started).total_seconds(),
        jobs=jobs,
        commit=commit(),
        machine=hardware() + (f" with the workers of {scheduler}" if scheduler else ""),
        versions=numerical_versions(),
        source=fingerprint(packages=()),
    )
