"""The accuracy study of a default run: convergence of both methods on two solids of known answer.

A process of its own measures it beside the cases and leaves a checked file:

python -m verification.credibility.accuracy accuracy.json
"""

import os
import sys
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from verification.credibility.parameters import KnobLadder, Stated, study
from verification.credibility.refinement import Ladder, Level, elements, ladder
from verification.judging.invariants.influence import ConversionError, conversion_errors
from verification.problem.contact import CoatedContact
from verification.running.pool import Task
from verification.running.provenance import commit, versions
from verification.running.records import plain
from verification.running.store import StoreError, read_checked, write_checked

__all__ = [
    "CORRECTED",
    "PLAIN",
    "PROBLEM",
    "SCHEMA",
    "STAIRCASE",
    "AccuracyStudy",
    "failed",
    "from_json",
    "measure",
    "path_in",
    "stored",
    "task",
    "to_json",
]

SCHEMA = "coatcheck-accuracy/1"
CORRECTED = "split conversion, corrected edge"
STAIRCASE = "split conversion, staircase edge"
PLAIN = "plain conversion, staircase edge"
# Coarser grids have too few patches across the contact for its edge to be corrected.
FINE = (41, 49, 65, 97, 129, 257)
STEEL = (210e9, 0.3)
BARE = CoatedContact(10e-3, 20.0, (), STEEL)
COATED = CoatedContact(10e-3, 20.0, ((4 * STEEL[0], 0.3, BARE.a_h),), STEEL)
COST = 5.0  # of the whole study, over that of an uncoated contact
PROBLEM = "a sphere of 10 mm under 20 N on steel, bare or with a coating of E1/E2 = 4, h = a_h"


@dataclass(frozen=True)
class AccuracyStudy:
    """What was measured, in what was stood on; ``failures`` are the sentences of what could not be had.

    conversions, knobs, stated : of the coated solid.   commit : None outside a checkout.
    """

    ladders: tuple[Ladder, ...]
    conversions: tuple[ConversionError, ...]
    failures: tuple[str, ...]
    seconds: float
    commit: str | None
    versions: dict[str, str]
    knobs: tuple[KnobLadder, ...] = ()
    stated: tuple[Stated, ...] = ()


def measure() -> AccuracyStudy:
    """Every ladder, then the conversions; what fails is a sentence, and the rest goes on."""
    begin = time.perf_counter()
    ladders = [
        ladder(COATED, FINE, solid="coated", setting=CORRECTED),
        ladder(COATED, solid="coated", setting=STAIRCASE, edge_rounds=0),
        # Its convolution kernel alone costs more than the rest, so it ends one level earlier.
        ladder(COATED, (33, 65, 129), solid="coated", setting=PLAIN, edge_rounds=0, conversion="plain"),
        ladder(BARE, FINE, solid="uncoated", setting=CORRECTED),
        ladder(BARE, solid="uncoated", setting=STAIRCASE, edge_rounds=0),
        *(elements(COATED, order, solid="coated") for order in (2, 3, 4)),
    ]
    failures = [f"{one.method}, {one.solid}, {one.setting}, {one.failure}" for one in ladders if one.failure]
    conversions: tuple[ConversionError, ...] = ()
    try:
        conversions = conversion_errors(COATED)
    except Exception as error:  # as in a ladder: a sentence of the report, not a traceback
        failures.append(f"conversions of the influence coefficients: {' '.join(str(error).split())[:400]}")
    turned: tuple[KnobLadder, ...] = ()
    said: tuple[Stated, ...] = ()
    try:
        turned, said = study(COATED, "coated")
    except Exception as error:
        failures.append(f"uncertainty by knob: {' '.join(str(error).split())[:400]}")
    failures += [f"{one.method}, {one.knob}, {one.failure}" for one in turned if one.failure]
    seconds = time.perf_counter() - begin
    return AccuracyStudy(
        tuple(ladders), conversions, tuple(failures), seconds, commit(), versions(), turned, said
    )


