"""What a chosen number of a method trades: errors and time of random problems with other values of it."""

import time
from collections.abc import Iterator
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

import numpy as np
from drawn_problems import draw
from faults_planted.fault_anchor import Change
from faults_planted.fault_planting import owner_of, planted
from numpy.typing import NDArray

from verification.cases.case_file import parse_case
from verification.commands.common.command_error import CommandError
from verification.commands.common.shared_options import Flag
from verification.commands.common.terminal import named_table, print_out, with_exit_code
from verification.running.case_result import CaseResult, Profile
from verification.running.contact_run import judge_case, solve_case
from verification.sources.source_registry import EXACT, METHODS, solvers

LEAST = 1e-9  # of the largest reference value of a profile: smaller errors are rounding
Array = NDArray[np.floating]


@with_exit_code
def trade(target: str, *values: str, count: int = 4, seed: int = 5, films: Flag = False) -> int:
    """Solve the same random problems with each of the ``values`` of a number, and by the exact reference.

    Args:
        target: Package and name, as "fem_reference.element_numbers:FAN_POWER".
        values: As Python; the present one is taken besides.
        count: Number of problems.
        seed: Seed of the problems.
        films: Thin films alone.
    """
    source = target.split(".")[0]
    if source not in METHODS:
        raise CommandError(f"target = {target}; it names a number of {' or '.join(METHODS)}")
    owner, name = owner_of(target)
    present = repr(vars(owner)[name])
    table = named_table("value", "seconds", "error of scalars", "of fields", "error over U")
    for value in dict.fromkeys((present, *values)):
        begin = time.process_time()
        with nullcontext() if value == present else planted((Change(target, by=value),)):
            results = [solved(draw(seed, number, films).text, source) for number in range(count)]
        seconds = time.process_time() - begin
        scalars, fields, ratios = np.max([_errors(result, source) for result in results], axis=0)
        table.add_row(value, f"{seconds:.0f}", f"{scalars:.1e}", f"{fields:.1e}", f"{ratios:.2f}")
    print_out(table)
    return 0


def solved(text: str, source: str) -> CaseResult:
    """A problem by one method and the exact reference, sampled along all its lines."""
    case = parse_case(text.encode(), Path("drawn.toml"))
    pair = {source, EXACT[0]}
    case = replace(case, claims=tuple(claim for claim in case.claims if set(claim.between) == pair))
    return judge_case(case, solve_case(case, {name: solvers()[name] for name in pair}), invariants=False)


def compared(result: CaseResult, source: str) -> Iterator[tuple[Profile, Array, Array]]:
    """Each profile of a method, its error against the exact reference, 0 where it is rounding, and the
    uncertainty of both."""
    profiles = {(p.quantity, p.line, p.source): p for p in result.profiles}
    for (quantity, line, name), mine in profiles.items():
        exact = profiles.get((quantity, line, EXACT[0]))
        if name != source or exact is None or mine.uncertainty is None or exact.uncertainty is None:
            continue
        error, U = np.abs(mine.value - exact.value), mine.uncertainty + exact.uncertainty
        rounding = LEAST * np.abs(exact.value).max(initial=0.0)
        yield mine, np.where(error > rounding, error, 0.0), np.maximum(U, np.finfo(float).tiny)


def _errors(result: CaseResult, source: str) -> tuple[float, float, float]:
    """Largest error of a scalar and of a field over its largest value, and over the uncertainty of both."""
    scalars, fields, ratios = [0.0], [0.0], [0.0]
    for mine, error, U in compared(result, source):
        largest = np.abs(mine.value).max(initial=1e-300)
        (scalars if mine.line == "contact" else fields).append(float(error.max() / largest))
        ratios.append(float((error / U).max(initial=0.0)))
    return max(scalars), max(fields), max(ratios)
