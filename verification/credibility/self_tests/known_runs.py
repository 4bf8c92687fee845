"""Whole runs of an uncoated case, sliding, with closed forms in place of every source.

Claims, caps and scales are those of a case file without any.
"""

from collections import defaultdict
from dataclasses import replace
from itertools import combinations
from math import comb, pi
from typing import Any

import numpy as np

from verification.cases.case_file import Case
from verification.credibility.self_tests.stand_ins import Answers, Failing, Misplaced, Spoiled, Stated
from verification.judging.standard_claims import standard_claims
from verification.judging.verdict import Claim, Outcome
from verification.problem.coated_contact import CoatedContact
from verification.problem.line_profile import Profile
from verification.problem.quantity import QUANTITIES, SCALARS
from verification.running.case_result import CaseResult, SourceResult
from verification.running.contact_run import decide, judge_case, solve_case
from verification.sources.references.hertz import Hertz
from verification.sources.source_registry import REFERENCES, sources_of

# nu = 0: a = 1e-4 m, p0 = 6e9/pi Pa, approach = 1e-6 m
MATERIAL = (1e-2, 40.0, 3e11, 0.0, 0.25)
PROBLEM = CoatedContact(1e-2, 40.0, (), (3e11, 0.0), 0.25)


def ran(others: Any = None, invariants: bool = False, **methods: Any) -> CaseResult:
    """The result with ``methods`` as given, the references by ``others`` or Hamilton."""
    case = Case("known", "known", PROBLEM, standard_claims(PROBLEM))
    named = {name: others or Hertz(*MATERIAL) for name in sources_of(PROBLEM) if name in REFERENCES}
    available = {name: (lambda p, _, s=s: s) for name, s in (methods | named).items()}
    return judge_case(case, solve_case(case, available), invariants=invariants)


def of_runs() -> Answers:
    true, loaded = Stated(*MATERIAL), Stated(1e-2, 40.2, 3e11, 0.0, 0.25)
    references = [name for name in sources_of(PROBLEM) if name in REFERENCES]
    result = honest = ran(None, True, semianalytic=true, fem_reference=true)
    yield "two honest methods", result.outcome, Outcome.AGREES
    pairs = {claim.between for claim, _ in result.verdicts}
    yield "pairs compared", len(pairs), comb(len(references) + 2, 2)
    compared = {(claim.quantity, claim.line) for claim, _ in result.verdicts}
    yield "comparisons of each pair", len(result.verdicts), len(pairs) * len(compared)
    off = ran(semianalytic=loaded, fem_reference=true).outcome
    yield "a load off by half a per cent", off, Outcome.DISAGREES
    off = ran(semianalytic=true, fem_reference=loaded).outcome
    yield "the same in the other", off, Outcome.DISAGREES
    result = ran(None, True, semianalytic=loaded, fem_reference=loaded)
    yield "the same in both", result.outcome, Outcome.DISAGREES
    scalars = [(c, v) for c, v in result.verdicts if c.quantity in SCALARS]
    agreeing = {c.between for c, v in scalars if v.outcome is Outcome.AGREES}
    still = {("semianalytic", "fem_reference"), *combinations(references, 2)}
    yield "pairs that still agree", agreeing, still
    nowhere = ran(semianalytic=true, fem_reference=Failing(*MATERIAL)).outcome
    yield "a method without stresses", nowhere, Outcome.NO_RESULT
    yield "a method that was not asked", ran(semianalytic=true).outcome, Outcome.NO_RESULT
    vague = ran(semianalytic=true, fem_reference=replace(true, share=0.02)).outcome
    yield "a method with a vague U", vague, Outcome.INCONCLUSIVE
    nothing = replace(honest, verdicts=()).outcome
    yield "a case that judges nothing", nothing, Outcome.NO_RESULT
    yield from _decisions()
    for at in (0.5, 0.9, 1.0, 1.1):
        spoiled = ran(semianalytic=true, fem_reference=Spoiled(*MATERIAL, at=at)).outcome
        yield f"a pressure that is off at {at} a", spoiled, Outcome.DISAGREES


def _decisions() -> Answers:
    """Scale and edge zone go by the last source, the reference: its contact is twice as wide as Hertz's."""
    contact = {"contact_radius": (3e-4, 2e-4), "peak_pressure": (9e8, 1e9), "approach": (3e-6, 2e-6)}
    x, U = 1e-4 * np.arange(4.0), np.full(4, 1e5)
    claim = Claim("pressure", "surface", ("one", "two"), 1e-2, "known", 0.1)
    for place, outcome in ((1, Outcome.DISAGREES), (2, Outcome.AGREES), (3, Outcome.DISAGREES)):
        off = 1e7 * (np.arange(4) == place)
        pressures = (("one", 1e8 + off), ("two", 1e8 + 0 * x))
        found = [Profile("pressure", "surface", x, p, s, U) for s, p in pressures]
        for name, values in contact.items():
            for s, value in zip(("one", "two"), values, strict=True):
                found.append(Profile(name, "contact", np.zeros(1), np.array([value]), s, np.zeros(1)))
        known = {(p.quantity, p.line, p.source): p for p in found}
        verdict = decide(claim, known, {s: SourceResult(s, 1.0) for s in ("one", "two")}, PROBLEM)
        yield f"off at {place} a_h with an edge zone", verdict.outcome, outcome
        yield "its scale", verdict.judged and verdict.judged.scale, 1e9


