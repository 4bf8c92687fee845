"""Examination of a guest on one case: the exact reference, then the question in the units of the guest."""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from verification.guests.exam_subjects import SquareLoad, Subject, exact_radius, reference_of
from verification.guests.guest_description import Guest
from verification.guests.guest_protocol import (
    DiscProblem,
    EllipsoidProblem,
    GuestAnswer,
    GuestBall,
    Layer,
    LineOfPoints,
    Problem,
    Question,
    SphereProblem,
    SquareProblem,
)
from verification.judging.verdict import Claim
from verification.problem.array_types import Coatings
from verification.problem.coated_contact import CoatedContact
from verification.problem.evaluation_points import layer_at
from verification.problem.line_profile import Profile
from verification.problem.quantity import unit_of
from verification.running.case_result import CaseResult, SourceResult
from verification.running.checked_files import StoreError
from verification.running.pool.pool_task import Task
from verification.running.stored_run import read_stored, result_of, write_result

ALONG_SURFACE = ("surface", "oblique surface")  # lines that cross the contact edge


def prepare(case: Subject, path: Path) -> None:
    """Solve ``case`` exactly, sample it on its lines, store it at ``path``."""
    source = SourceResult(reference_of(case.problem), 0.0)
    write_result(path, CaseResult.of(case, sources=(source,), profiles=case.exact()))


def exam_path(folder: Path, case: Subject) -> Path:
    """Path of the exact reference of ``case`` in a run directory."""
    return folder / "problems" / f"{case.name}.json"


def exam_task(case: Subject, folder: Path) -> Task[CaseResult]:
    """Solving ``case`` exactly: a result without verdicts, its profiles at the points required of guests."""
    path, cost = exam_path(folder, case), 1.0 + len(case.problem.coatings)
    failed = partial(CaseResult.failed, case)
    return Task(case.name, partial(prepare, case, path), path, partial(result_of, case), failed, cost=cost)


def kept_exam(folder: Path, case: Subject) -> CaseResult | None:
    """The exact reference of an earlier run, where it is of the same case file and code."""
    try:
        result = read_stored(exam_path(folder, case), case)
    except StoreError:
        return None
    return result if result.profiles else None


def claims_of(case: Subject, guest: Guest) -> tuple[Claim, ...]:
    """The claims of ``case`` as claims about the guest; the cap is what it claims, where this is more."""
    between = (guest.name, reference_of(case.problem))
    return tuple(
        replace(
            claim,
            between=between,
            cap=max(claim.cap, guest.claim or 0.0),
            edge=max(claim.edge, guest.edge) if claim.line in ALONG_SURFACE else claim.edge,
        )
        for claim in case.claims
    )


def question_of(
    case: Subject, exam: CaseResult, guest: Guest, claims: tuple[Claim, ...], parameter: dict[str, float]
) -> Question:
    """The question about ``case`` in the units of ``guest``, at the points of ``exam``.

    Only quantities of ``claims`` that the guest gives by its own statement are wanted.
    """
    m = guest.factor("m")
    wanted: dict[str, list[str]] = {}
    for claim in claims:
        if guest.lack(claim.quantity) is None:
            wanted.setdefault(claim.line, []).append(claim.quantity)
    lines = []
    for name, quantities in wanted.items():
        if name == "contact":
            continue
        line = case.line(name)
        along = next(p.position for p in exam.profiles if p.line == name)
        x, y, z = line.points(along)
        layers = layer_at(z, case.problem.seen_from(line.body).coatings, line.layer)
        points: dict[str, Any] = {"x": x / m, "y": y / m, "z": z / m, "layer": layers}
        at = {name: v.tolist() for name, v in points.items()}
        lines.append(LineOfPoints(line=name, body=line.body, quantities=quantities, **at))

    level = "".join(f"@{name}={value:g}" for name, value in parameter.items())
    return Question(
        id=f"{case.name}{level}",
        problem=_in_units(case, guest),
        parameter=dict(parameter),
        contact=wanted.get("contact", []),
        lines=lines,
        edge=exact_radius(exam) / m,
        units=guest.units.model_dump(),
    )


def _in_units(case: Subject, guest: Guest) -> Problem:
    """The problem of ``case`` in the units of ``guest``."""
    problem = case.loaded
    m, Pa, N = (guest.factor(unit) for unit in ("m", "Pa", "N"))

    def materials(coatings: Coatings) -> list[Layer]:
        return [Layer(E=E / Pa, nu=nu, thickness=h / m) for E, nu, h in coatings]

    E, nu = problem.substrate
    solid: dict[str, Any] = {"coatings": materials(problem.coatings), "substrate": Layer(E=E / Pa, nu=nu)}
    if isinstance(problem, SquareLoad):
        return SquareProblem(side=problem.side / m, pressure=problem.pressure / Pa, **solid)
    if not isinstance(problem, CoatedContact):
        return DiscProblem(load_radius=problem.load_radius / m, pressure=problem.pressure / Pa, **solid)
    solid |= {"load": problem.load / N, "friction": problem.friction}
    if problem.indenter is not None:
        along, across = problem.indenter[1]
        return EllipsoidProblem(radius_x=along / m, radius_y=across / m, **solid)
    ball = problem.ball and GuestBall(
        E=problem.ball[0] / Pa, nu=problem.ball[1], coatings=materials(problem.ball[2])
    )
    return SphereProblem(radius=problem.radius / m, ball=ball, **solid)


def profiles_of(answer: GuestAnswer, exam: CaseResult, guest: Guest) -> tuple[Profile, ...]:
    """Values and uncertainties of ``answer``, in the units of ``guest``, as profiles in SI."""
    places = {p.line: p.position for p in exam.profiles}
    found = []
    for line, numbers in (answer.values or {}).items():
        for quantity, value in numbers.items():
            factor = guest.factor(unit_of(quantity))
            stated = answer.uncertainty.get(line, {}).get(quantity)
            U = None if stated is None else factor * np.atleast_1d(np.asarray(stated, dtype=float))
            SI = factor * np.atleast_1d(np.asarray(value, dtype=float))
            found.append(Profile(quantity, line, places[line], SI, guest.name, U))
    return tuple(found)
