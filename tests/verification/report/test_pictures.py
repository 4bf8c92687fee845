"""Pictures of the stresses below the contact: true to the plane, drawn whatever its numbers."""

from dataclasses import replace

import numpy as np
import pytest
from synthetic_results import INFO, STEEL, contact, result_of

from verification.report.figures.field_pictures import THINNEST, Frame, pictures, plane_difference, rasterised
from verification.report.report_material import ReportMaterial
from verification.report.report_page import render
from verification.sampling.stress_plane import StressPlane, sample_plane
from verification.sources.references.hertz import Hertz

HERTZ = Hertz(10e-3, 20.0, *STEEL)
RESULT = result_of(contact(), name="bare", points=31)
SCALES = RESULT.problem["a_h"], RESULT.problem["p_h"]


@pytest.fixture(scope="module")
def plane() -> StressPlane:
    found = sample_plane((), {"fem_reference": HERTZ})
    (sigma,) = found.stress["fem_reference"]
    return replace(found, stress={"semianalytic": (sigma + 1e-5 * HERTZ.peak_pressure,)} | found.stress)


def test_a_raster_keeps_the_values_and_the_jump():
    x, depths = np.linspace(-1, 1, 41), (np.linspace(0, 0.5, 6), np.linspace(0.5, 1, 6))
    frame = Frame(1.0, 1.0, (0.5,), 0.7)
    raster = rasterised(x, depths, [np.add.outer(depths[0], x), 10 + np.add.outer(depths[1], x)], frame)
    rows = (np.arange(frame.rows) + 0.5) / frame.rows
    columns = 2 * (np.arange(raster.shape[1]) + 0.5) / raster.shape[1] - 1
    expected = np.add.outer(rows, columns) + np.where(rows > 0.5, 10.0, 0.0)[:, None]
    np.testing.assert_allclose(raster, expected, rtol=0, atol=1e-9)


def test_each_stress_has_its_difference_below(plane):
    found = pictures(plane, *SCALES)
    assert len(found["panels"]) == 6
    assert "1.0e-5" in found["panels"][4].note
    assert "stroke: var(--cap)" in found["panels"][0].figure
    assert plane_difference(plane, HERTZ.peak_pressure) == pytest.approx(1e-5, rel=1e-6)


def test_a_thin_layer_is_drawn_thick_enough_to_be_seen():
    frame = Frame(1.0, 1.0, (0.01, 0.02), 0.7)
    assert frame.stretched
    assert np.diff(frame.shares) == pytest.approx([THINNEST, THINNEST, 1 - 2 * THINNEST])
    assert frame.place(0.005) == pytest.approx(THINNEST / 2)
    depths = (np.linspace(0, 0.01, 6), np.linspace(0.01, 0.02, 6), np.linspace(0.02, 1, 6))
    x = np.linspace(-1, 1, 5)
    raster = rasterised(x, depths, [np.full((6, 5), float(k)) for k in range(3)], frame)
    assert [(raster == k).mean() for k in range(2)] == pytest.approx([THINNEST] * 2, abs=0.02)
    assert not Frame(1.0, 1.0, (0.5,), 0.7).stretched


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_field_that_is_not_finite_still_gives_a_page(plane, bad):
    sigma = plane.stress["fem_reference"][0].copy()
    sigma[:, 3, 3] = bad
    spoiled = replace(plane, stress=plane.stress | {"fem_reference": (sigma,)})
    text = render(ReportMaterial([RESULT], INFO, planes={"bare": spoiled}))
    assert 'class="figure field"' in text


def test_a_method_without_a_picture_is_said_and_no_plane_is_no_picture(plane):
    one = {"fem_reference": plane.stress["fem_reference"]}
    alone = replace(plane, stress=one, failures={"semianalytic": "no <b>"})
    found = pictures(alone, *SCALES)
    assert len(found["panels"]) == 3
    assert plane_difference(alone, 1.0) is None
    assert "No picture by semi-analytical" in render(ReportMaterial([RESULT], INFO, planes={"bare": alone}))
    assert pictures(None, *SCALES) is None
    assert pictures(StressPlane(np.zeros(0), (), 0.0, {}, {}), *SCALES) is None
