"""The worked examples print what their text states."""

import re

import pytest

from verification.manual.tour_output import worked


@pytest.mark.slow
@pytest.mark.parametrize("number", [1, 2])
def test_residual_compression_takes_the_tension_of_the_coating(number):
    found = re.search(r"sigma_1 +coating 1 +(\S+)", worked(number))
    assert 0 <= float(found[1]) < 5.0


@pytest.mark.slow
def test_silver_is_warned_of():
    assert "coating 1, yield_strength = 100 MPa" in " ".join(worked(3).split())