def failed(reason: str, seconds: float) -> AccuracyStudy:
    """The study of a process that left nothing but the ``reason``."""
    return AccuracyStudy((), (), (reason,), seconds, commit(), versions())


def path_in(folder: Path) -> Path:
    """Where the study of a run directory lies."""
    return folder / "accuracy.json"


def stored(
    folder: Path, source: Callable[[], str | None] = commit, packages: Callable[[], dict[str, str]] = versions
) -> AccuracyStudy | None:
    """A whole earlier study without failures, of this very commit and these versions, or None.

    A tree that was changed since its commit (marked "+") may have changed again, so its study is not kept.
    Raises StoreError, naming the file, where there is one that is damaged.
    """
    path = path_in(folder)
    if not os.path.lexists(path):
        return None
    data = read_checked(path)
    try:
        found = from_json(data)
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise StoreError(f"{path}: not a study of this program ({error})") from None
    now = source()
    same = (found.commit, found.versions) == (now, packages()) and not (now or "").endswith("+")
    return found if same and not found.failures else None


def task(folder: Path) -> Task[AccuracyStudy]:
    """The study as a task beside the cases of a run."""
    path = path_in(folder)
    return Task(
        "accuracy study",
        ("verification.credibility.accuracy:main", str(path)),
        path,
        from_json,
        failed,
        cost=COST,
    )


def to_json(study: AccuracyStudy) -> dict[str, Any]:
    """Plain dictionaries, lists, numbers and text; NaN and infinity become text, so the JSON is strict."""
    return {"schema": SCHEMA, **plain(asdict(study))}


def from_json(data: dict[str, Any]) -> AccuracyStudy:
    """The inverse of ``to_json``. Raises ValueError where the schema is another one."""
    if data.get("schema") != SCHEMA:
        raise ValueError(f"schema = {data.get('schema')!r}; this version reads {SCHEMA!r}, run it again")
    return AccuracyStudy(
        ladders=tuple(
            Ladder(
                one["method"],
                one["solid"],
                one["setting"],
                tuple(
                    Level(
                        level["name"],
                        float(level["resolution"]),
                        float(level["seconds"]),
                        {name: float(error) for name, error in level["errors"].items()},
                    )
                    for level in one["levels"]
                ),
                one["failure"],
            )
            for one in data["ladders"]
        ),
        conversions=tuple(
            ConversionError(
                one["conversion"],
                int(one["enlarge"]),
                float(one["seconds"]),
                tuple(float(value) for value in one["distance"]),
                tuple(float(value) for value in one["error"]),
                float(one["largest"]),
                int(one["aliases"]),
            )
            for one in data["conversions"]
        ),
        failures=tuple(str(sentence) for sentence in data["failures"]),
        seconds=float(data["seconds"]),
        commit=data["commit"],
        versions={str(name): str(version) for name, version in data["versions"].items()},
        knobs=tuple(_knob_ladder(one) for one in data["knobs"]),
        stated=tuple(
            Stated(
                str(one["method"]),
                str(one["solid"]),
                {str(name): float(value) for name, value in one["uncertainty"].items()},
                tuple((str(q), str(k), float(v)) for q, k, v in one["budget"]),
                {str(name): float(value) for name, value in one["error"].items()},
            )
            for one in data["stated"]
        ),
    )


def _knob_ladder(one: dict[str, Any]) -> KnobLadder:
    return KnobLadder(
        str(one["method"]),
        str(one["solid"]),
        str(one["knob"]),
        float(one["order"]),
        tuple(str(name) for name in one["levels"]),
        tuple(float(step) for step in one["steps"]),
        {str(name): tuple(float(v) for v in values) for name, values in one["values"].items()},
        None if one["failure"] is None else str(one["failure"]),
    )


def main(path: str) -> None:
    """Measure and store at ``path``."""
    write_checked(Path(path), to_json(measure()))


if __name__ == "__main__":
    main(*sys.argv[1:])
