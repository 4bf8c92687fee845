"""The outcome of a trial: which check caught the fault, counted column by column."""

from collections.abc import Sequence

from verification.credibility.faults.default_checks import Check
from verification.credibility.faults.fault_planting import Fault
from verification.credibility.faults.fault_trial import Trial
from verification.evidence.fault_record import CAUGHT, COLUMNS, EQUIVALENT_CHANGE, Catch, Row, Tally
from verification.judging.verdict import Outcome

WORST_FIRST = (Outcome.DISAGREES, Outcome.INCONCLUSIVE, Outcome.NO_RESULT)  # of those that do not pass


def row_of(fault: Fault, trial: Trial) -> Row:
    """The row of one trial: its checks counted column by column."""
    by_column = {column: [c for c in trial.checks if c.column == column] for column in COLUMNS}
    bad = [check for check in trial.checks if not check.passed]
    decided = [c for c in bad if c.outcome is not Outcome.NO_RESULT]
    predicted = [c for c in decided if c.name in fault.predicted]
    catch = _catch(bad, fault, trial)
    return Row(
        fault.name,
        fault.group,
        fault.description,
        fault.where,
        catch,
        bool(predicted),
        _worst_message(predicted or decided or bad),
        {column: _tally(checks) for column, checks in by_column.items() if checks},
        trial.change,
        trial.changed,
        trial.seconds,
        (*fault.cases, *fault.published),
        trial.failure or "",
        "" if catch in CAUGHT else fault.reason,
        "" if catch in CAUGHT else fault.remedy,
        fault.equivalent and catch is Catch.SURVIVED and trial.change <= EQUIVALENT_CHANGE,
    )


def _catch(bad: Sequence[Check], fault: Fault, trial: Trial) -> Catch:
    if trial.failure is not None:
        return Catch.NOT_TRIED
    # A changed number is not in itself an error; it counts where no other check can detect the fault.
    own = [check for check in bad if check.column != "baseline"]
    outcomes = {check.outcome for check in own}
    if Outcome.DISAGREES in outcomes:
        return Catch.DISAGREES
    if Outcome.INCONCLUSIVE in outcomes:
        return Catch.INCONCLUSIVE
    if "baseline" in fault.predicted and len(own) < len(bad):
        return Catch.DRIFTED
    return Catch.NO_RESULT if own else Catch.SURVIVED


def _tally(checks: Sequence[Check]) -> Tally:
    disagree, inconclusive, no_result = (sum(c.outcome is one for c in checks) for one in WORST_FIRST)
    message = _worst_message([check for check in checks if not check.passed])
    return Tally(len(checks), disagree, inconclusive, no_result, message)


def _worst_message(bad: Sequence[Check]) -> str:
    """Message of the worst check: the first disagreement, then the first inconclusive, then no result."""
    ranked = sorted(bad, key=lambda check: WORST_FIRST.index(check.outcome))
    return ranked[0].message if ranked else ""
