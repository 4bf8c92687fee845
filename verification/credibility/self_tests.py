"""Known answers put to the harness itself before its verdicts are believed.

Methods and references watch each other; nothing but this watches what reads the cases, samples the solutions,
judges and stores. Each self-test knows by hand what has to come out. All together take 0.1 s, so that
every run makes them.
"""

import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import combinations
from math import comb
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from verification.cases.contact import Case, parse_case
from verification.cases.published import PublishedCase, read_published
from verification.cases.table import FOLDER
from verification.judging.claims import standard_claims
from verification.judging.verdict import Outcome, Verdict, compare, judge
from verification.problem.arrays import Array
from verification.problem.contact import FLAT, CoatedContact, PrescribedLoad, Uncertainty
from verification.problem.profile import Profile, line_of, lines_of
from verification.running.contact import judge_case, solve_case
from verification.running.provenance import fingerprint
from verification.running.records import plain
from verification.running.result import CaseResult, describe, from_json, to_json
from verification.running.store import StoreError, read_checked, write_checked
from verification.running.tasks import kept_result, result_path
from verification.sampling.lines import sample, sample_contact
from verification.sources.references.hertz import Hertz
from verification.sources.registry import REFERENCES, sources_of

__all__ = ["SelfTest", "self_tests"]

Answers = Iterator[tuple[str, Any, Any]]  # what was asked, what came out, what had to


@dataclass(frozen=True)
class SelfTest:
    """``name`` of a part of the harness, the ``statement`` that must hold, what was ``found``.

    answers : number of known answers that it gave.
    """

    name: str
    statement: str
    passed: bool
    found: str
    answers: int = 0


def self_tests() -> tuple[SelfTest, ...]:
    """All of them, in the order in which a case runs through the harness."""
    return tuple(_tried(name, statement, ask) for name, statement, ask in _TESTS)


def _tried(name: str, statement: str, ask: Callable[[], Answers]) -> SelfTest:
    asked = 0
    try:
        for what, found, wanted in ask():
            asked += 1
            same = (
                np.isclose(found, wanted, rtol=1e-9, atol=0) if isinstance(wanted, float) else found == wanted
            )
            if not same:
                found = f"{what}: {found}, where it has to be {wanted}"
                return SelfTest(name, statement, False, found, asked)
    except Exception as error:  # whatever a part of the harness fails with is the answer
        return SelfTest(
            name, statement, False, f"{type(error).__name__}: {' '.join(str(error).split())[:300]}", asked
        )
    return SelfTest(name, statement, True, f"{asked} known answers", asked)


def _of_case_file() -> Answers:
    text = (
        b'title = "known"\n[problem]\nradius = 10e-3\nload = 40.0\nfriction = 0.25\n'
        b"substrate = { E = 300e9, nu = 0.0 }\n"
        b"[[problem.coatings]]\nE = 600e9\nnu = 0.25\nthickness_over_a_h = 0.5\n"
        b"[[problem.coatings]]\nE = 150e9\nnu = 0.4\nthickness = 20e-6\n"
    )
    problem = parse_case(text, Path("known.toml")).problem
    # nu = 0: a_h^3 = 3 W R / 4 E = 1e-12 m^3
    yield "a_h", problem.a_h, 1e-4
    yield "p_h", problem.p_h, 6e9 / np.pi
    yield "delta_h", problem.delta_h, 1e-6
    yield "coatings", problem.coatings[1], (150e9, 0.4, 20e-6)
    yield "first coating", problem.coatings[0][:2], (600e9, 0.25)
    yield "thickness of half an a_h", problem.coatings[0][2], 5e-5
    yield "lower interface", problem.interfaces[1], 7e-5
    yield "friction", problem.friction, 0.25
    pairs = [claim.between for claim in standard_claims(problem) if claim.line == "interface 2, lower side"]
    yield "pairs of sources on the lowest line", len(set(pairs)), 3


