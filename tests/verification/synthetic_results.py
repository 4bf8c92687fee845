"""Case results made up from Hertz's closed forms with errors of known size, for tests of the report."""

from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from verification.judging.standard_claims import standard_claims
from verification.judging.verdict import Outcome, Verdict
from verification.problem.coated_contact import CoatedContact
from verification.problem.line_profile import Profile, lines_of, oblique_lines
from verification.problem.quantity import (
    DISPLACEMENTS,
    IN_PLANE,
    PEAKS,
    QUANTITIES,
    SCALARS,
    SLOPES,
    STRESSES,
)
from verification.report.report_material import ReportMaterial
from verification.report.report_page import report_json
from verification.running.case_result import CaseResult, RunInfo, SourceResult, describe, to_json
from verification.running.checked_files import write_checked
from verification.running.contact_run import decide
from verification.sources.source_registry import CLOSED, METHODS, SOURCES

STEEL = (210e9, 0.3)
INFO = RunInfo(
    command="coatcheck run",
    started="2026-11-21T08:00:00+00:00",
    seconds=141.2,
    jobs=2,
    commit="a28aa40c1d2e",
    machine="2 cores, Linux 6.1, x86_64",
    versions={"coatcheck": "0.1.0", "python": "3.11.9", "numpy": "2.4.0", "scipy": "1.17.0"},
)
# Relative errors that the made-up methods have, and the uncertainty they state, as multiples of it.
ERRORS = {name: 0.0 if name in CLOSED else 1e-10 for name in SOURCES}
ERRORS |= {"semianalytic": 1.5e-5, "fem_reference": 1.2e-6}
STATED = 2.5
BUDGET = {"patch or element size": 1.9, "conversion or order": 0.5, "domain": 0.1}  # of the error


def contact(*coatings: tuple[float, float, float], substrate=STEEL, friction: float = 0.0) -> CoatedContact:
    """A 10 mm sphere under 20 N; thicknesses are given in a_h of the bare substrate."""
    bare = CoatedContact(10e-3, 20.0, (), substrate)
    layers = tuple((E, nu, h * bare.a_h) for E, nu, h in coatings)
    return CoatedContact(10e-3, 20.0, layers, substrate, friction)


