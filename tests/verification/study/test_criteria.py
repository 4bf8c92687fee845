"""Which thickness is preferable, from curves whose answer is known; probabilities where strengths scatter."""

from pathlib import Path

import numpy as np
import pytest
import study_table
from scipy.integrate import quad
from scipy.special import ndtr

from verification.cases.toml_file import CaseError
from verification.cases.unit_numbers import Units
from verification.study.choice.failure_criteria import Criteria, LogNormal, Uniform, strength_of
from verification.study.choice.thickness_choice import DRAWN, HALVED, choice, sampled
from verification.study.pages.thickness_page import answers, rounded
from verification.study.study_plan import parse_study
from verification.study.study_table import read_columns
from verification.study.thickness_curves import cross_checks, curves


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    path = tmp_path_factory.mktemp("study") / "study.parquet"
    study_table.write(path, checked=3e-4)
    return curves(read_columns(path))


def chosen(curve, criteria):
    return choice([curve], criteria)


def ends(curve, criteria):
    """The ends of the one admissible range."""
    ((low, high),) = chosen(curve, criteria).ranges
    return low.h, high.h


def of_modulus(found, criteria, ratio=2.0):
    """The choice from the curves of every friction."""
    return choice([c for c in found if c.ratio == ratio], criteria)


def test_without_strengths_the_preferable_thickness_has_the_smallest_largest_stress(found):
    curve = found[3]
    one = chosen(curve, Criteria(minimise=["sigma_xx_surface"]))
    # the law has its minimum at h = a_h / 2; nine points on two decades read it this closely
    assert one.best == pytest.approx(0.5, rel=0.02)
    assert one.least == pytest.approx(0.35 * 2, rel=1e-3)
    assert one.governing(one.best)[0] == "sigma_xx_surface"


def test_safety_narrows_the_range_as_a_weaker_material_would(found):
    strength = {"sigma_xx_surface": 0.9 * study_table.P_H}
    weaker = {"sigma_xx_surface": 0.9 * study_table.P_H / 1.2}
    safe, weak = (
        ends(found[3], c) for c in (Criteria(strength=strength, safety=1.2), Criteria(strength=weaker))
    )
    np.testing.assert_allclose(safe, weak, rtol=1e-12)


def test_the_governing_mode_is_the_one_closest_to_its_strength(found):
    curve = found[3]
    p_h = study_table.P_H
    one = chosen(curve, Criteria(strength={"sigma_xx_surface": p_h, "von_mises_coating": p_h}))
    governing = one.use[0].argmax(axis=0)
    # thin: von Mises 0.6 ratio (1 + f) e^-h = 1.5 beats the surface's 0.9; thick: it is gone
    assert one.modes[governing[0]] in ("von_mises_coating", "sigma_xx_surface")
    dense = {mode: study_table.stress(mode, curve.ratio, one.h, curve.friction) for mode in one.modes}
    exact = np.argmax([dense[mode] for mode in one.modes], axis=0)
    # the modes change where the curves cross, read to a part in a hundred of the sweep
    assert (exact != governing).mean() < 0.01


def test_reading_error_bounds_what_a_curve_read_between_its_points_is_off_by(found):
    one = chosen(found[3], Criteria(minimise=["sigma_xx_surface"]))
    exact = study_table.stress("sigma_xx_surface", 2.0, one.h, 0.25)
    assert 0 < np.abs(one.largest - exact).max() < HALVED * one.error


def test_uncertain_stress_shrinks_what_is_surely_admissible(found):
    curve = found[3]
    blurred = type(curve)(
        **{**vars(curve), "uncertainty": {q: np.full(curve.h.size, 0.05) for q in curve.uncertainty}}
    )
    strength = Criteria(strength={"sigma_xx_surface": 0.9 * study_table.P_H})
    (low, high), (sure_low, sure_high) = ends(curve, strength), ends(blurred, strength)
    assert low < sure_low < sure_high < high


def test_differences_name_the_worst_point(tmp_path):
    study_table.write(tmp_path / "s.parquet", checked=3e-4)
    found = cross_checks(read_columns(tmp_path / "s.parquet"))
    assert {d.source for d in found} == {"fem_reference"}
    for d in found:
        assert d.largest == pytest.approx(
            0.0 if d.quantity in ("peak_pressure", "contact_radius", "approach") else 3e-4
        )