def of_coverage() -> Answers:
    """Cap, scale, points, extent of each comparison; stresses that are off on part of a line alone."""
    true = Stated(*MATERIAL)
    result = ran(semianalytic=true, fem_reference=true)
    extents = {  # first, last, gap over a
        "surface": (-2.0, 2.0, 0.06),
        "axis": (0.0, 4.0, 0.2),
        "contact": (0.0, 0.0, 0.0),
        "off plane": (-1.2, 1.2, 0.13),
        "oblique": (0.0, 2.4, 0.26),
        "oblique surface": (-5.0, 5.0, 0.8),
    }
    for claim, verdict in result.verdicts:
        what, judged = f"{claim.quantity} on {claim.line}", verdict.judged
        assert judged is not None
        profile = result.profile_of[claim.quantity, claim.line, claim.between[0]]
        yield f"cap of {what}", (judged.cap, claim.edge), (QUANTITIES[claim.quantity].cap, 0.0)
        yield f"points of {what}", judged.points, profile.position.size
        first, last, gap = extents[claim.line]
        bounds = (judged.extent[0] <= (first + 0.1) * 1e-4, judged.extent[1] >= (last - 0.1) * 1e-4)
        yield f"extent of {what}", (*bounds, judged.gap <= gap * 1e-4), (True, True, True)
        if QUANTITIES[claim.quantity].kind in ("pressure", "stress"):
            yield f"scale of {what}", judged.scale, 6e9 / pi
        elif claim.quantity in SCALARS:
            yield f"scale of {what}", judged.scale, float(abs(profile.value[0]))
    x = result.profile_of["pressure", "surface", "semianalytic"].position / 1e-4
    yield "points around both edges", [int(np.sum(np.abs(x - edge) < 0.0101)) for edge in (-1, 1)], [7, 7]
    # trailing edge: (1 - 2 nu)/3 + (4 + nu)/8 pi f of p0; Hamilton, Goodman, J. Appl. Mech. 33 (1966) 371
    for peak, wanted in (("largest_tension", 6e9 / pi * (1 / 3 + pi / 8)), ("tension_place", -1e-4)):
        yield peak, float(result.profile_of[peak, "contact", "semianalytic"].value[0]), wanted
    low: tuple[float, float, float]
    high: tuple[float, float, float]
    for where, low, high in (
        ("on the trailing side", (-9, 0, 0), (-0.7, 0, 0)),
        ("on the leading side", (0.7, 0, 0), (9, 0, 0)),
        ("at the trailing edge", (-1.005, 0, 0), (-0.995, 0, 0)),
        ("at the leading edge", (0.995, 0, 0), (1.005, 0, 0)),
        ("deep on the axis", (0, 0, 1.6), (0, 0, 9)),
        ("shallow on the axis", (0, 0, 1e-3), (0, 0, 0.2)),
    ):
        off = ran(semianalytic=true, fem_reference=Misplaced(*MATERIAL, low=low, high=high))
        verdicts = {verdict.outcome for _, verdict in off.verdicts}
        yield f"stresses that are off {where}", Outcome.DISAGREES in verdicts, True


def of_invariants() -> Answers:
    """A stress that is off beside the plane y = 0 alone, where no line lies."""
    true = Stated(*MATERIAL)
    crooked = Misplaced(*MATERIAL, low=(-9.0, 0.001, 0.0), high=(9.0, 9.0, 9.0))
    exact = replace(crooked, share=0.0)
    honest = ran(None, True, semianalytic=true, fem_reference=true)
    names = defaultdict[str, set[str]](set)
    for one in honest.invariants:
        names[one.source].add(one.name)
    yield "sources with invariants", set(names), set(sources_of(PROBLEM))
    # the influence coefficients are those of the code of a method, not of a solution
    of_solutions = {frozenset(found - {"influence coefficients"}) for found in names.values()}
    yield "the same of each", of_solutions, {frozenset(names["fem_reference"])}
    for what, references, semi, elements, sources in (
        ("one method", None, crooked, true, {"semianalytic"}),
        ("the other", None, true, crooked, {"fem_reference"}),
        ("all sources", exact, crooked, crooked, set(sources_of(PROBLEM))),
    ):
        result = ran(references, True, semianalytic=semi, fem_reference=elements)
        lines = {v.outcome for c, v in result.verdicts if c.line in ("contact", "surface", "axis")}
        yield f"lines of {what}, off beside them", lines, {Outcome.AGREES}
        broken = {one.source for one in result.invariants if one.outcome is Outcome.DISAGREES}
        yield f"invariants of {what}", (broken, result.outcome), (sources, Outcome.DISAGREES)
