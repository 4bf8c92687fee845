"""Every source answers the same question: sample(points, quantity)."""

import ast
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import fem_reference
import semianalytic
from verification.guests.doors.serve_function import GuestFields
from verification.problem.coated_contact import CoatedContact, keywords
from verification.problem.either_body import on_body
from verification.problem.point_answers import BALL, EDGE, FIELDS, Points, supported
from verification.sources.limit_extrapolation import Extrapolated
from verification.sources.references import integral_equation
from verification.sources.references.hertz import Hertz
from verification.sources.references.hertz_ellipse import pressed_ellipsoid

STEEL = (210e9, 0.3)
PAIR = CoatedContact(10e-3, 20.0, ((420e9, 0.25, 50e-6),), STEEL, 0.2, (*STEEL, ()))
SCALARS = ("contact_radius", "approach", "peak_pressure", "stiffness")
ROOT = Path(__file__).parents[3]


NAMES = ("patches", "elements", "integral equation", "closed form", "extrapolation", "ball", "another code")


@cache
def sources():
    given = keywords(PAIR)
    patches = semianalytic.solve(**given, patches=65)
    elements = fem_reference.solve(**given, size=0.5)
    exact = integral_equation.solve(**given)
    return {
        "patches": patches,
        "elements": elements,
        "integral equation": exact,
        "closed form": Hertz(PAIR.radius, PAIR.load, *STEEL, 0.2, ball=STEEL),
        "extrapolation": Extrapolated(exact, exact, exact),
        "ball": on_body(patches, BALL),
        "another code": GuestFields({name: getattr(exact, name) for name in (*FIELDS, *SCALARS)}),
    }


@pytest.mark.parametrize("name", NAMES)
def test_a_source_answers_every_field_and_scalar_and_says_so_of_any_other(name):
    source = sources()[name]
    a = source.sample(None, "contact_radius").value
    x, z = a * np.array([[-1.3], [0.2], [0.7]]), np.array([0.0, 30e-6])
    points = SimpleNamespace(**vars(Points(x, 0.1 * a, z, 0)))  # whatever has these attributes
    for field, axes in FIELDS.items():
        value, U = source.sample(points, field)
        # the depth does not count for a pressure
        assert value.shape in ((*axes, 3, 2), (*axes, 3, 1 if field == "pressure" else 2))
        assert U is None or (U.shape == value.shape and (U >= 0).all())
        alone = source.sample(points, field, uncertainty=False)
        np.testing.assert_allclose(alone.value, value, rtol=0, atol=1e-12 * np.abs(value).max())
        assert alone.uncertainty is None
    for scalar in SCALARS:
        value, U = source.sample(None, scalar)
        assert value > 0
        assert U is None or 0 <= U < 1e-2 * value
    assert source.sample(points, "temperature") == (None, None)


def test_at_the_same_share_of_the_way_to_the_edge_its_error_does_not_count():
    source = sources()["patches"]
    a = source.contact_radius * (1 - 1e-5)
    for field, where in (("pressure", ...), ("stress", (0, 0))):
        beside, fixed = (source.sample(Points(a, layer=0, frame=frame), field) for frame in (EDGE, "fixed"))
        np.testing.assert_array_equal(beside.value, fixed.value)
        assert beside.uncertainty[where] < 0.5 * fixed.uncertainty[where]
        mixed = source.sample(Points(np.array([a, a]), layer=0, frame=[EDGE, "fixed"]), field).uncertainty
        both = np.stack([beside.uncertainty, fixed.uncertainty], axis=-1)
        np.testing.assert_allclose(mixed, both, rtol=1e-9)


def test_what_a_closed_form_of_the_contact_alone_leaves_out_is_unsupported():
    ellipse = pressed_ellipsoid(10e-3, 20e-3, 20.0, *STEEL)
    assert ellipse.sample(Points(0.0), "pressure") == (ellipse.peak_pressure, 0.0)
    for quantity in ("stress", "displacement", "stiffness"):
        assert ellipse.sample(Points(0.0), quantity) == (None, None)
    with pytest.raises(ValueError, match="HertzEllipse gives no stress"):
        supported(ellipse, Points(0.0), "stress")


def test_no_source_imitates_another_and_none_has_a_second_way_to_be_asked():
    names = {
        node.name
        for package in ("semianalytic", "fem_reference", "verification")
        for path in (ROOT / package).rglob("*.py")
        for owner in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(owner, ast.ClassDef)
        for node in owner.body
        if isinstance(node, ast.FunctionDef)
    }
    assert "sample" in names
    fields = {f"{field}{end}" for field in FIELDS for end in ("_uncertainty", "_with_uncertainty")}
    assert not names & {"__getattr__", "relative_to_edge", *fields}