def test_recommended_is_what_is_admissible_at_every_friction(found):
    criteria = Criteria(strength={"sigma_xx_surface": 0.9 * study_table.P_H})
    one = of_modulus(found, criteria)
    (answer,) = answers([one], Units())
    # f = 0.25 is the harder one: (0.1 + f) E1/E2 (1 + log(2 h)^2 / 4) = 0.9
    reach = np.exp(2 * np.sqrt(0.9 / 0.7 - 1))
    low, high = one.ranges[0]
    for end, exact in ((low, 0.5 / reach), (high, 0.5 * reach)):
        assert abs(end.h - exact) <= end.uncertainty < 0.1 * exact
        assert (end.mode, end.friction) == ("sigma_xx_surface", 0.25)
    assert answer.count("f = 0.25") == 2
    assert "0.78" in answer


def test_equally_good_thicknesses_are_those_within_the_tolerance(found):
    one = of_modulus(found, Criteria(minimise=["sigma_xx_surface"]))
    # 1 + log(2 h)^2 / 4 = 1 + tolerance
    reach = np.exp(2 * np.sqrt(one.tolerance))
    low, high = one.even
    for end, exact in ((low, 0.5 / reach), (high, 0.5 * reach)):
        assert abs(end.h - exact) <= max(end.uncertainty, 0.02 * exact)
    (answer,) = answers([one], Units())
    assert f"{np.ceil(100 * one.tolerance):.0f} %" in answer


def test_no_number_is_finer_than_the_first_digit_of_its_uncertainty():
    """A limit is rounded to the side asked for, by less than a step; a number has two digits at most."""
    random = np.random.default_rng(5)
    for value, U in 10.0 ** random.uniform(-3, 3, size=(200, 2)):
        below, near, above = (rounded(value, U, upwards) for upwards in (False, None, True))
        step = max(U, 10.0 ** (np.floor(np.log10(value)) - 1))
        assert 0 < float(below) <= float(near) <= float(above)
        assert float(below) <= value * (1 + 1e-9) or value < U
        assert float(above) >= value * (1 - 1e-9)
        assert float(above) - float(below) <= 10 * step
        assert len(near.replace(".", "").strip("0")) <= 2
    assert [rounded(*one) for one in ((41.9, 3.0, False), (950.0, 400.0, True))] == ["41", "1000"]


SIGMAS = 4.0  # of sampling, 0.5/sqrt(DRAWN) each
CLOSE = SIGMAS * 0.5 / np.sqrt(DRAWN)


def strength(given):
    return strength_of(given, Units().shown_stress)


def uniform(low, high):
    return strength(Uniform(**{"from": low, "to": high}))


def log_normal(mean, deviation):
    return strength(LogNormal(mean=mean, standard_deviation=deviation))


def test_log_normal_strength_has_its_mean_and_standard_deviation():
    one = log_normal(2e9, 0.4e9)
    moments = [quad(lambda p, k=k: float(one.quantile(p)) ** k, 0, 1, epsrel=1e-10)[0] for k in (1, 2)]
    assert moments[0] == pytest.approx(2e9, rel=1e-8)
    assert np.sqrt(moments[1] - moments[0] ** 2) == pytest.approx(0.4e9, rel=1e-6)


def test_governing_probability_of_two_log_normal_strengths():
    # s1/S1 > s2/S2 is log-normal: P = Phi(ln(s1 m2 / s2 m1) / sqrt(v1 + v2)), m the medians
    strengths = {"a": log_normal(2e9, 0.4e9), "b": log_normal(1e9, 0.1e9)}
    medians = [float(one.quantile(0.5)) for one in strengths.values()]
    variances = [np.log(1 + 0.2**2), np.log(1 + 0.1**2)]
    stress = np.array([[1.5e9, 2e9, 2.4e9], [0.9e9, 0.9e9, 0.9e9]])
    exact = ndtr(np.log(stress[0] / stress[1] * medians[1] / medians[0]) / np.sqrt(sum(variances)))
    found = sampled(stress, strengths)
    np.testing.assert_allclose(found.governs[0], exact, atol=CLOSE)
    np.testing.assert_allclose(found.governs.sum(axis=0), 1.0)


