"""Known verdicts: two made-up profiles compared, the exact reference beside proven enclosures."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from verification.credibility.self_tests.stand_ins import Answers
from verification.evidence.enclosure_record import (
    LOWER,
    SHIPPED,
    SURFACE,
    WIDTH,
    Bounds,
    Enclosure,
    read_record,
)
from verification.judging.invariant_verdict import decide
from verification.judging.verdict import Outcome, compare, judge
from verification.problem.coated_contact import CoatedContact, ContactSolution, keywords
from verification.problem.line_profile import Profile
from verification.problem.point_answers import Points
from verification.sources.references import integral_equation


def of_judging() -> Answers:
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

    def holds(residual: list[float], bound: list[float] | None) -> Outcome:
        return decide("known", "known", "0 = 0", residual, bound, cap=5e-3).outcome

    yield "residuals within their bounds", holds([1e-3, -1e-4], [2e-3, 2e-4]), Outcome.AGREES
    yield "a small residual beyond its bound", holds([1e-3, -1e-4], [2e-3, 5e-5]), Outcome.DISAGREES
    yield "a bound beyond the cap", holds([1e-3, 1e-4], [2e-3, 6e-3]), Outcome.INCONCLUSIVE
    yield "a residual without a bound", holds([1e-3, 1e-4], None), Outcome.INCONCLUSIVE
    yield "a residual that is NaN", holds([1e-3, np.nan], [2e-3, 2e-3]), Outcome.NO_RESULT
    yield "a bound that is NaN", holds([1e-3, 1e-4], [2e-3, np.nan]), Outcome.NO_RESULT
    yield "no residual", holds([], []), Outcome.NO_RESULT


def of_points() -> Answers:
    x = np.linspace(-1.0, 1.0, 101)
    flat, spoiled = np.ones(101), np.ones(101)
    spoiled[70] += 0.3
    a, b = (Profile("q", "l", x, value, "s", np.full(101, 0.1)) for value in (flat, spoiled))
    yield "one bad point of 101", judge(compare(a, b, scale=1.0), 1.0).outcome, Outcome.DISAGREES
    yield "its place", judge(compare(a, b, scale=1.0), 1.0).worst, float(x[70])
    here = np.abs(x - x[70]) < 1e-9
    yield "without it", judge(compare(a, b, scale=1.0, excluded=here), 1.0).outcome, Outcome.AGREES
    yield "with it alone", judge(compare(a, b, scale=1.0, excluded=~here), 1.0).outcome, Outcome.DISAGREES
    some = np.zeros(101, dtype=bool)
    some[:10] = some[50:55] = True
    judged = judge(compare(a, b, scale=1.0, excluded=some), 1.0).judged
    assert judged is not None
    found = judged.points, judged.extent, judged.gap
    yield "without some", found, (86, (float(x[10]), 1.0), float(x[55] - x[49]))
    nothing = np.ones(101, dtype=bool)
    yield "without any", judge(compare(a, b, scale=1.0, excluded=nothing), 1.0).outcome, Outcome.NO_RESULT
    elsewhere = replace(b, position=x + 1e-3)
    try:
        compare(a, elsewhere, scale=1.0)
        yield "profiles at other points", "compared", "refused"
    except ValueError:
        yield "profiles at other points", "refused", "refused"


def _known(value: float, U: float | None, source: str = "known") -> Profile:
    spread = None if U is None else np.array([1e5, U])
    return Profile("q", "l", np.array([0.0, 1.0]), np.array([1e9, value]), source, spread)


TEST = "exact reference"
COATED = ("ratio_10_h_1", "ratio_0.1_h_1", "two_soft_on_stiff")
# Of the value: an enclosure of the required width contains the reference.
ROUNDING = WIDTH / 2


def of_enclosures() -> Answers:
    """A few problems that are solved quickly."""
    record = read_record(SHIPPED)
    known = {one.name: one for one in record.enclosures} if record else {}
    for name in ("uncoated", *COATED):
        one = known[name]
        exact = integral_equation.solve(**keywords(one.problem), estimate_uncertainty=False)
        for bounds, distance, _ in distances(one, exact):
            what = f"{bounds.quantity} of {name}, {bounds.line}, in its enclosure"
            yield what, distance <= ROUNDING * abs(bounds.middle), True


def distances(
    enclosure: Enclosure, solution: ContactSolution
) -> Iterator[tuple[Bounds, float, float | None]]:
    """Each bound with the distance of the solution's value from it, then U of this value if stated."""
    for bounds in enclosure.bounds:
        value, U = _value(enclosure.problem, solution, bounds)
        yield bounds, bounds.distance(value), U


def _value(problem: CoatedContact, solution: ContactSolution, bounds: Bounds) -> tuple[float, float | None]:
    if bounds.quantity == "sigma_xx":
        layer = 1 if bounds.line == LOWER else 0
        z = 0.0 if bounds.line == SURFACE else problem.interfaces[0]
        value, U = solution.sample(Points(0.0, 0.0, z, layer), "stress")
        value, U = value[0, 0], None if U is None else U[0, 0]
    else:
        value, U = solution.sample(Points(0.0) if bounds.quantity == "pressure" else None, bounds.quantity)
    return float(value), None if U is None else float(U)
