"""False alarms: what counts as one, the errors over their uncertainties, the record."""

from dataclasses import replace

import pytest
from alarms import alarms, counted, with_campaign
from synthetic_results import INFO, STEEL, contact, crashed, result_of

from verification.evidence.alarm_record import AlarmRecord, read_record, wrong_first
from verification.judging.verdict import Outcome

E, NU = STEEL
KIND = "round contacts"


def test_whatever_is_not_agreement_is_an_alarm():
    good = result_of(contact((2 * E, NU, 1.0)), name="good", text="title = 'good'\n")
    wrong = result_of(
        contact((4 * E, NU, 1.0)), name="wrong", errors={"semianalytic": 2e-3}, stated={"semianalytic": 0.7}
    )
    vague = result_of(contact((E / 2, NU, 1.0)), name="vague", errors={"semianalytic": 4e-3})
    dead = crashed(contact((2 * E, NU, 1.0)), "dead", "killed")
    clean = counted([good], KIND, 1, INFO)
    assert (clean.alarms, clean.agreeing, clean.problems) == ((), 1, 1)
    assert clean.comparisons == len(good.verdicts)
    empty = replace(good, name="empty", verdicts=())
    found = counted([good, wrong, vague, dead, empty], KIND, 1, INFO)
    assert found.agreeing == 1
    outcomes = {alarm.case: set() for alarm in found.alarms}
    for alarm in found.alarms:
        outcomes[alarm.case].add(alarm.outcome)
    assert outcomes["dead"] == outcomes["empty"] == {Outcome.NO_RESULT}
    assert Outcome.INCONCLUSIVE in outcomes["vague"]
    assert Outcome.DISAGREES in outcomes["wrong"]
    assert "good" not in outcomes
    assert (found.wrong, found.vague) == ({"wrong", "dead", "empty"}, {"vague"})
    assert found.comparisons == sum(len(r.verdicts) for r in (good, wrong, vague, dead))
    merely_vague = [one.outcome is Outcome.INCONCLUSIVE for one in found.alarms]
    assert merely_vague != sorted(merely_vague)
    assert [one.outcome is Outcome.INCONCLUSIVE for one in wrong_first(found.alarms)] == sorted(merely_vague)


def of_errors(*stated):
    """Campaigns on a contact with one error, each with so much of its uncertainty stated."""
    problem, errors = contact((4 * E, NU, 1.0)), {"semianalytic": 2e-3}
    results = [result_of(problem, errors=errors, stated={"semianalytic": share}) for share in stated]
    return [counted([one], KIND, 1, INFO) for one in results]


def test_ratios_count_every_error_over_its_uncertainty():
    within, beyond = of_errors(2.0, 0.5)
    found = [next(r for r in one.ratios if r.source == "semianalytic") for one in (within, beyond)]
    for semi in found:
        assert sum(semi.counts) == semi.values > 0
    generous, narrow = found
    assert (generous.within, narrow.within < 1) == (1.0, True)
    assert generous.largest <= 1 < narrow.largest
    assert generous.median > 1.5 * narrow.median  # the exact reference has an uncertainty too


def test_largest_difference_over_uncertainty_is_that_of_the_worst_comparison():
    found = of_errors(2.0, 0.5)
    assert found[0].largest < 1 < found[1].largest
    assert [len(one.wrong) for one in found] == [0, 1]


def test_the_record_keeps_each_kind_and_seed_of_one_code_and_adds_them_up():
    good = result_of(contact((2 * E, NU, 1.0)), name="good")
    one = counted([good, replace(good, name="other")], KIND, 1, INFO)
    two, films = replace(one, seed=2), replace(one, kind="thin films")
    record = None
    for campaign in (films, two, one, replace(one, started="later")):
        record = with_campaign(record, campaign)
    assert [(c.kind, c.seed, c.started) for c in record.campaigns] == [
        (KIND, 1, "later"),
        (KIND, 2, INFO.started),
        ("thin films", 1, INFO.started),
    ]
    assert {kind: (of.problems, of.wrong) for kind, of in record.kinds.items()} == {
        KIND: (4, 0),
        "thin films": (2, 0),
    }
    assert record.kinds[KIND].rate == pytest.approx(1 - 0.05 ** (1 / 4))  # none failed: (1 - p)^n = 5 %
    on_other_code = AlarmRecord((replace(one, source="another"),))
    assert with_campaign(on_other_code, two).campaigns == (two,)


@pytest.mark.slow
def test_the_command_records_what_it_found(tmp_path):
    assert (
        alarms(count=2, seed=1, output=tmp_path, record=True, records=tmp_path / "records", as_json=True) == 0
    )
    record = read_record(tmp_path / "records")
    assert record is not None
    assert [(one.kind, one.problems, one.agreeing) for one in record.campaigns] == [(KIND, 2, 2)]
    assert record.wrong == 0
