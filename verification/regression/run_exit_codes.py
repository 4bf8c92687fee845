"""Exit codes of a run."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from verification.judging.outcome import Outcome, worst

if TYPE_CHECKING:
    from verification.regression.baseline_change import Regression
    from verification.running.case_result import CaseResult

EXIT = {Outcome.DISAGREES: 1, Outcome.NO_RESULT: 3, Outcome.INCONCLUSIVE: 4, Outcome.AGREES: 0}
DRIFTED = 5  # all agree, but not with the numbers of the baseline
LESS = 6  # all agree, but less was judged than the manifest records


def exit_code(results: Sequence["CaseResult"]) -> int:
    """The code of the worst outcome."""
    return EXIT[worst(result.outcome for result in results)]


def run_code(
    results: Sequence["CaseResult"], beside: "Regression", *, passed: bool, studies: Sequence[Outcome] = ()
) -> int:
    """Exit code of the worst outcome; where all agree that of the self-tests, the manifest, the baseline.

    passed : whether every self-test of the harness did.   studies : outcomes of the judged studies.
    """
    if code := EXIT[worst([worst(result.outcome for result in results), *studies])]:
        return code
    if not passed:
        return EXIT[Outcome.DISAGREES]
    return LESS if beside.less else DRIFTED if beside.unexplained else code
