"""What a study recommends, from curves whose answer is known."""

import numpy as np
import pytest
import study_table

from verification.cases.unit_numbers import Units
from verification.study.choice.failure_criteria import Criteria, judged
from verification.study.choice.thickness_choice import choice
from verification.study.pages.thickness_page import answers, checked_message, near, rounded
from verification.study.study_table import read_columns
from verification.study.thickness_curves import curves


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    path = tmp_path_factory.mktemp("study") / "study.parquet"
    study_table.write(path, checked=3e-4)
    return curves(read_columns(path))


def test_the_nearest_cross_check_is_named_with_its_difference(found):
    checked = found[3].marks["fem_reference"]["sigma_xx_surface"][0]
    nearest = near(found[3], 0.9 * checked[1], "sigma_xx_surface")
    assert nearest == {"fem_reference": (checked[1], pytest.approx(3e-4, rel=1e-6))}


def chosen(found, criteria, ratio=2.0):
    return choice([judged(c, criteria) for c in found if c.ratio == ratio], criteria)


def test_recommended_is_what_is_admissible_at_every_friction(found):
    criteria = Criteria(strength={"sigma_xx_surface": 0.9 * study_table.P_H})
    one = chosen(found, criteria)
    (answer,) = answers([one], Units())
    # f = 0.25 is the harder one: (0.1 + f) E1/E2 (1 + log(2 h)^2 / 4) = 0.9
    reach = np.exp(2 * np.sqrt(0.9 / 0.7 - 1))
    low, high = one.ranges[0]
    for end, exact in ((low, 0.5 / reach), (high, 0.5 * reach)):
        assert abs(end.h - exact) <= end.uncertainty < 0.1 * exact
        assert (end.mode, end.friction) == ("sigma_xx_surface", 0.25)
    assert answer.count("f = 0.25") == 2
    assert "0.78" in answer
    assert "0.4 MPa" in checked_message(one, Units())


def test_equally_good_thicknesses_are_those_within_the_tolerance(found):
    one = chosen(found, Criteria(minimise=["sigma_xx_surface"]))
    # 1 + log(2 h)^2 / 4 = 1 + tolerance
    reach = np.exp(2 * np.sqrt(one.tolerance))
    low, high = one.even
    for end, exact in ((low, 0.5 / reach), (high, 0.5 * reach)):
        assert abs(end.h - exact) <= max(end.uncertainty, 0.02 * exact)
    (answer,) = answers([one], Units())
    assert f"{np.ceil(100 * one.tolerance):.0f} %" in answer


@pytest.mark.parametrize(
    ("value", "uncertainty", "upwards", "text"),
    [
        (3.1416, 0.0, None, "3.1"),
        (3.1416, 0.02, None, "3.1"),
        (3.1416, 0.2, None, "3"),
        (3.1416, 0.0, True, "3.2"),
        (3.1616, 0.0, False, "3.1"),
        (41.9, 0.3, True, "42"),
        (41.9, 3.0, False, "40"),
        (41.9, 300.0, None, "40"),
        (0.0314, 0.0, None, "0.031"),
        (2.0, 0.0, True, "2.0"),
        (950.0, 40.0, True, "1000"),
    ],
)
def test_no_number_is_finer_than_its_uncertainty(value, uncertainty, upwards, text):
    assert rounded(value, uncertainty, upwards) == text


def test_where_nothing_is_admissible_the_answer_names_what_breaks(found):
    criteria = Criteria(strength={"sigma_xx_surface": 1e6})
    texts = answers([chosen(found, criteria, ratio) for ratio in (0.5, 2.0)], Units())
    assert len(texts) == 2
    for text in texts:
        assert "f = 0.25" in text
