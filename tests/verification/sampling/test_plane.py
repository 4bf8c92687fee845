"""What is drawn below the contact: the very stresses of the Solutions, kept to nine digits and checked."""

import numpy as np
import pytest

from verification.problem.quantity import IN_PLANE
from verification.running.stored_fields import read_plane, write_plane
from verification.sampling.stress_plane import StressPlane, depths_of, sample_plane
from verification.sources.references.hertz import Hertz

STEEL = Hertz(10e-3, 20.0, 210e9, 0.3)


@pytest.fixture(scope="module")
def plane():
    return sample_plane((), {"fem_reference": STEEL, "hertz": STEEL})


def test_stresses_are_those_of_the_solution(plane):
    assert list(plane.stress) == ["fem_reference"]
    (sigma,), (z,) = plane.stress["fem_reference"], plane.depths
    expected = STEEL.stress(plane.x[None, :], 0.0, z[:, None])
    for number, component in enumerate(IN_PLANE.values()):
        np.testing.assert_array_equal(sigma[number], expected[component])
    assert z[0] == 0
    assert np.abs(plane.x).max() > STEEL.contact_radius


def test_each_layer_has_both_its_interfaces():
    a, interfaces = 1.0, (0.1, 0.4)
    refinements = depths_of(a, interfaces, 12)
    assert len(refinements) == 3
    assert [z[0] for z in refinements] == [0.0, 0.1, 0.4]
    assert [z[-1] for z in refinements[:2]] == [0.1, 0.4]
    assert all((np.diff(z) > 0).all() and z.size >= 4 for z in refinements)
    # An interface below the drawing ends nothing.
    assert len(depths_of(a, (50.0,), 12)) == 1


def test_a_plane_comes_back_as_it_was_written_nan_too(tmp_path, plane):
    spoiled = plane.stress["fem_reference"][0].copy()
    spoiled[0, 2, 3], spoiled[1, 0, 0] = np.nan, -np.inf
    kept = StressPlane(
        plane.x, plane.depths, plane.radius, {"fem_reference": (spoiled,)}, {"semianalytic": "why"}
    )
    write_plane(tmp_path / "planes" / "x.json", kept, "the case")
    back = read_plane(tmp_path / "planes" / "x.json", "the case")
    np.testing.assert_array_equal(back.x, plane.x)
    np.testing.assert_allclose(
        back.stress["fem_reference"][0], spoiled, rtol=0, atol=1e-9 * STEEL.peak_pressure
    )
    assert (back.radius, back.failures) == (plane.radius, {"semianalytic": "why"})
