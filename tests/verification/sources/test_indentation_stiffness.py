"""A sphere pressed deeper and deeper: its stiffness is that of a flat punch, with the limits of it."""

from dataclasses import replace

import numpy as np
import pytest

import fem_reference
import semianalytic
from verification.problem.coated_contact import keywords
from verification.problem.loading_curve import LoadingCurve
from verification.problem.point_answers import Points
from verification.sources.loading_solution import Loading, exact_loading, loading
from verification.sources.references.flat_punch import pressed

LAYER, RIGID = ((1.0, 0.4, 1.0),), (1e9, 0.3)
CURVE = LoadingCurve(100.0, "contact_radius", (0.4, 1.0), LAYER, RIGID)


def solver(method, **numerics):
    return lambda contact: method.solve(**keywords(contact), **numerics)


METHODS = {
    "semianalytic": solver(semianalytic, patches=129),
    "fem_reference": solver(fem_reference, size=0.27),
}


@pytest.mark.parametrize(
    ("layer", "base"), [((), (2.0, 0.3)), (LAYER, (1.0, 0.4)), (LAYER, RIGID), (LAYER, (0.1, 0.3))]
)
def test_stiffness_of_the_sphere_is_that_of_the_punch(layer, base):
    a, step = 0.7, 1e-4
    low, here, high = (pressed(a * (1 + s), layer, base) for s in (-step, 0.0, step))
    E, nu = layer[0][:2] if layer else base
    S = (high.load - low.load) / (high.approach - low.approach)
    # The difference quotient leaves out the square of the step.
    assert here.kappa * 2 * a * E / (1 - nu**2) == pytest.approx(S, rel=10 * step**2)


@pytest.mark.parametrize("method", METHODS)
def test_both_methods_give_the_exact_curve_within_their_uncertainty(method):
    found = loading(CURVE, METHODS[method], limits=method == "fem_reference")
    exact = exact_loading(CURVE)
    at = np.array(CURVE.at)
    for name in ("kappa", "load", "approach"):
        (value, U), (expected, V) = (one.sample(Points(at), name) for one in (found, exact))
        assert (np.abs(value - expected) <= U + V).all(), name
        # What a mesh of half the usual fineness is good for.
        assert (U / value).max() <= 5e-5, name


def test_a_point_asked_for_is_reached_from_a_load_that_missed_it():
    exact = exact_loading(CURVE)
    a, miss = np.array(CURVE.at), 1e-4
    off = exact_loading(LoadingCurve(100.0, "contact_radius", tuple(a * (1 + miss)), LAYER, RIGID))
    moved = Loading(CURVE, off.state, off.uncertainties, {"contacts": 1})
    for name in ("kappa", "load", "series_over_load"):
        both = (replace(one, series=(1.0,)).sample(Points(a), name) for one in (moved, exact))
        (value, U), (expected, _) = both
        assert (np.abs(value - expected) <= U).all()
        assert (np.abs(value - expected) <= miss * np.abs(value)).all()


@pytest.mark.parametrize("control", ["contact_radius", "approach"])
def test_the_control_is_what_is_asked_for(control):
    curve = LoadingCurve(100.0, control, (0.01, 0.003), LAYER, RIGID)
    value, _ = exact_loading(curve).sample(Points([0.003, 0.01]), control)
    assert value == pytest.approx([0.003, 0.01], rel=1e-10, abs=0)
