"""A sphere solved by the patches of the semi-analytical method, timed beside other codes."""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from statistics import median
from typing import Annotated, Any

from cyclopts import Parameter
from rich.console import Console
from rich.markup import escape

from bench.judge import LIMIT
from bench.peers import SOLVERS
from verification.commands.common.command_error import CommandError
from verification.commands.common.exit_codes import with_exit_code
from verification.commands.common.shared_options import AsJson
from verification.commands.common.terminal import named_table, print_error, print_json, print_out
from verification.commands.common.terminal_bar import progress_bar
from verification.judging.outcome import Outcome
from verification.regression.run_exit_codes import EXIT
from verification.running.provenance import PACKAGES, commit, machine, versions

Numbers = Annotated[tuple[int, ...], Parameter(consume_multiple=True, negative="")]
CONTACT, UNIT, *PEERS = SOLVERS
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


@with_exit_code
def bench(
    *,
    sizes: Annotated[Numbers, Parameter(name=["--sizes", "-N"])] = (512, 1024, 2048),
    threads: Numbers = (1, 2),
    rounds: int = 5,
    as_json: AsJson = False,
) -> int:
    """Time the contact of a sphere over that of other codes, over one convolution and over fewer threads.

    Each solve has a process of its own; those that are compared take turns, so that whatever slows the
    machine meets all of them alike. tamaas comes with the extra "bench", aspher with pip install aspher,
    which builds it; each is measured where installed. The exit code is 3 where a code fails or its pressures
    do not meet the common limit on the residual.

    Args:
        sizes: Patches along a side of the square [-2a, 2a]^2.
        threads: Numbers of threads.
        rounds: Turns of each solve; the median counts.
    """
    if min(sizes) < 16 or max(sizes) > 4096 or min(threads) < 1 or rounds < 1:
        raise CommandError("--sizes from 16 to 4096, --threads and --rounds from 1")
    solvers = [CONTACT, UNIT, *(name for name in PEERS if find_spec(name))]
    rows: list[dict[str, Any]] = []
    failed = False
    with progress_bar(Console(stderr=True)) as bar:
        task = bar.add_task("", total=len(sizes) * rounds * len(threads) * len(solvers))
        for patches in sizes:
            turns: list[dict[tuple[str, int], dict[str, float]]] = []
            try:
                for _ in range(rounds):
                    turns.append({})
                    for key in ((solver, count) for count in threads for solver in solvers):
                        bar.update(task, advance=1, description=f"{key[0]}, N = {patches}")
                        turns[-1][key] = solved(key[0], patches, key[1])
            except RuntimeError as error:
                failed = True
                print_error(str(error))
                continue
            rows += compared(turns, patches, threads)
            worst = max(one["residual"] for turn in turns for one in turn.values())
            failed |= worst > LIMIT
    if as_json:
        made_by = {"commit": commit(), "machine": machine(), "versions": versions((*PACKAGES, *PEERS))}
        print_json(made_by | {"ratios": rows})
    elif rows:
        table = named_table("patches a side", "threads", "over", "median", "lowest", "highest", "residual")
        for row in rows:
            table.add_row(
                *(
                    escape(f"{value:.3g}" if isinstance(value, float) else str(value))
                    for value in row.values()
                )
            )
        print_out(table)
    return EXIT[Outcome.NO_RESULT if failed else Outcome.AGREES]


def solved(solver: str, patches: int, threads: int) -> dict[str, float]:
    """Seconds and residual of a ``solver`` in its own process. Raises RuntimeError with its last line."""
    child = Path(__file__).with_name("peers.py")
    environment = os.environ | dict.fromkeys(_THREADS, str(threads))
    words = [sys.executable, str(child), solver, str(patches), str(threads)]
    done = subprocess.run(words, capture_output=True, text=True, env=environment, check=False)
    if done.returncode:
        raise RuntimeError(f"{solver} failed: {(done.stderr.strip().splitlines() or ['no message'])[-1]}")
    answer: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    return answer


def compared(
    turns: Sequence[dict[tuple[str, int], dict[str, float]]], patches: int, threads: Sequence[int]
) -> list[dict[str, Any]]:
    """Ratios of the contact's seconds to those of every other solver, and to those on the fewest threads."""
    rows = []
    for count in threads:
        others = [(name, count) for name, of in turns[0] if of == count and name != CONTACT]
        others += [(CONTACT, threads[0])] if count != threads[0] else []
        for name, of in others:
            ratios = [turn[CONTACT, count]["seconds"] / turn[name, of]["seconds"] for turn in turns]
            over = name if name != CONTACT else f"{of} thread{'s' * (of > 1)}"
            residual = max(turn[key]["residual"] for turn in turns for key in ((CONTACT, count), (name, of)))
            found = {"median": median(ratios), "lowest": min(ratios), "highest": max(ratios)}
            rows.append({"patches": patches, "threads": count, "over": over, **found, "residual": residual})
    return rows
