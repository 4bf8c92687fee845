"""Both methods timed over another commit, beside other codes."""

import datetime
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated, get_args

from cyclopts import Parameter
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from bench.checkout import checkout
from bench.device import LIBRARY, not_measured
from bench.figures import PEERS, Figure, Other, Part, groups, measure
from bench.history import BenchRun, append, read
from verification.commands.common.command_error import CommandError
from verification.commands.common.exit_codes import with_exit_code
from verification.commands.common.known_folders import require_format
from verification.commands.common.shared_options import AsJson, Flag
from verification.commands.common.task_progress import progress_bar
from verification.commands.common.terminal import named_table, print_error, print_json, print_out
from verification.judging.outcome import Outcome
from verification.regression.run_exit_codes import EXIT
from verification.running.json_records import encode
from verification.running.provenance import PACKAGES, commit, machine, versions

Numbers = Annotated[tuple[int, ...], Parameter(consume_multiple=True, negative="")]
FASTER = "pypardiso"  # distribution of the extra "fast"
SHOWN = 4  # runs in the table of the history


@with_exit_code
def bench(
    *parts: Part,
    against: str | None = None,
    python: str = sys.executable,
    sizes: Annotated[Numbers, Parameter(name=["--sizes", "-N"])] = (),
    threads: Numbers = (1, 2),
    rounds: int = 5,
    history: Path | None = None,
    plot: Path | None = None,
    show: Flag = False,
    as_json: AsJson = False,
) -> int:
    """Time both methods over another commit, the patches beside other codes; print ratios with what is asked.

    All works of a figure are done in turn, each in a process of its own. tamaas comes with the extra "bench",
    aspher with pip install aspher, which builds it; each is measured where installed, as is the extra "fast".
    The part gpu is left out, in a line, where CuPy is not installed or finds no device.
    The exit code is 1 where a figure misses what is asked. On idle cores all parts but the last take an hour.

    Args:
        parts: Unless given, all but default-run; solve, stress, elements and default-run need --against.
        against: The commit to measure over, or a directory with a checkout of it.
        python: Interpreter for that commit, of an environment with what it needs.
        sizes: Patches along a side of the square [-2a, 2a]^2; unless given 512, 1024, 2048 of the contact,
            4096, 8192, 16384 on the GPU.
        threads: Numbers of threads of the part contact.
        rounds: Turns of each work after the first, which is not timed; the median counts.
        history: Add the figures to this file, show them beside those of its last runs.
        plot: Write the history as FILE.png, FILE.pdf or FILE.svg.
        show: Measure nothing; show the history.
    """
    most = 16384 if parts == ("gpu",) else 4096
    if min(sizes, default=16) < 16 or max(sizes, default=16) > most or min(threads) < 1 or rounds < 1:
        raise CommandError(f"--sizes from 16 to {most}, --threads and --rounds from 1")
    if show and history is None:
        raise CommandError("--show shows a file; name it with --history")
    if plot is not None:
        require_format(plot)
    runs = read(history) if history is not None else ()
    missed: list[Figure] = []
    failed = False
    if show:
        if not runs:
            raise CommandError(f"{history}: holds no run of python tests/tools bench")
    else:
        figures, failed = _measured(parts, against, python, sizes, threads, rounds)
        date = datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds")
        run = BenchRun(
            commit(), date, machine(), versions((*PACKAGES, *PEERS, FASTER, LIBRARY)), tuple(figures)
        )
        runs = append(history, run) if history is not None and figures else (run,)
        missed = [figure for figure in figures if figure.missed]
    if plot is not None and runs[-1].figures:
        from bench.speed_figure import write

        write(runs, plot)
    if as_json:
        print_json([encode(run) for run in (runs if show else runs[-1:])])
    else:
        if not show and figures:
            print_out(_table(figures), _summary(figures, missed))
        if show or len(runs) > 1:
            print_out(_past(runs[-SHOWN:]))
    return EXIT[Outcome.NO_RESULT if failed else Outcome.DISAGREES if missed else Outcome.AGREES]


def _measured(
    parts: Sequence[Part],
    against: str | None,
    python: str,
    sizes: Sequence[int],
    threads: Sequence[int],
    rounds: int,
) -> tuple[list[Figure], bool]:
    """The figures, and whether a work failed, of which a message is printed."""
    alone = [part for part in parts if part not in ("contact", "gpu")]
    if alone and against is None:
        raise CommandError(f"{', '.join(alone)}: measured over another commit; name it with --against")
    with ExitStack() as stack:
        other = None
        if against is not None:
            try:
                other = Other(*stack.enter_context(checkout(against)), python)
            except ValueError as error:
                raise CommandError(f"--against {against}: {error}") from None
        peers = [name for name in PEERS if find_spec(name)]
        chosen = list(parts or get_args(Part)[:-1])  # all but the default run
        reason = not_measured() if "gpu" in chosen else None
        if reason is not None:
            chosen.remove("gpu")
            print_error(f"the part gpu is not measured: {reason}")
        planned = groups(
            chosen,
            other=other,
            sizes=sizes,
            threads=threads,
            peers=peers,
            fast=versions((FASTER,))[FASTER] != "not installed",
        )
        bar = stack.enter_context(progress_bar(Console(stderr=True)))
        task = bar.add_task("", total=sum(len(group.works) * (rounds + 1) for group in planned))
        figures: list[Figure] = []
        failed = False
        for group in planned:
            try:
                figures += measure(group, rounds, lambda name: bar.update(task, advance=1, description=name))
            except RuntimeError as error:
                failed = True
                print_error(str(error))
    return figures, failed


def _table(figures: Iterable[Figure]) -> Table:
    table = named_table("ratio", "at most", "median", "lowest", "highest", "turns", "")
    for figure in _by_over(table, figures):
        table.add_row(
            escape(figure.name),
            _number(figure.asked),
            _median(figure),
            *(_number(value) for value in (min(figure.ratios), max(figure.ratios))),
            str(len(figure.ratios)),
            "[red]missed[/]" if figure.missed else "",
        )
    return table


def _by_over(table: Table, figures: Iterable[Figure]) -> Iterator[Figure]:
    """The figures by what they are over, which is a row of the table before each of these sections."""
    sections: dict[str, list[Figure]] = {}
    for figure in figures:
        sections.setdefault(figure.over, []).append(figure)
    for over, section in sections.items():
        table.add_row(f"[bold]over {escape(over)}[/]")
        yield from section


def _summary(figures: Sequence[Figure], missed: Sequence[Figure]) -> str:
    asked = sum(figure.asked is not None for figure in figures)
    if not asked:
        return "Nothing is asked of these figures."
    if not missed:
        return f"{asked} of {asked} asked figures met."
    names = "; ".join(f"{figure.name} over {figure.over}" for figure in missed)
    return f"{len(missed)} of {asked} asked figures missed: {escape(names)}."


def _past(runs: Sequence[BenchRun]) -> Table:
    """Medians of the ``runs``, a column for each."""
    heads = [f"{run.short}\n{run.date[5:10]}" for run in runs]
    table = named_table("median ratio", "at most", *map(escape, heads))
    latest = {(figure.name, figure.over): figure for run in runs for figure in run.figures}
    for figure in _by_over(table, latest.values()):
        medians = [_median(run.figure(figure)) for run in runs]
        table.add_row(escape(figure.name), _number(figure.asked), *medians)
    return table


def _median(figure: Figure | None) -> str:
    shown = _number(None if figure is None else figure.median)
    return f"[red]{shown}[/]" if figure is not None and figure.missed else shown


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.3g}"
