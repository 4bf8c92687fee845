"""Both methods timed over another commit, beside other codes."""

import sys
from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from importlib.util import find_spec
from typing import Annotated, get_args

from cyclopts import Parameter
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from bench.checkout import checkout
from bench.figures import PEERS, Figure, Other, Part, groups, measure
from verification.commands.common.command_error import CommandError
from verification.commands.common.exit_codes import with_exit_code
from verification.commands.common.shared_options import AsJson
from verification.commands.common.terminal import named_table, print_error, print_json, print_out
from verification.commands.common.terminal_bar import progress_bar
from verification.judging.outcome import Outcome
from verification.regression.run_exit_codes import EXIT
from verification.running.json_records import encode
from verification.running.provenance import PACKAGES, commit, machine, versions

Numbers = Annotated[tuple[int, ...], Parameter(consume_multiple=True, negative="")]
FASTER = "pypardiso"  # distribution of the extra "fast"


@with_exit_code
def bench(
    *parts: Part,
    against: str | None = None,
    python: str = sys.executable,
    sizes: Annotated[Numbers, Parameter(name=["--sizes", "-N"])] = (),
    threads: Numbers = (1, 2),
    rounds: int = 5,
    as_json: AsJson = False,
) -> int:
    """Time both methods over another commit, the patches beside other codes; print ratios with their targets.

    The works of a figure are done in turn, each in a process of its own. tamaas comes with the extra "bench",
    aspher with pip install aspher, which builds it; each is measured where installed, as is the extra "fast".
    The exit code is 1 where a figure misses its target. On idle cores all parts but the last take an hour.

    Args:
        parts: Unless given, all but default-run; solve, stress, elements and default-run need --against.
        against: The commit to measure over, or a directory with a checkout of it.
        python: Interpreter for that commit, of an environment with what it needs.
        sizes: Patches along a side of the square [-2a, 2a]^2; unless given 512, 1024, 2048.
        threads: Numbers of threads of the part contact.
        rounds: Turns of each work after the first, which is not timed; the median counts.
    """
    if min(sizes, default=16) < 16 or max(sizes, default=16) > 4096 or min(threads) < 1 or rounds < 1:
        raise CommandError("--sizes from 16 to 4096, --threads and --rounds from 1")
    figures, failed = _measured(parts, against, python, sizes, threads, rounds)
    if as_json:
        made_by = {
            "commit": commit(),
            "machine": machine(),
            "versions": versions((*PACKAGES, *PEERS, FASTER)),
        }
        print_json(made_by | {"figures": [encode(figure) for figure in figures]})
    elif figures:
        print_out(_table(figures))
    missed = any(figure.missed for figure in figures)
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
    alone = [part for part in parts if part != "contact"]
    if alone and against is None:
        raise CommandError(f"{', '.join(alone)}: measured over another commit; name it with --against")
    with ExitStack() as stack:
        other = None
        if against is not None:
            try:
                other = Other(*stack.enter_context(checkout(against)), python)
            except ValueError as error:
                raise CommandError(f"--against {against}: {error}") from None
        planned = groups(
            parts or get_args(Part)[:-1],  # all but the default run
            other=other,
            sizes=sizes,
            threads=threads,
            peers=[name for name in PEERS if find_spec(name)],
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
    table = named_table("ratio", "over", "at most", "median", "lowest", "highest", "turns", "")
    for figure in figures:
        asked = "-" if figure.asked is None else f"{figure.asked:.3g}"
        found = (figure.median, min(figure.ratios), max(figure.ratios))
        table.add_row(
            escape(figure.name),
            escape(figure.over),
            asked,
            *(f"{value:.3g}" for value in found),
            str(len(figure.ratios)),
            "[red]missed[/]" if figure.missed else "",
        )
    return table