def run_directory(folder: Path, results: Sequence[CaseResult]) -> None:
    """What a run leaves: the report with a checked file beside it for each case."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "report.json").write_text(report_json(ReportMaterial(results, INFO)))
    for result in results:
        write_checked(folder / "cases" / f"{result.name}.json", to_json(result))


def result_of(
    problem: CoatedContact,
    *,
    name: str = "stiff_coating",
    title: str = "Stiff coating, E1/E2 = 2, h = a_h",
    errors: dict[str, float] | None = None,
    failures: dict[str, str] | None = None,
    spoil: dict[tuple[str, str, str], float] | None = None,
    stated: dict[str, float | None] | None = None,
    points: int = 129,
    text: str = "",
) -> CaseResult:
    """A case whose sources scatter about one closed form.

    errors, stated : as ERRORS and STATED, by source; a stated None is an uncertainty not stated.
    spoil : (quantity, line, source) -> number put into the middle of that profile, NaN for instance.
    """
    errors = {**ERRORS, **(errors or {})}
    stated = {**dict.fromkeys(errors, STATED), **(stated or {})}
    failures, spoil = failures or {}, spoil or {}
    claims = standard_claims(problem)
    names = list(dict.fromkeys(source for claim in claims for source in claim.between))
    profiles: dict[tuple[str, str, str], Profile] = {}
    for source in names:
        if source in failures:
            continue
        random = np.random.default_rng([ord(letter) for letter in source])
        for profile in _exact(problem, source, points):
            scale = np.abs(profile.value) if profile.line == "contact" else problem.p_h
            if profile.quantity in DISPLACEMENTS:
                scale = problem.delta_h
            if profile.quantity in DISPLACEMENTS + SLOPES:  # as their caps
                scale = 0.01 * scale
            noise = errors[source] * scale * random.uniform(-1, 1, profile.value.shape)
            value = profile.value + noise
            key = (profile.quantity, profile.line, source)
            if key in spoil:
                value[value.size // 2] = spoil[key]
            factor = stated[source]
            spread = None if factor is None else factor * errors[source] * scale * np.ones(value.shape)
            profiles[key] = Profile(profile.quantity, profile.line, profile.position, value, source, spread)
    sources = tuple(
        SourceResult(
            source,
            0.7 + number,
            failures.get(source),
            {"iterations": 31, "residual": 3.2e-11, "history": [10.0**-n for n in range(12)]},
            tuple(
                (name, setting, share * errors[source] * getattr(problem, QUANTITIES[name].scale))
                for name in SCALARS
                for setting, share in BUDGET.items()
                if source in METHODS
            ),
        )
        for number, source in enumerate(names)
    )
    outcomes = {source.source: source for source in sources}
    with np.errstate(invalid="ignore"):
        verdicts = tuple((claim, decide(claim, profiles, outcomes, problem)) for claim in claims)
    return CaseResult(
        name=name,
        title=title,
        source="O'Sullivan and King, J. Tribol. 110 (1988) 235-240",
        problem=describe(problem),
        sources=sources,
        profiles=tuple(profiles.values()),
        verdicts=verdicts,
        seconds=3.4,
        text=text,
    )


def crashed(problem: CoatedContact, name: str, reason: str) -> CaseResult:
    """A case whose process died before it had anything to show."""
    verdicts = tuple((claim, Verdict(Outcome.NO_RESULT, reason)) for claim in standard_claims(problem))
    source = (SourceResult("case", 1.0, reason),)
    return CaseResult(name, name.title(), "", describe(problem), source, (), verdicts, 1.0)


def _exact(problem: CoatedContact, source: str, points: int) -> list[Profile]:
    a, p0, nu = problem.a_h, problem.p_h, problem.substrate[1]
    origin = np.zeros(1)
    hertz = SimpleNamespace(
        contact_radius=a, peak_pressure=p0, approach=problem.delta_h, stiffness=problem.S_h
    )
    found = [
        Profile(name, "contact", origin, np.array([getattr(hertz, name)]), source)
        for name in SCALARS + SLOPES
    ]
    tension = ((1 - 2 * nu) / 3 + problem.friction * np.pi * (4 + nu) / 8) * p0
    for name, value in zip(PEAKS, (tension, -a), strict=True):
        found.append(Profile(name, "contact", origin, np.array([value]), source))
    for line in (*lines_of(problem), *oblique_lines(problem)):
        position = np.linspace(0 if line.depth is None else -2 * a, 2 * a, points)
        bell = 1 / (1 + (position / a) ** 2)
        quantities = dict.fromkeys(IN_PLANE, -p0)
        if line.depth is None:
            quantities["sigma_xz"] = 0.0  # on the axis, by symmetry
        if line.name.startswith("o"):
            quantities = dict.fromkeys(STRESSES, -p0) if line.name != "oblique surface" else {}
            quantities |= dict.fromkeys(DISPLACEMENTS, problem.delta_h)
        if line.name == "surface":
            pressure = p0 * np.sqrt(np.maximum(1 - (position / a) ** 2, 0))
            found.append(Profile("pressure", line.name, position, pressure, source))
        found += [Profile(n, line.name, position, size * bell, source) for n, size in quantities.items()]
    return found


def showcase(points: int = 129) -> list[CaseResult]:
    """Twelve cases that show everything a report has to cope with."""
    E, nu = STEEL
    two = (2 * E, nu, 1.0)
    stopped = (
        "load balance off by 3e-3 after 40 iterations (asked for 1e-8); the contact reaches the edge of the "
        "mesh at r = 4.0 a_h, widen it"
    )
    long = (
        "Alumina on aluminium, <script>alert('no')</script> & unequal Poisson ratios, with a title so long "
        "that it has to break over several lines on any screen and still be readable"
    )
    nan = {("sigma_xx", "interface 1, upper side", "semianalytic"): float("nan")}
    off = {"errors": {"semianalytic": 2e-3}, "stated": {"semianalytic": 0.7}}
    on_aluminium = contact((370e9, 0.22, 0.3), substrate=(70e9, 0.33))
    cases = [
        ("uncoated_steel", "Uncoated steel (Hertz)", contact(), {}),
        ("soft_quarter", "E1/E2 = 1/4, h = a_h", contact((E / 4, nu, 1.0)), {}),
        ("soft_half", "E1/E2 = 1/2, h = a_h", contact((E / 2, nu, 1.0)), {}),
        ("stiff_two", "E1/E2 = 2, h = a_h", contact(two), {"text": "title = 'E1/E2 = 2'\n[problem]\n"}),
        ("stiff_four", "Semi-analytical off by more than it states", contact((4 * E, nu, 1.0)), off),
        ("thin", "Thin coating, h = 0.1 a_h", contact((2 * E, nu, 0.1)), {}),
        ("thick", "Uncertainty above the cap", contact((2 * E, nu, 2.0)), {"errors": {"semianalytic": 4e-3}}),
        ("dlc", "DLC with a chromium interlayer", contact((250e9, 0.2, 0.03), (279e9, 0.21, 0.012)), {}),
        ("mos2", "MoS2 on steel", contact((110e9, 0.3, 0.5)), {"failures": {"fem_reference": stopped}}),
        ("silver", "Silver on steel: NaN in one stress", contact((83e9, 0.37, 0.2)), {"spoil": nan}),
        ("alumina", long, on_aluminium, {"stated": {"fem_reference": None}}),
    ]
    return [
        *(result_of(of, name=name, title=title, points=points, **more) for name, title, of, more in cases),
        crashed(contact((0.05 * E, 0.4, 0.5)), "polymer_on_glass", "killed after 300 s, its time limit"),
    ]