def _of_printed_table() -> Answers:
    case = read_published(FOLDER / "kenpave_three_layer_axis.toml")
    inch, psi = 0.0254, 4.4482216152605 / 0.0254**2
    column = {(p.profile.quantity, p.column): p for p in case.columns}
    stress = column["sigma_zz", "Vertical_Stress"]
    assert stress.profile.uncertainty is not None
    yield "a compression of 84.247 psi", float(stress.profile.value[2]), -84.247 * psi
    yield "at 2 in", float(stress.profile.position[2]), 2 * inch
    yield "half of its last digit", float(stress.profile.uncertainty[2]), 0.0005 * psi
    yield "corrected by its departure", float(stress.reference.value[2]), -(84.247 - 0.01184) * psi
    yield "values that count beside 8 departures", int(stress.counted.sum()), 22
    radial = column["sigma_xx", "Radial_stress"].profile
    yield "radial compression of 88.377 psi", float(radial.value[2]), -88.377 * psi
    yield "sinking by 0.02246 in", float(column["u_z", "Displacement"].profile.value[2]), 0.02246 * inch
    strain = column["eps_xx", "Radial_strain"].profile
    assert strain.uncertainty is not None
    yield "radial strain", float(strain.value[2]), -5.592e-5
    yield "half of its fourth digit", float(strain.uncertainty[2]), 0.5e-8
    yield "coatings", case.problem.coatings[0][2], 6 * inch


def _of_sampling() -> Answers:
    problem = CoatedContact(1e-2, 40.0, ((6e11, 0.25, 5e-5),), (3e11, 0.0), 0.25)
    solution = _Labelled()
    scalars = {p.quantity: p for p in sample_contact(solution, "known", problem)}  # type: ignore[arg-type]
    for name, value, U in (
        ("peak_pressure", 3e9, 2e6),
        ("contact_radius", 1e-4, 3e-9),
        ("approach", 1e-6, 4e-12),
        ("stiffness", 6e7, 5e1),
    ):
        yield name, float(scalars[name].value[0]), value
        yield f"uncertainty of the {name}", float(scalars[name].uncertainty[0]), U  # type: ignore[index]
    along = np.array([1e-5, 3e-5])
    layers = {"surface": 0, "axis": None, "interface 1, upper side": 0, "interface 1, lower side": 1}
    depths = {"surface": 0.0, "interface 1, upper side": 5e-5, "interface 1, lower side": 5e-5}
    for line in lines_of(problem):
        place = np.array([2e-5, 4e-5]) if line.name == "axis" else along
        for profile in sample(solution, "known", line, place):  # type: ignore[arg-type]
            if profile.quantity == "pressure":
                yield "pressure", tuple(profile.value), tuple(solution.pressure(along))
                continue
            i, j = ("xyz".index(letter) for letter in profile.quantity[-2:])
            x, z = (0.0, place[1]) if line.name == "axis" else (place[1], depths[line.name])
            wanted = _labelled(i, j, x, z, layers[line.name])
            yield f"{profile.quantity} on the {line.name}", float(profile.value[1]), wanted
            spread = profile.uncertainty
            yield "its uncertainty", None if spread is None else float(spread[1]), 1e-3 * wanted
    # by hand: a_h = 1e-4 m; the line, its layer, the second point
    for name, layer, point in (
        ("off plane", 0, (3e-5, 4e-5, 2.5e-5)),
        ("oblique", None, (-9e-5 + 1.44e-5, -2e-5 + 1.08e-5, 2.4e-5)),
        ("oblique surface", 0, (3e-5 * 0.75**0.5, 1.5e-5, 0.0)),
    ):
        for profile in sample(solution, "known", line_of(name, problem), along):  # type: ignore[arg-type]
            if profile.quantity.startswith("u_"):
                wanted = _moved("xyz".index(profile.quantity[-1]), *point)
            else:
                i, j = ("xyz".index(letter) for letter in profile.quantity[-2:])
                wanted = _labelled(i, j, point[0], point[2], layer, point[1])
            yield f"{profile.quantity} on the line {name}", float(profile.value[1]), wanted
            spread = profile.uncertainty
            yield "its uncertainty", None if spread is None else float(spread[1]), 1e-3 * wanted


