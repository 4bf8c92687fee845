"""The cases as the baseline holds them: what each source gave, how far apart."""

from functools import cache
from pathlib import Path

from verification.cases.case_file import default_cases, read_case
from verification.cases.published_file import published_cases, read_published
from verification.judging.verdict import Claim, compare, judge
from verification.problem.line_profile import Profile
from verification.problem.quantity import QUANTITIES
from verification.regression.baseline_change import Baseline
from verification.regression.baseline_file import read_baseline
from verification.running.case_result import CaseResult, SourceResult, describe
from verification.sources.source_registry import SOURCES

FOLDER = Path(__file__).parents[1] / "regression" / "shipped"


@cache
def baseline() -> Baseline:
    """The baseline of the package."""
    found = read_baseline(FOLDER)
    assert found is not None
    return found


@cache
def stored(name: str) -> CaseResult:
    """A case with the numbers of the baseline and the comparisons of its manifest, judged anew."""
    recorded = baseline().cases[name]
    manifest, published = recorded.manifest, recorded.published
    case = read_published(published_cases()[name]) if published else read_case(default_cases()[name])
    profiles = [
        Profile(n.quantity, n.line, n.position, n.value, n.source, n.uncertainty) for n in recorded.numbers
    ]
    known = {(one.source, one.quantity, one.line): one for one in profiles}
    verdicts = []
    for alike in manifest.comparisons:
        for quantity, *between in alike.pairs:
            a, b = (known.get((source, quantity, alike.line)) for source in between)
            if a is not None and b is not None:
                claim = Claim(quantity, alike.line, (a.source, b.source), alike.judged.cap, "")
                verdicts.append((claim, judge(compare(a, b, scale=alike.judged.scale), claim.cap)))
    sources = tuple(SourceResult(source, 0.0) for source in manifest.sources if source in SOURCES)
    problem = describe(case.problem)
    return CaseResult(
        name, case.title, case.source, problem, sources, tuple(profiles), tuple(verdicts), 0.0, case.text
    )


def largest(case: str, between: tuple[str, ...] | None, *kinds: str) -> float | None:
    """The largest difference of a case over its scale among quantities of these ``kinds``."""
    found = [
        verdict.difference
        for claim, verdict in stored(case).verdicts
        if QUANTITIES[claim.quantity].kind in kinds and between in (None, claim.between)
    ]
    return max((one for one in found if one is not None), default=None)


def points(case: str) -> int:
    """Number of points at which the comparisons of a case are judged."""
    return sum(verdict.judged.points for _, verdict in stored(case).verdicts if verdict.judged)
