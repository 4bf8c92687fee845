"""False alarms: what counts as one, the errors over their uncertainties, the record."""

from dataclasses import replace

import pytest
from alarms import alarms, counted
from synthetic_results import INFO, STEEL, contact, crashed, result_of

from verification.evidence.alarm_record import read_record
from verification.judging.verdict import Outcome

E, NU = STEEL


def test_whatever_is_not_agreement_is_an_alarm():
    good = result_of(contact((2 * E, NU, 1.0)), name="good", text="title = 'good'\n")
    wrong = result_of(
        contact((4 * E, NU, 1.0)), name="wrong", errors={"semianalytic": 2e-3}, stated={"semianalytic": 0.7}
    )
    vague = result_of(contact((E / 2, NU, 1.0)), name="vague", errors={"semianalytic": 4e-3}, text="x = 1\n")
    dead = crashed(contact((2 * E, NU, 1.0)), "dead", "killed")
    clean = counted([good], 1, INFO)
    assert (clean.alarms, clean.agreeing, clean.problems) == ((), 1, 1)
    assert clean.comparisons == len(good.verdicts)
    empty = replace(good, name="empty", verdicts=())
    found = counted([good, wrong, vague, dead, empty], 1, INFO)
    assert found.agreeing == 1
    outcomes = {alarm.case: set() for alarm in found.alarms}
    for alarm in found.alarms:
        outcomes[alarm.case].add(alarm.outcome)
    assert outcomes["dead"] == outcomes["empty"] == {Outcome.NO_RESULT}
    assert Outcome.INCONCLUSIVE in outcomes["vague"]
    assert Outcome.DISAGREES in outcomes["wrong"]
    assert {alarm.toml for alarm in found.alarms if alarm.case == "vague"} == {"x = 1\n"}
    assert "good" not in outcomes
    assert found.comparisons == sum(len(r.verdicts) for r in (good, wrong, vague, dead))


def test_ratios_count_every_error_over_its_uncertainty():
    problem = contact((4 * E, NU, 1.0))
    within, beyond = (
        counted([result_of(problem, errors={"semianalytic": 2e-3}, stated={"semianalytic": stated})], 1, INFO)
        for stated in (2.0, 0.5)
    )
    found = [next(r for r in one.ratios if r.source == "semianalytic") for one in (within, beyond)]
    for semi in found:
        assert sum(semi.counts) == semi.values > 0
    generous, narrow = found
    assert (generous.within, narrow.within < 1) == (1.0, True)
    assert generous.largest <= 1 < narrow.largest
    assert generous.median > 1.5 * narrow.median  # the exact reference has an uncertainty too


@pytest.mark.slow
def test_the_command_records_what_it_found(tmp_path):
    assert (
        alarms(count=2, seed=1, output=tmp_path, record=True, records=tmp_path / "records", as_json=True) == 0
    )
    record = read_record(tmp_path / "records")
    assert record is not None
    assert (record.problems, record.agreeing, record.alarms) == (2, 2, ())