def _of_judging() -> Answers:
    def outcome(
        a: float, b: float, U_a: float | None = 1e6, U_b: float | None = 1e6, cap: float = 0.01
    ) -> Outcome:
        sides = [_known(value, U, str(value)) for value, U in ((a, U_a), (b, U_b))]
        return judge(compare(*sides, scale=1e9), cap).outcome

    yield "a difference within U", outcome(1e9, 1.0015e9), Outcome.AGREES
    yield "the same downwards", outcome(1.0015e9, 1e9), Outcome.AGREES
    yield "a difference beyond U", outcome(1e9, 1.0025e9), Outcome.DISAGREES
    yield "the same downwards", outcome(1.0025e9, 1e9), Outcome.DISAGREES
    yield "U beyond the cap", outcome(1e9, 1e9, 6e6, 6e6), Outcome.INCONCLUSIVE
    yield "a large difference below a U beyond the cap", outcome(1e9, 1.05e9, 6e7, 6e7), Outcome.INCONCLUSIVE
    yield "no U, a small difference", outcome(1e9, 1.001e9, None), Outcome.INCONCLUSIVE
    yield "no U, a difference beyond the cap", outcome(1e9, 1.02e9, None), Outcome.DISAGREES
    for bad in (np.nan, np.inf, -np.inf):
        yield f"{bad} on one side", outcome(bad, 1e9), Outcome.NO_RESULT
        yield f"{bad} on the other", outcome(1e9, bad), Outcome.NO_RESULT
        yield f"{bad} as U", outcome(1e9, 1e9, 1e6, bad), Outcome.NO_RESULT
    yield "a negative U", outcome(1e9, 1e9, -1e6), Outcome.NO_RESULT
    verdict = judge(compare(_known(1e9, 1e6), _known(1.003e9, 1e6), scale=1e9), 0.01)
    yield "difference over the scale", verdict.difference, 3e-3
    yield "uncertainty over the scale", verdict.uncertainty, 2e-3
    yield "margin over the scale", verdict.margin, -1e-3


def _of_points() -> Answers:
    x = np.linspace(-1.0, 1.0, 101)
    flat, spoiled = np.ones(101), np.ones(101)
    spoiled[70] += 0.3
    a, b = (Profile("q", "l", x, value, "s", np.full(101, 0.1)) for value in (flat, spoiled))
    yield "one bad point of 101", judge(compare(a, b, scale=1.0), 1.0).outcome, Outcome.DISAGREES
    yield "its place", judge(compare(a, b, scale=1.0), 1.0).worst, float(x[70])
    here = np.abs(x - x[70]) < 1e-9
    yield "without it", judge(compare(a, b, scale=1.0, excluded=here), 1.0).outcome, Outcome.AGREES
    yield "with it alone", judge(compare(a, b, scale=1.0, excluded=~here), 1.0).outcome, Outcome.DISAGREES
    nothing = np.ones(101, dtype=bool)
    yield "without any", judge(compare(a, b, scale=1.0, excluded=nothing), 1.0).outcome, Outcome.NO_RESULT
    elsewhere = replace(b, position=x + 1e-3)
    try:
        compare(a, elsewhere, scale=1.0)
        yield "profiles at other points", "compared", "refused"
    except ValueError:
        yield "profiles at other points", "refused", "refused"


