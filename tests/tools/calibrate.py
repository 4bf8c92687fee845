"""Calibration: the factors of a method's uncertainty, from its errors on clean random problems.

    python tests/tools calibrate --seed A --write

is the only way to change them. Seeds that judge a method are none that calibrated it.
"""

import json
import re
import subprocess
from importlib import import_module
from pathlib import Path

import numpy as np
from drawn_problems import draw
from trade import compared, solved

from verification.commands.common.command_error import CommandError
from verification.commands.common.shared_options import Flag, Quiet
from verification.commands.common.terminal import named_table, print_out, with_exit_code
from verification.running.case_result import CaseResult
from verification.running.provenance import fingerprint

RECORD = Path(__file__).with_name("calibrated.json")
MARGIN = 0.8  # largest error over uncertainty on the problems that calibrate
JUDGES = (1, 20260, 31337)  # seeds of evidence, at present and in the past
SOURCE, TABLE = "semianalytic", "semianalytic.numbers"
ROACHE = 1.25  # of three grids with an observed order, the least that SAFETY is
MOST_SHOWN = 12


@with_exit_code
def calibrate(
    *,
    seed: int,
    count: int = 12,
    films: int = 4,
    write: Flag = False,
    record: Path = RECORD,
    quiet: Quiet = False,
) -> int:
    """Solve clean random problems by patches and the exact reference; derive the factor of the uncertainty.

    SAFETY is Roache's, and more in proportion where the largest error is more than ``MARGIN`` of U.

    Args:
        seed: Seed of the problems, none that judges a method.
        count: Problems of any number of coatings.
        films: Problems of thin films besides.
        write: Store them in the method's table, and with seed, commit and hash of its source in the record.
        record: The file that tells where they come from.
    """
    if seed in JUDGES:
        raise CommandError(f"--seed = {seed} judges the methods; take one that nothing was judged by")
    drawn = [draw(seed, k) for k in range(count)] + [draw(seed, k, films=True) for k in range(films)]
    if not drawn:
        raise CommandError(f"--count = {count}, --films = {films}; at least one problem is needed")
    results = [solved(problem.text, SOURCE) for problem in drawn]
    found = sorted((row for result in results for row in _ratios(result)), reverse=True)
    wanted = _factors(found[0][0])
    if not quiet:
        table = named_table("problem", "quantity", "line", "error over U")
        for ratio, *where in found[:MOST_SHOWN]:
            table.add_row(*where, f"{ratio:.2f}")
        print_out(table, ", ".join(f"{name} = {value:g}" for name, value in wanted.items()))
    if write:
        made = {"seed": seed, "problems": count, "films": films, "profiles": len(found), "commit": _commit()}
        made |= {"largest": round(found[0][0], 3), "source": fingerprint((SOURCE,), ()), "factors": wanted}
        record.write_text(json.dumps(made, indent=1, sort_keys=True) + "\n", encoding="utf-8")
        store(Path(str(import_module(TABLE).__file__)), wanted)
    return 0


def store(table: Path, factors: dict[str, float]) -> None:
    """Write the factors over those in the method's table of numbers."""
    text = table.read_text(encoding="utf-8")
    for name, value in factors.items():
        text = re.sub(rf"^{name} = .*$", f"{name} = {value:g}", text, flags=re.MULTILINE)
    table.write_text(text, encoding="utf-8")


def _ratios(result: CaseResult) -> list[tuple[float, str, str, str]]:
    """Of each profile: its largest error over the uncertainty of both, and which it is."""
    return [
        (float((error / U).max(initial=0.0)), result.title, mine.quantity, mine.line)
        for mine, error, U in compared(result, SOURCE)
    ]


def _factors(largest: float) -> dict[str, float]:
    """SAFETY with which the largest error over uncertainty would be ``MARGIN``, rounded up."""
    safety = max(ROACHE, import_module(TABLE).SAFETY * largest / MARGIN)
    return {"SAFETY": float(np.ceil(100 * safety - 1e-9) / 100)}


def _commit() -> str:
    told = subprocess.run(["git", "rev-parse", "HEAD"], cwd=RECORD.parent, capture_output=True, text=True)
    return told.stdout.strip()
