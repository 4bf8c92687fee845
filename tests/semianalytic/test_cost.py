"""Cost of the patches counted without a clock: iterations, convolutions."""

import pytest

import semianalytic


def diagnostics(patches, ratio, h):
    """Of a sphere on a coating ``ratio`` times as stiff as its substrate; lengths in contact radii."""
    return semianalytic.indent(
        profile=lambda x, y: (x**2 + y**2) / 2,
        half_width=2 * max(1.0, ratio ** (-1 / 3)),
        load=4 / 3,
        coatings=((ratio, 0.0, h),),
        substrate=(1.0, 0.0),
        patches=patches,
        tolerance=8e-7,
        estimate_uncertainty=False,
        edge_correction=False,
    ).diagnostics


def check(patches, ratios, thicknesses):
    bare = diagnostics(patches, 1.0, thicknesses[0]).iterations
    found = [diagnostics(patches, ratio, h) for ratio in ratios for h in thicknesses]
    assert max(one.iterations for one in found) <= 1.5 * bare
    assert max(one.convolutions for one in found) <= 16


def test_coated_solids_take_about_the_iterations_of_the_homogeneous():
    check(128, (0.1, 10.0), (0.05,))


@pytest.mark.slow
@pytest.mark.parametrize("patches", [256, 512, 1024])
def test_coated_solids_take_about_the_iterations_of_the_homogeneous_over_the_range(patches):
    check(patches, (0.1, 0.25, 0.5, 2.0, 4.0, 10.0), (0.05, 0.1, 0.3, 1.0, 3.0))