def _of_runs() -> Answers:
    """Whole runs of an uncoated case by closed forms that stand in for the methods."""

    bare = CoatedContact(1e-2, 40.0, (), (3e11, 0.3))
    references = tuple(name for name in sources_of(bare) if name in REFERENCES)

    def came_to(**methods: Any) -> tuple[Outcome, CaseResult]:
        claims = tuple(replace(claim, cap=0.01) for claim in standard_claims(bare))
        case = Case("known", "known", bare, claims)
        hertz = Hertz(1e-2, 40.0, 3e11, 0.3)
        said = {name: (lambda p, _, s=hertz: s) for name in references}
        made = {name: (lambda p, _, s=solution: s) for name, solution in methods.items()}
        # without the invariants, which look at each method by itself
        result = judge_case(case, solve_case(case, made | said), invariants=False)
        return result.outcome, result

    true, loaded = _Stated(1e-2, 40.0, 3e11, 0.3), _Stated(1e-2, 40.2, 3e11, 0.3)
    outcome, result = came_to(semianalytic=true, fem_reference=true)
    yield "two honest methods", outcome, Outcome.AGREES
    sources = len(references) + 2
    yield "pairs compared", len({claim.between for claim, _ in result.verdicts}), comb(sources, 2)
    yield (
        "a load off by half a per cent",
        came_to(semianalytic=loaded, fem_reference=true)[0],
        Outcome.DISAGREES,
    )
    yield "the same in the other", came_to(semianalytic=true, fem_reference=loaded)[0], Outcome.DISAGREES
    both, result = came_to(semianalytic=loaded, fem_reference=loaded)
    yield "the same in both", both, Outcome.DISAGREES
    agreeing = {c.between for c, v in result.verdicts if v.outcome is Outcome.AGREES and c.line == "contact"}
    still = {("semianalytic", "fem_reference"), *combinations(references, 2)}
    yield "pairs that still agree", agreeing, still
    nowhere = came_to(semianalytic=true, fem_reference=_Failing(1e-2, 40.0, 3e11, 0.3))[0]
    yield "a method without stresses", nowhere, Outcome.NO_RESULT
    yield "a method that was not asked", came_to(semianalytic=true)[0], Outcome.NO_RESULT
    vague = came_to(semianalytic=true, fem_reference=replace(true, share=0.02))[0]
    yield "a method with a vague U", vague, Outcome.INCONCLUSIVE
    for at, wanted in ((0.5, Outcome.DISAGREES), (0.9, Outcome.DISAGREES), (1.1, Outcome.DISAGREES)):
        spoiled = came_to(semianalytic=true, fem_reference=_Spoiled(1e-2, 40.0, 3e11, 0.3, at=at))[0]
        yield f"a pressure that is off at {at} a", spoiled, wanted
    spoiled = came_to(semianalytic=true, fem_reference=_Spoiled(1e-2, 40.0, 3e11, 0.3, at=1.0))[0]
    yield "a pressure that is off at the edge alone", spoiled, Outcome.DISAGREES


