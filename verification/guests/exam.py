"""Examination of a guest on one case: the exact reference, then the question in the units of the guest."""

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from verification.cases.contact import Case, parse_case
from verification.guests.description import Guest
from verification.guests.protocol import Answer, ElasticBall, Layer, LineOfPoints, Question, Sphere
from verification.judging.verdict import Claim
from verification.problem.arrays import Coatings
from verification.problem.geometry import layer_at
from verification.problem.profile import Profile, line_of
from verification.problem.quantity import unit_of
from verification.running.contact import failed
from verification.running.pool import Task
from verification.running.provenance import fingerprint
from verification.running.records import plain
from verification.running.result import CaseResult, SourceResult, describe, from_json, to_json
from verification.running.store import StoreError, read_checked, write_checked
from verification.sampling.lines import positions, sample, sample_contact
from verification.sources.exact import solve_exactly
from verification.sources.registry import EXACT

REFERENCE = EXACT[0]
# Claims of a case are about pairs of sources; those of the first method are the ones that a guest meets.
ALONG_SURFACE = ("surface", "oblique surface")  # lines that cross the contact edge
PATTERN = ("semianalytic", REFERENCE)


@dataclass(frozen=True, eq=False)
class Exam:
    """The exact reference of a case as a ``result`` without verdicts; without profiles where it failed."""

    result: CaseResult


def prepare(name: str, text: str, path: str) -> None:
    """Solve the case file ``text`` exactly, sample it on its lines, store it at ``path``."""
    case = parse_case(text.encode(), Path(f"{name}.toml"))
    solution = solve_exactly(case.problem)
    places = positions(case.problem, case.lines, {REFERENCE: solution})
    profiles = list(sample_contact(solution, REFERENCE, case.problem))
    for line in case.lines:
        profiles += sample(solution, REFERENCE, line, places[line], case.problem)
    result = CaseResult(
        name=case.name,
        title=case.title,
        source=case.source,
        problem=describe(case.problem),
        sources=(SourceResult(REFERENCE, 0.0),),
        profiles=tuple(profiles),
        verdicts=(),
        seconds=0.0,
        text=case.text,
    )
    write_checked(Path(path), to_json(result) | {"made_by": fingerprint()})


def exam_path(folder: Path, case: Case) -> Path:
    """Where the exact reference of ``case`` lies in a run directory."""
    return folder / "problems" / f"{case.name}.json"


def exam_task(case: Case, folder: Path) -> Task[Exam]:
    """Solving ``case`` exactly; its profiles at the points required of every guest."""
    path = exam_path(folder, case)
    words = ("verification.guests.exam:prepare", case.name, case.text, str(path))
    cost = 1.0 + len(case.problem.coatings)
    return Task(case.name, words, path, lambda data: Exam(from_json(data)), partial(_failed, case), cost=cost)


def _failed(case: Case, reason: str, seconds: float) -> Exam:
    return Exam(failed(case, reason, seconds))


def kept_exam(folder: Path, case: Case) -> CaseResult | None:
    """The exact reference of an earlier run, where it is of the same case file and code."""
    try:
        data = read_checked(exam_path(folder, case))
        result = from_json(data)
    except (StoreError, ValueError):
        return None
    same = result.text == case.text and result.problem == plain(describe(case.problem))
    return result if same and data.get("made_by") == fingerprint() and result.profiles else None


def claims_of(case: Case, guest: Guest) -> tuple[Claim, ...]:
    """The claims of ``case`` about the exact reference, as claims about the guest.

    The cap is that of the case, or what the guest claims, where this is more.
    """
    found = [claim for claim in case.claims if claim.between == PATTERN]
    return tuple(
        Claim(
            claim.quantity,
            claim.line,
            (guest.name, REFERENCE),
            max(claim.cap, guest.claim or 0.0),
            claim.why,
            max(claim.edge, guest.edge) if claim.line in ALONG_SURFACE else claim.edge,
        )
        for claim in found
    )


def question_of(
    case: Case, exam: CaseResult, guest: Guest, claims: tuple[Claim, ...], parameter: dict[str, float]
) -> Question:
    """The question about ``case`` in the units of ``guest``, at the points of ``exam``.

    Only quantities of ``claims`` that the guest gives by its own statement are wanted.
    """
    problem = case.problem
    m, Pa, N = (guest.factor(unit) for unit in ("m", "Pa", "N"))
    wanted: dict[str, list[str]] = {}
    for claim in claims:
        if guest.gives(claim.quantity):
            wanted.setdefault(claim.line, []).append(claim.quantity)
    lines = []
    for name, quantities in wanted.items():
        if name == "contact":
            continue
        line = line_of(name, problem)
        along = next(p.position for p in exam.profiles if p.line == name)
        x, y, z = line.points(along)
        layers = layer_at(z, problem.seen_from(line.body).coatings, line.layer)
        points: dict[str, Any] = {"x": x / m, "y": y / m, "z": z / m, "layer": layers}
        at = {name: v.tolist() for name, v in points.items()}
        lines.append(LineOfPoints(line=name, body=line.body, quantities=quantities, **at))

    def materials(coatings: Coatings) -> list[Layer]:
        return [Layer(E=E / Pa, nu=nu, thickness=h / m) for E, nu, h in coatings]

    E, nu = problem.substrate
    ball = problem.ball and ElasticBall(
        E=problem.ball[0] / Pa, nu=problem.ball[1], coatings=materials(problem.ball[2])
    )
    sphere = Sphere(
        radius=problem.radius / m,
        load=problem.load / N,
        friction=problem.friction,
        coatings=materials(problem.coatings),
        substrate=Layer(E=E / Pa, nu=nu),
        ball=ball,
    )
    level = "".join(f"@{name}={value:g}" for name, value in parameter.items())
    return Question(
        id=f"{case.name}{level}",
        problem=sphere,
        parameter=dict(parameter),
        contact=wanted.get("contact", []),
        lines=lines,
    )


def profiles_of(answer: Answer, exam: CaseResult, guest: Guest) -> tuple[Profile, ...]:
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
