"""The harness answers what is known of it, and a run says so when it does not."""

import pytest
from faults_planted.fault_catalogue import FAULTS
from faults_planted.fault_planting import planted
from synthetic_results import contact, result_of

from verification.credibility import self_tests as room
from verification.credibility.self_tests import self_tests
from verification.judging.verdict import Outcome
from verification.regression.baseline_change import Regression
from verification.regression.run_exit_codes import EXIT, run_code


@pytest.mark.parametrize("test", self_tests(), ids=lambda test: test.name)
def test_the_harness_gives_the_known_answer(test):
    assert test.passed, test.found


@pytest.mark.parametrize(
    "name", [f.name for f in FAULTS.values() if f.group == "harness" and not f.solve and f.where == "harness"]
)
def test_a_fault_of_the_harness_turns_the_answer_named_for_it(name, monkeypatch):
    fault = FAULTS[name]
    named = [test for test in room._TESTS if test[0] in fault.predicted]
    monkeypatch.setattr(room, "_TESTS", named)
    with planted(fault.changes):
        failed = {test.name for test in self_tests() if not test.passed}
    assert failed


def test_a_run_is_no_better_than_its_harness(tmp_path):
    agreeing = result_of(contact())
    assert agreeing.outcome is Outcome.AGREES
    nothing = Regression(tmp_path, None, ())
    assert run_code([agreeing], nothing, passed=True) == EXIT[Outcome.AGREES]
    assert run_code([agreeing], nothing, passed=False) == EXIT[Outcome.DISAGREES]
    lost = result_of(contact(), failures={"semianalytic": "did not converge"})
    assert run_code([lost], nothing, passed=False) == EXIT[Outcome.NO_RESULT]
