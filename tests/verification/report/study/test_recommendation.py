"""What a study recommends, from curves whose answer is known."""

import numpy as np
import pytest
import study_table

from verification.report.study.recommendation import near, recommendation_messages
from verification.report.study.summary import main_messages
from verification.study.criteria import Criteria, judged
from verification.study.curves import curves
from verification.study.table import read_columns


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    path = tmp_path_factory.mktemp("study") / "study.parquet"
    study_table.write(path, checked=3e-4)
    return curves(read_columns(path))


def test_the_nearest_cross_check_is_named_with_its_difference(found):
    judgement = judged(found[3], Criteria())
    checked = judgement.curve.marks["fem_reference"]["sigma_xx_surface"][0]
    (one,) = near(judgement, 0.9 * checked[1], "sigma_xx_surface")
    assert (one.source, one.h) == ("fem_reference", checked[1])
    assert one.difference == pytest.approx(3e-4, rel=1e-6)


def test_recommended_is_what_is_admissible_at_every_friction(found):
    criteria = Criteria(strength={"sigma_xx_surface": 0.9 * study_table.P_H})
    (said,) = recommendation_messages([judged(c, criteria) for c in found if c.ratio == 2.0])
    # f = 0.25 is the harder one: (0.1 + f) E1/E2 (1 + log(2 h)^2 / 4) = 0.9
    reach = np.exp(2 * np.sqrt(0.9 / 0.7 - 1))
    low, high = (float(s) for s in said.split("h = ")[1].split(" µm")[0].split(" to "))
    assert low == pytest.approx(0.5 / reach * study_table.A_H * 1e6, rel=0.03)
    assert high == pytest.approx(0.5 * reach * study_table.A_H * 1e6, rel=0.03)
    for part in (
        "admissible at every friction (f = 0 to 0.25)",
        "Thinner, the coating cracks at its surface (sigma_xx_surface, f = 0.25)",
        "thicker, the coating cracks at its surface",
        "0.78 of the strength in sigma_xx_surface",
        "at most 3.0e-04 p_h off the finite elements",
    ):
        assert part in said


def test_an_end_of_the_sweep_is_no_failure(found):
    criteria = Criteria(strength={"von_mises_substrate": 0.8 * study_table.P_H})
    (said,) = recommendation_messages([judged(c, criteria) for c in found if c.ratio == 2.0])
    # 0.7 E1/E2 (1 + f) e^-h = 0.8: too thin yields, however thick holds
    assert "Thinner, the substrate yields (von_mises_substrate, f = 0.25); thicker, the sweep ends" in said


def test_where_nothing_is_admissible_the_sentence_says_what_breaks(found):
    criteria = Criteria(strength={"sigma_xx_surface": 1e6})
    messages = recommendation_messages([judged(c, criteria) for c in found])
    assert len(messages) == 2
    for said in messages:
        assert "no thickness of the sweep is admissible at every friction" in said
        assert "with f = 0.25 even the preferable" in said


def test_without_strengths_the_span_of_preferable_thicknesses_is_named(found):
    (said,) = recommendation_messages([judged(c, Criteria()) for c in found])
    assert said.startswith("Over the 4 curves the preferable thickness lies between h = ")


def test_the_summary_is_a_sentence_a_stress_and_one_for_the_contact(found):
    messages = main_messages(found)
    assert len(messages) == len(study_table.QUANTITIES) + 1
    worst = study_table.stress("von_mises_substrate", 2.0, 0.05, 0.25)
    assert (
        f"reaches {worst:.3g} p_h, {worst * study_table.P_H / 1e6:.4g} MPa, with E1/E2 = 2, f = 0.25"
        in (messages[6])
    )
    assert "p0 is between 1 p_h" in messages[7]
