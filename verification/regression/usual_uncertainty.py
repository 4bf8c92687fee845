"""Uncertainty that each method usually states beside the cap: by quantity, line, class of problem.

The rule: of the cases of a class in the baseline the largest U over all judged points, over the scale of the
comparison. cap / U is what an uncertainty could grow by before its comparison is inconclusive; the baseline
lets it grow four times.
"""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from verification.regression.manifest import Manifest, manifest_of
from verification.regression.number_drift import Numbers, measured
from verification.running.case_result import CaseResult
from verification.sources.source_registry import METHODS

_Largest = dict[tuple[str, str, str, float], dict[str, float]]


@dataclass(frozen=True)
class Ability:
    """Largest U over scale by source, ``usual`` in the baseline and ``now`` in the run."""

    problems: str
    quantity: str
    line: str
    cap: float
    usual: dict[str, float]
    now: dict[str, float]


def abilities(
    results: Sequence[CaseResult],
    numbers: Mapping[str, Sequence[Numbers]],
    manifests: Mapping[str, Manifest],
) -> tuple[Ability, ...]:
    """Of the ``results`` of contacts that the baseline, with its ``numbers`` and ``manifests``, has too."""
    usual: _Largest = defaultdict(dict)
    now: _Largest = defaultdict(dict)
    for result in (one for one in results if one.name in manifests and not one.published):
        problems = _class(result)
        _add(usual, problems, manifests[result.name], numbers[result.name])
        _add(now, problems, manifest_of(result), measured(result))
    return tuple(Ability(*key, found, now[key]) for key, found in usual.items())


def _class(result: CaseResult) -> str:
    coated = "coated" if result.problem.get("coatings") else "uncoated"
    return f"{coated}, sliding" if result.problem.get("friction") else coated


def _add(found: _Largest, problems: str, manifest: Manifest, numbers: Sequence[Numbers]) -> None:
    stated = {n.key: float(n.uncertainty.max()) for n in numbers if n.uncertainty is not None}
    for group in manifest.comparisons:
        line, judged = group.line.partition(" ")[0], group.judged
        for quantity, *between in group.pairs:
            for source in set(between) & set(METHODS):
                U = stated.get((source, quantity, group.line), 0.0) / judged.scale
                largest = found[problems, quantity, line, judged.cap]
                largest[source] = max(largest.get(source, 0.0), U)
