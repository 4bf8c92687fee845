"""Exit codes of a run."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from verification.judging.outcome import Outcome

if TYPE_CHECKING:
    from verification.regression.baseline_change import Regression
    from verification.running.case_result import CaseResult

EXIT = {Outcome.DISAGREES: 1, Outcome.NO_RESULT: 3, Outcome.INCONCLUSIVE: 4, Outcome.AGREES: 0}
DRIFTED = 5  # all agree, but not with the numbers of the baseline
LESS = 6  # all agree, but less was judged than the manifest records


def exit_code(results: Sequence["CaseResult"]) -> int:
    """The code of the worst outcome: disagreement before a missing result before inconclusive."""
    found = {result.outcome for result in results}
    for outcome in (Outcome.DISAGREES, Outcome.NO_RESULT, Outcome.INCONCLUSIVE):
        if outcome in found:
            return EXIT[outcome]
    return EXIT[Outcome.AGREES] if found else EXIT[Outcome.NO_RESULT]


def run_code(
    results: Sequence["CaseResult"], beside: "Regression", *, passed: bool, studies: Sequence[Outcome] = ()
) -> int:
    """That of the worst outcome; where all agree that of the self-tests, the manifest, the baseline.

    passed : whether every self-test of the harness did.   studies : outcomes of the judged studies.
    """
    code = exit_code(results)
    for outcome in (Outcome.DISAGREES, Outcome.NO_RESULT, Outcome.INCONCLUSIVE):
        if code == EXIT[outcome] or outcome in studies:
            return EXIT[outcome]
    if not passed:
        return EXIT[Outcome.DISAGREES]
    return LESS if beside.less else DRIFTED if beside.unexplained else code
