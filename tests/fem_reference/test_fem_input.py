"""Bad and hopeless input is refused with a message of one line that names the quantity."""

import re

import numpy as np
import pytest

from fem_reference import ElementsNotConverged, element_numbers, solve
from fem_reference.contact_solver import _size
from fem_reference.element_numbers import CONTRASTS, QUALITY
from verification.problem.point_answers import Points

E = 210e9
# scalars of numpy are as good as floats
GOOD = {
    "radius": np.float64(1e-2),
    "load": np.float64(20.0),
    "coatings": (),
    "substrate": (E, np.float64(0.3)),
}
CHEAP = {"size": 0.5, "order": 2}

BAD = [
    ({"substrate": (E, 0.5)}, "nu of the substrate = 0.5"),
    ({"coatings": ((E, 0.5, 1e-5),)}, "nu of coating 1 = 0.5"),
    ({"coatings": ((E, 0.3, 1e-5), (E, 0.3, -1e-5))}, "thickness of coating 2"),
    ({"coatings": ((E, 0.3, 1e-5),) * 2000}, "2000 coatings"),
    ({"coatings": ((2e9 * E, 0.3, 1e-5),)}, "E of coating 1"),
    ({"coatings": ((E, 0.3, 1e-12),)}, "thin"),
    ({"coatings": ((E, 0.3, 10.0),)}, "substrate"),
    ({"ball": (E, 0.3)}, "(E, nu, coatings)"),
    ({"ball": (E, 0.5, ())}, "nu of the substrate = 0.5"),
    ({"ball": (E, 0.3, ((E, 0.3, 10.0),))}, "ball"),
    ({"order": 5}, "order = 5"),
    ({"quality": "superb"}, "quality = 'superb'"),
    ({"size": 2.0}, "size = 2"),
    ({"far": 5.0}, "far boundary"),
    ({"load": 1e9}, "radius"),
    ({"radius": "10 mm"}, "radius"),
]


@pytest.mark.parametrize(("change", "message"), BAD, ids=range(len(BAD)))
def test_bad_input_is_refused_in_one_line(change, message):
    with pytest.raises(ValueError, match=re.escape(message)) as caught:
        solve(**{**GOOD, **CHEAP, **change})
    assert "\n" not in str(caught.value)


def test_too_few_iterations_raise_an_error_that_states_what_was_reached(monkeypatch):
    monkeypatch.setattr(element_numbers, "MOST_STEPS", 1)
    with pytest.raises(ElementsNotConverged, match=r" 1 solves.*moduli"):
        solve(**{**GOOD, "coatings": ((4 * E, 0.3, 5e-5),)})


@pytest.fixture(scope="module")
def coated():
    return solve(**{**GOOD, "coatings": ((2 * E, 0.3, 4e-5),)}, **CHEAP, estimate_uncertainty=False)


@pytest.mark.parametrize(
    ("point", "message"),
    [
        ({"z": -1e-6}, "z = "),
        ({"z": float("nan")}, "nan"),
        ({"z": 1.0}, "beyond"),
        ({"z": 5e-5, "layer": 0}, "layer 0"),
        ({"z": 1e-5, "layer": 1}, "layer 1"),
        ({"z": 1e-5, "layer": 2}, "0 to 1"),
    ],
)
def test_points_outside_the_solid_or_the_layer_are_refused(coated, point, message):
    with pytest.raises(ValueError, match=message):
        coated.stress(0.0, 0.0, **point)


def test_points_within_rounding_of_the_interface_lie_on_it(coated):
    h = 4e-5
    for z in (h * (1 - 5e-10), h, h * (1 + 5e-10)):
        upper, lower = (coated.stress(1e-5, 0.0, z, layer=k) for k in (0, 1))
        assert abs(upper[0, 0] - lower[0, 0]) > 0.01 * coated.peak_pressure
        assert (coated.stress(1e-5, 0.0, z) == upper).all()


def test_an_uncertainty_that_is_not_estimated_is_none(coated):
    assert coated.uncertainty is None
    for quantity in ("pressure", "stress", "displacement", "approach", "stiffness"):
        assert coated.sample(Points(0.0), quantity).uncertainty is None, quantity


def test_shapes_follow_broadcasting(coated):
    assert coated.stress(0.0, 0.0, 0.0).shape == (3, 3)
    assert coated.stress([[0.0], [1e-5]], 0.0, [1e-5, 2e-5, 3e-5]).shape == (3, 3, 2, 3)
    assert coated.displacement([0.0, 1e-5], 0.0, 1e-5).shape == (3, 2)
    assert coated.pressure(0.0).shape == ()
    assert coated.pressure([[0.0, 1.0]], [[0.0], [1.0]]).shape == (2, 2)


@pytest.mark.parametrize("quality", QUALITY)
def test_triangles_are_finer_next_to_a_larger_step_of_the_moduli(quality):
    def size(step, ball=()):
        return _size(quality, None, [((step * E, 0.3, 1e-5), (E, 0.3)), ball])

    steps = (1.0, 20.0, 200.0)
    sizes = [size(step) for step in steps]
    assert sizes == sorted(sizes, reverse=True)
    assert sizes[2] < sizes[1]
    assert [size(1 / step) for step in steps] == [sizes[0]] * 3
    assert [size(1.0, ((step * E, 0.3, 1e-5), (E, 0.3))) for step in steps] == sizes


@pytest.mark.parametrize("size", [0.08, 0.5])
def test_sizes_are_taken_from_minutes_to_coarse(size):
    assert _size(next(iter(QUALITY)), size, ()) == size
    beyond = size * (0.99 if size < 0.1 else 1.01)
    with pytest.raises(ValueError, match=r"0\.08"):
        _size(next(iter(QUALITY)), beyond, ())


def test_a_finer_quality_never_has_larger_triangles():
    for sizes in (QUALITY, *CONTRASTS.values()):
        assert sizes["fast"] >= sizes["default"] >= sizes["fine"]