def _of_store() -> Answers:
    case = read_published(FOLDER / "kenpave_three_layer_axis.toml")
    assert isinstance(case.problem, PrescribedLoad)
    profile = Profile("q", "l", np.array([0.1]), np.array([np.pi]), "s", np.array([np.nan]))
    verdicts = ((case.claims[0], Verdict(Outcome.AGREES, "known")),)
    said = plain(describe(case.problem))
    result = CaseResult(case.name, "known", "", said, (), (profile,), verdicts, 1.0, text=case.text)
    with tempfile.TemporaryDirectory(prefix="coatcheck-") as name:
        folder = Path(name)
        path = result_path(folder, case)

        def kept(of: PublishedCase) -> str:
            try:
                return "used again" if kept_result(folder, of) else "computed again"
            except StoreError:
                return "refused"

        yield "a result that is not there", kept(case), "computed again"
        write_checked(path, to_json(result) | {"made_by": fingerprint()})
        back = from_json(read_checked(path))
        spread = back.profiles[0].uncertainty
        yield "a number after storing", float(back.profiles[0].value[0]), float(np.pi)
        yield "a missing number after storing", spread is not None and bool(np.isnan(spread[0])), True
        yield "a result of this input", kept(case), "used again"
        yield "a result of another input", kept(replace(case, text="another input")), "refused"
        other = replace(case.problem, friction=0.1)
        yield "a result of another problem", kept(replace(case, problem=other)), "refused"
        raw = path.read_bytes()
        path.write_bytes(raw.replace(b"3.14159", b"3.14158"))
        yield "a result with a changed digit", kept(case), "refused"
        path.write_bytes(raw[: len(raw) // 2])
        yield "half a result", kept(case), "refused"
        write_checked(path, to_json(result) | {"made_by": "another version"})
        yield "a result of another version", kept(case), "refused"


_TESTS: tuple[tuple[str, str, Callable[[], Answers]], ...] = (
    ("case file", "a case file means the lengths, moduli, scales worked out by hand", _of_case_file),
    ("printed table", "a printed table means the SI values, signs worked out by hand", _of_printed_table),
    ("sampling", "every profile holds its own component, side, coordinate, uncertainty", _of_sampling),
    ("judging", "differences, uncertainties, caps of every kind get the verdict they must", _of_judging),
    ("judged points", "one bad point decides, and only points that count", _of_points),
    ("whole runs", "runs with a method known to be right, off, vague, dead come out so", _of_runs),
    ("storing", "what is stored comes back to the last digit or not at all", _of_store),
)


def _known(value: float, U: float | None, source: str = "known") -> Profile:
    spread = None if U is None else np.array([1e5, U])
    return Profile("q", "l", np.array([0.0, 1.0]), np.array([1e9, value]), source, spread)


def _labelled(i: int, j: int, x: float, z: float, layer: int | None, y: float = 0.0) -> float:
    """A stress that tells its component, place and layer."""
    low, high = sorted((i, j))
    place = 1e9 * x + 3e9 * z + 7e9 * y
    return float(1e6 * (1 + 3 * low + high) + place + 1e7 * (-1 if layer is None else layer))


def _moved(i: int, x: float, y: float, z: float) -> float:
    """A displacement that tells its component and place."""
    return float(1e-7 * (1 + i) + 1e-3 * x + 3e-3 * z + 7e-3 * y)


class _Labelled:
    """A solution whose every number says what it is."""

    contact_radius, approach, peak_pressure = 1e-4, 1e-6, 3e9
    stiffness, stiffness_uncertainty = 6e7, 5e1
    uncertainty = Uncertainty(3e-9, 4e-12, 2e6)

    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        return 1e9 + 1e12 * np.asarray(x, dtype=float)

    def pressure_uncertainty(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        return 1e-3 * self.pressure(x)

    def stress(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None) -> Array:
        x, y, z = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (x, y, z)))
        at = [
            [[_labelled(i, j, a, c, layer, b) for a, b, c in zip(x, y, z, strict=True)] for j in range(3)]
            for i in range(3)
        ]
        return np.array(at)

    def stress_uncertainty(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None) -> Array:
        return 1e-3 * self.stress(x, y, z, layer)

    def displacement(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        points = zip(*np.broadcast_arrays(x, y, z), strict=True)
        return np.array([[_moved(i, *map(float, point)) for i in range(3)] for point in points]).T

    def displacement_uncertainty(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        return 1e-3 * self.displacement(x, y, z)


@dataclass(frozen=True)
class _Stated(Hertz):
    """Hertz with an uncertainty, ``share`` of each number."""

    share: float = 1e-4

    @property
    def uncertainty(self) -> Uncertainty:
        share = self.share
        return Uncertainty(share * self.contact_radius, share * self.approach, share * self.peak_pressure)

    def pressure_uncertainty(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        return np.full(np.broadcast_shapes(np.shape(x), np.shape(y)), self.share * self.peak_pressure)

    def stress_uncertainty(
        self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None, body: str = FLAT
    ) -> Array:
        shape = np.broadcast_shapes(np.shape(x), np.shape(y), np.shape(z))
        return np.full((3, 3, *shape), self.share * self.peak_pressure)

    def displacement_uncertainty(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, body: str = FLAT) -> Array:
        shape = np.broadcast_shapes(np.shape(x), np.shape(y), np.shape(z))
        return np.full((3, *shape), self.share * self.approach)

    @property
    def stiffness_uncertainty(self) -> float:
        return self.share * self.stiffness


@dataclass(frozen=True)
class _Spoiled(_Stated):
    """A pressure that is 1 % of its peak too large around the radius ``at`` [a]."""

    at: float = 0.0

    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        near = np.abs(np.hypot(x, y) / self.contact_radius - self.at) < 0.03
        return super().pressure(x, y) + np.where(near, 0.01 * self.peak_pressure, 0.0)


class _Failing(_Stated):
    """A method that has a contact but no stresses."""

    def stress(
        self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None, body: str = FLAT
    ) -> Array:
        raise ValueError("no stresses today")
