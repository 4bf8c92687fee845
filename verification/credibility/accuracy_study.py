"""The accuracy study of a default run: convergence on two solids of known solution, discs and ellipses."""

import time
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from verification.credibility.exact_errors import (
    ExactError,
    convolution_errors,
    disc_errors,
    film_errors,
    grid_ratios,
    iteration_counts,
    turned_ellipse,
)
from verification.credibility.refinement_studies import Refinement, refined_grid, refined_mesh
from verification.credibility.study_verdicts import CORRECTED, PLAIN, STAIRCASE, verdicts
from verification.judging.invariant_verdict import Invariant
from verification.problem.coated_contact import CoatedContact
from verification.running.case_result import message_of
from verification.running.checked_files import write_checked
from verification.running.json_records import RecordFile, decode
from verification.running.pool.pool_task import Task
from verification.running.provenance import fingerprint
from verification.sources.source_registry import solvers

SCHEMA = "coatcheck-accuracy/5"
# The error of the corrected edge is followed to the grid in use.
FINE = (41, 49, 65, 97, 129, 257)
STEEL = (210e9, 0.3)
BARE = CoatedContact(10e-3, 20.0, (), STEEL)
COATED = CoatedContact(10e-3, 20.0, ((4 * STEEL[0], 0.3, BARE.a_h),), STEEL)
FRICTION = 0.25
FILM = replace(COATED, coatings=((STEEL[0] / 10, 0.3, 0.3 * BARE.a_h),))  # whose edge needs many polynomials
COST = 7.0  # of the whole study, over that of an uncoated contact
PROBLEM = "a sphere of 10 mm under 20 N on steel, bare or with a coating of E1/E2 = 4, h = a_h"


@dataclass(frozen=True)
class AccuracyStudy:
    """Errors of both methods with provenance; ``failures`` are messages on what could not be computed.

    errors : of given pressures on discs, convolution, coefficients; of contacts that are no discs; iterations
    and grids of a disc.   made_by : fingerprint of the code.
    """

    refinements: tuple[Refinement, ...]
    failures: tuple[str, ...]
    seconds: float
    made_by: str
    errors: tuple[ExactError, ...] = ()

    @property
    def verdicts(self) -> tuple[Invariant, ...]:
        """Each part of the semi-analytical method beside its limit."""
        return verdicts(self.refinements, self.errors, self.failures)


def measure() -> AccuracyStudy:
    """Compute every part of the study; a part that fails leaves a message, the others are computed."""
    begin = time.perf_counter()
    failures: list[str] = []

    available = solvers(COATED)
    grid = partial(refined_grid, solve=available["semianalytic"])
    mesh = partial(refined_mesh, COATED, solid="coated", solve=available["fem_reference"])
    refinements = (
        grid(COATED, FINE, solid="coated", setting=CORRECTED),
        grid(FILM, (129,), solid="compliant film", setting=CORRECTED),
        grid(COATED, solid="coated", setting=STAIRCASE, edge_correction=False),
        # Its convolution kernel alone costs more than the rest, so it ends one level earlier.
        grid(COATED, (33, 65, 129), solid="coated", setting=PLAIN, edge_correction=False, conversion="plain"),
        grid(BARE, FINE, solid="uncoated", setting=CORRECTED),
        grid(BARE, solid="uncoated", setting=STAIRCASE, edge_correction=False),
        *(mesh(order) for order in (2, 3, 4)),
    )
    failures += [f"{r.method}, {r.solid}, {r.setting}, {r.failure}" for r in refinements if r.failure]
    errors: list[ExactError] = []
    for part, compute in {
        "discs": discs_of,
        "ellipses": lambda: [e for given in ("load", "approach") for e in turned_ellipse(BARE, given)],
        "iterations": lambda: iteration_counts(COATED, "coated"),
        "grids": lambda: grid_ratios(COATED, "coated"),
    }.items():
        try:
            errors += compute()
        except Exception as error:  # a message of the report, not a traceback
            failures.append(f"{part}: {message_of(error)}")
    seconds = time.perf_counter() - begin
    return AccuracyStudy(refinements, tuple(failures), seconds, fingerprint(), tuple(errors))


def discs_of() -> list[ExactError]:
    """Given pressures on both solids, Hertz's sliding on the coated one; DC-FFT; one patch of films."""
    found = disc_errors(COATED, "coated", FRICTION) + disc_errors(BARE, "uncoated", 0.0)
    return found + convolution_errors(COATED, "coated") + film_errors(COATED)


def failed(reason: str, seconds: float) -> AccuracyStudy:
    """The study of a process that left nothing but the ``reason``."""
    return AccuracyStudy((), (reason,), seconds, fingerprint())


def stored(folder: Path) -> AccuracyStudy | None:
    """The earlier study where it has no failures and is of this very code, or None.

    Raises StoreError, naming the file, where the study is damaged.
    """
    found = _FILE.read(folder)
    return found if found and not found.failures and found.made_by == fingerprint() else None


def task(folder: Path) -> Task[AccuracyStudy]:
    """The study as a task beside the cases of a run."""
    path = path_in(folder)
    return Task("accuracy study", partial(main, path), path, from_json, failed, cost=COST)


def from_json(data: dict[str, Any]) -> AccuracyStudy:
    """The inverse of ``to_json``. Raises ValueError for another schema or a field that does not fit."""
    if data.get("schema") != SCHEMA:
        raise ValueError(f"schema = {data.get('schema')!r}; this version reads {SCHEMA!r}, run it again")
    return decode(AccuracyStudy, data)


def main(path: Path) -> None:
    """Measure and store at ``path``."""
    write_checked(path, to_json(measure()))


_FILE = RecordFile(AccuracyStudy, "accuracy.json", (SCHEMA,), "an accuracy study", "measure it again")
path_in, to_json = _FILE.path_in, _FILE.to_json