def test_failure_probability_is_that_of_independent_strengths():
    strengths = {"a": uniform(1e9, 2e9), "b": log_normal(1e9, 0.2e9), "c": strength(3e9)}
    stress = np.array([[1.2e9, 1.9e9, 0.5e9], [0.8e9, 0.1e9, 0.9e9], [1e9, 1e9, 3.1e9]])
    median, s = 1e9 / np.sqrt(1.04), np.sqrt(np.log(1.04))
    shares = [np.clip(stress[0] / 1e9 - 1, 0, 1), ndtr(np.log(stress[1] / median) / s), stress[2] > 3e9]
    found = sampled(stress, strengths)
    np.testing.assert_allclose(found.fails, 1 - np.prod(1 - np.array(shares), axis=0), atol=CLOSE)
    np.testing.assert_allclose(found.breaks.sum(axis=0), found.fails)


def test_the_fractile_counts_and_the_answer_names_the_share_of_failures(found):
    scattered = Criteria(
        strength={
            "sigma_xx_surface": LogNormal(mean=1.2e9, standard_deviation=0.12e9),
            "von_mises_coating": Uniform(**{"from": 1.2e9, "to": 1.4e9}),
        }
    )
    fixed = Criteria(strength=scattered.strengths(study_table.P_H))
    one, same = of_modulus(found, scattered), of_modulus(found, fixed)
    assert [end and end.h for end in one.ranges[0]] == [end and end.h for end in same.ranges[0]]
    (answer,) = answers([one], Units())
    assert "f = 0.25" in answer
    # at the limit the governing mode fails as often as the fractile says
    limit = one.ranges[0][0]
    breaks = one.chances(np.array([limit.h])).breaks[one.modes.index(limit.mode), 0]
    assert breaks == pytest.approx(0.05, abs=CLOSE)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ('{ from = "2 GPa", to = "1 GPa" }', "sigma_xx_base, range"),
        ('{ mean = "2 GPa" }', "standard_deviation"),
        ('{ mean = "2 GPa", standard_deviation = "3 GPa" }', "exceeds"),
        ('{ mean = "2 m", standard_deviation = "3 GPa" }', "stress"),
        ("{ from = 1e9 }", "missing"),
        ('"strong"', "number"),
        ("-1e9", "sigma_xx_base"),
        ("[1e9, 2e9]", "sigma_xx_base"),
    ],
)
def test_bad_strength_is_one_message_with_its_key(given, message):
    text = f"{study_table.TEXT}[criteria.strength]\nsigma_xx_base = {given}\n"
    with pytest.raises(CaseError) as error:
        parse_study(text.encode(), Path("mine.toml"))
    assert message in str(error.value)
    assert "criteria, strength, sigma_xx_base" in str(error.value)
    assert "\n" not in str(error.value)


def test_implausible_strengths_name_the_likely_unit():
    text = f"{study_table.TEXT}[criteria.strength]\nsigma_xx_base = {{ from = 1.5, to = 2.0 }}\n"
    study = parse_study(text.encode(), Path("mine.toml"))
    (warning,) = study.warnings
    assert "criteria.strength.sigma_xx_base.from" in warning
    assert "GPa" in warning


def test_units_of_results_are_those_of_thickness_and_strength():
    text = study_table.TEXT.replace(
        "thickness_over_a_h = { from = 0.05, to = 5.0, count = 9 }",
        'thickness = { from = "5000 nm", to = "9000 nm", count = 9 }',
    )
    text += '[criteria.strength]\nsigma_xx_base = { mean = "2 GPa", standard_deviation = "0.2 GPa" }\n'
    units = parse_study(text.encode(), Path("mine.toml")).units
    assert (units.length, units.metre, units.stress, units.pascal) == ("nm", 1e-9, "GPa", 1e9)
    assert parse_study(study_table.TEXT.encode(), Path("mine.toml")).units == Units()
