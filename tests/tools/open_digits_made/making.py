"""Make the open digits anew: every problem solved exactly, random samples checked by both methods."""

import json
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from open_digits_made.content import data_set, packed, vector
from open_digits_made.problems import ALWAYS, EACH, SEED, VectorProblem, problems
from open_digits_made.values import compared, exact_rows
from verification.commands.common.terminal import print_out
from verification.guests.vectors import open_digits
from verification.running.checked_files import write_atomically
from verification.running.provenance import machine, versions
from verification.sources.source_registry import METHODS, SOURCES

ALL = "every value, at y = 0 and off it"


def vectors(folder: Path = Path("vectors"), /, *, semianalytic: int = 12, elements: int = 3) -> int:
    """Solve every problem of the open digits and write the data set, which takes minutes.

    Args:
        folder: Directory to write to; each problem is kept in its folder work, so that a run can go on.
        semianalytic: How many problems the semi-analytical method checks.
        elements: How many problems the finite elements check.
    """
    content = make(folder / "work", {"semianalytic": semianalytic, "fem_reference": elements})
    write_atomically(folder / open_digits.FILE.name, packed(content))
    return 0


def make(folder: Path, samples: dict[str, int]) -> dict[str, Any]:
    """The whole data set; each problem is kept in ``folder`` as soon as it is solved.

    samples : how many problems, drawn at random, each method checks; besides some of each kind of ALWAYS.
    """
    chosen = problems()
    solved = [_kept(folder / f"{p.name}.json", partial(_solved, p)) for p in chosen]
    print_out(f"{len(solved)} problems solved")
    checked = [_checked(method, chosen, samples.get(method, 0), folder) for method in METHODS]
    made_by = {
        "exact": "integral equation; Hankel transforms of a disc; closed forms, point forces of an ellipse",
        "machine": machine(),
    }
    # the values of version 1, at y = 0, are still in the data set: their checks stay
    checked = [one for one in open_digits.shipped()["checked"] if one["of"] != ALL] + checked
    return data_set(solved, checked, made_by | {"numpy": versions()["numpy"], "scipy": versions()["scipy"]})


def _solved(one: VectorProblem) -> dict[str, Any]:
    return vector(one, exact_rows(one.problem))


def _checked(method: str, chosen: list[VectorProblem], count: int, folder: Path) -> dict[str, Any]:
    random = np.random.default_rng([SEED, METHODS.index(method)])
    by = {group: [n for n, one in enumerate(chosen) if one.group == group] for group in ALWAYS}
    plain = len(chosen) - sum(map(len, by.values()))
    always = [n for numbers in by.values() for n in numbers[: EACH[method]]]
    numbers = sorted(random.permutation(plain)[:count].tolist()) + always
    total = {"problems": 0, "values": 0, "within": 0}
    largest, refused = 0.0, []
    for number in numbers:
        one = chosen[number]
        found = _kept(folder / method / f"{one.name}.json", partial(_compared, method, one))
        if "refused" in found:
            refused.append(f"{one.name}: {found['refused']}")
            continue
        for name, more in zip(total, (1, found["values"], found["within"]), strict=True):
            total[name] += more
        largest = max(largest, found["largest"])
        print_out(f"{method} {one.name}: {found['within']} of {found['values']}, {found['largest']:.3g} of U")
    return {"method": method, "of": ALL, **total, "largest_share_of_U": largest, "refused": refused}


def _compared(method: str, one: VectorProblem) -> dict[str, Any]:
    solve = SOURCES[method].solve
    assert solve is not None
    try:
        values, within, largest = compared(exact_rows(one.problem), one.problem, solve)
    except Exception as error:  # a problem that the method refuses is counted as such
        return {"refused": " ".join(str(error).split())[:200]}
    return {"values": values, "within": within, "largest": largest}


def _kept(path: Path, compute: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    """The content of ``path``, computed where it is not there."""
    if path.exists():
        found: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        return found
    content = compute()
    write_atomically(path, json.dumps(content))
    return content
