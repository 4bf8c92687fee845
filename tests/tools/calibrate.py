"""Calibration: the factors of a method's uncertainty, from its errors on clean random problems.

    python tests/tools calibrate --method patches --seed A

The largest error over uncertainty, against the exact reference, is to be ``MARGIN`` at most: the factors grow
in proportion where it is more, and shrink no further than what the literature gives. Seeds that judge a
method are none that calibrated it.
"""

import json
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path

import numpy as np
from verification.cases.random_problems import draw

from verification.cases.case_file import parse_case
from verification.commands.common.command_error import CommandError
from verification.commands.common.shared_options import Flag, Quiet
from verification.commands.common.terminal import named_table, print_out, with_exit_code
from verification.running.case_result import CaseResult
from verification.running.contact_run import judge_case, solve_case
from verification.running.provenance import fingerprint
from verification.sources.source_registry import EXACT, solvers

RECORD = Path(__file__).with_name("calibrated.json")
MARGIN = 0.8  # largest error over uncertainty on the problems that calibrate
JUDGES = (1, 20260, 31337)  # seeds of evidence, at present and in the past
LEAST = 1e-9  # of the largest reference value of a profile: smaller errors are rounding
MOST_SHOWN = 12


@dataclass(frozen=True)
class Calibrated:
    """A method by its source, with the factors of its uncertainty in ``module`` and the least of each."""

    source: str
    module: str
    least: dict[str, float]


# SAFETY: Roache's, with an order observed on three grids. WITHIN: a ten-thousandth of a patch.
METHODS = {"patches": Calibrated("semianalytic", "semianalytic.numbers", {"SAFETY": 1.25, "WITHIN": 1e-4})}


@with_exit_code
def calibrate(
    *,
    method: str = "patches",
    seed: int,
    count: int = 24,
    films: int = 6,
    write: Flag = False,
    record: Path = RECORD,
    quiet: Quiet = False,
) -> int:
    """Solve clean random problems by one method and the exact reference; say what its factors should be.

    Args:
        method: The method: patches.
        seed: Seed of the problems, none that judges a method.
        count: Problems of any number of coatings.
        films: Problems of thin films besides.
        write: Store seed, source hash, largest ratio, factors; the method's table follows by hand.
        record: The file they are stored in.
    """
    if method not in METHODS:
        raise CommandError(f"--method = {method}; choose one of {', '.join(METHODS)}")
    if seed in JUDGES:
        raise CommandError(f"--seed = {seed} judges the methods; take one that nothing was judged by")
    one = METHODS[method]
    drawn = [draw(seed, k) for k in range(count)] + [draw(seed, k, films=True) for k in range(films)]
    found = [ratio for problem in drawn for ratio in ratios(solved(problem.text, one.source), one.source)]
    if not found:
        raise CommandError(f"--count = {count}, --films = {films}; at least one problem is needed")
    found.sort(reverse=True)
    wanted = factors(one, found[0][0])
    if not quiet:
        table = named_table("problem", "quantity", "line", "error over U")
        for ratio, *where in found[:MOST_SHOWN]:
            table.add_row(*where, f"{ratio:.2f}")
        print_out(table, ", ".join(f"{name} = {value:.2g}" for name, value in wanted.items()))
    if write:
        known = json.loads(record.read_text(encoding="utf-8")) if record.exists() else {}
        known[method] = {
            "seed": seed,
            "problems": count,
            "films": films,
            "profiles": len(found),
            "largest": round(found[0][0], 3),
            "source": fingerprint((one.module.split(".")[0],), ()),
            "factors": wanted,
        }
        record.write_text(json.dumps(known, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    return 0


def solved(text: str, source: str) -> CaseResult:
    """A problem by one method and the exact reference, sampled along all its lines."""
    case = parse_case(text.encode(), Path("drawn.toml"))
    pair = {source, EXACT[0]}
    claims = tuple(claim for claim in case.claims if set(claim.between) == pair)
    case = replace(case, claims=claims)
    available = {name: solve for name, solve in solvers().items() if name in pair}
    return judge_case(case, solve_case(case, available), invariants=False)


def ratios(result: CaseResult, source: str) -> list[tuple[float, str, str, str]]:
    """Of each profile of the method: its largest error over the uncertainty of both, and which it is."""
    profiles = {(p.quantity, p.line, p.source): p for p in result.profiles}
    found = []
    for (quantity, line, name), mine in profiles.items():
        exact = profiles.get((quantity, line, EXACT[0]))
        if name != source or exact is None or mine.uncertainty is None or exact.uncertainty is None:
            continue
        error = np.abs(mine.value - exact.value)
        counted = error > LEAST * np.abs(exact.value).max(initial=0.0)
        U = np.maximum(mine.uncertainty + exact.uncertainty, np.finfo(float).tiny)
        found.append((float((error / U)[counted].max(initial=0.0)), result.title, quantity, line))
    return found


def factors(one: Calibrated, largest: float) -> dict[str, float]:
    """Factors with which the ``largest`` error over uncertainty would be ``MARGIN``, rounded up."""
    table = import_module(one.module)
    wanted = {}
    for name, least in one.least.items():
        value = max(least, getattr(table, name) * max(1.0, largest / MARGIN))
        digit = 10.0 ** (np.floor(np.log10(value)) - 2)
        wanted[name] = float(f"{np.ceil(value / digit - 1e-9) * digit:.3g}")
    return wanted
