"""The worked examples print what their text states."""

import re

import pytest

from verification.manual.worked import worked_1, worked_2, worked_3


@pytest.mark.slow
@pytest.mark.parametrize(("worked", "limit"), [(worked_1, 5.0), (worked_2, 5.0)])
def test_residual_compression_takes_the_tension_of_the_coating(worked, limit):
    found = re.search(r"sigma_1 +coating 1 +(\S+)", worked())
    assert 0 <= float(found[1]) < limit


@pytest.mark.slow
def test_silver_is_warned_of():
    assert "times coatings.0.yield_strength = 100 MPa: not elastic" in " ".join(worked_3().split())
