"""Strengths that scatter: their distributions, and probabilities of failure modes against closed forms."""

from pathlib import Path

import numpy as np
import pytest
import study_table
from scipy.integrate import quad
from scipy.special import ndtr

from verification.cases.toml_file import CaseError
from verification.cases.unit_numbers import Units
from verification.study.choice.failure_criteria import Criteria, LogNormal, Uniform, strength_of
from verification.study.choice.thickness_choice import DRAWN, choice, sampled
from verification.study.pages.thickness_page import answers
from verification.study.study_plan import parse_study
from verification.study.study_table import read_columns
from verification.study.thickness_curves import curves

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


def test_the_fractile_counts_and_the_answer_names_the_share_of_failures(tmp_path):
    study_table.write(tmp_path / "study.parquet")
    found = [c for c in curves(read_columns(tmp_path / "study.parquet")) if c.ratio == 2.0]
    scattered = Criteria(
        strength={
            "sigma_xx_surface": LogNormal(mean=1.2e9, standard_deviation=0.12e9),
            "von_mises_coating": Uniform(**{"from": 1.2e9, "to": 1.4e9}),
        }
    )
    fixed = Criteria(strength=scattered.strengths(study_table.P_H))
    one = choice([c for c in found], scattered)
    same = choice([c for c in found], fixed)
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
