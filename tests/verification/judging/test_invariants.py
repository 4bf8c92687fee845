"""What a sound solution satisfies, and which law each kind of slip breaks."""

import functools
from dataclasses import replace

import numpy as np
import pytest
from altered_source import Altered

import fem_reference
import semianalytic
from verification.judging.invariant_verdict import decide
from verification.judging.invariants import check, indenter_gap, resolved
from verification.judging.invariants.central_differences import Stencil
from verification.judging.invariants.thickness_limits import thick_shift, thin_shift
from verification.judging.verdict import Outcome
from verification.problem.coated_contact import CoatedContact, keywords
from verification.sources.references import integral_equation
from verification.sources.references.hertz import Hertz
from verification.sources.references.hertz_ellipse import pressed_ellipsoid
from verification.sources.source_registry import solvers

STEEL = (210e9, 0.3)
BARE = CoatedContact(10e-3, 20.0, (), STEEL)
SLIDING = CoatedContact(10e-3, 20.0, ((840e9, 0.25, 0.8 * BARE.a_h),), STEEL, 0.25)


@functools.cache
def exact(problem=SLIDING):
    return integral_equation.solve(**keywords(problem))


@functools.cache
def finite_elements():
    return fem_reference.solve(**keywords(SLIDING), size=0.18)


def rows(solution, problem=SLIDING, source="integral_equation"):
    return {row.name: row for row in check(solution, source, problem)}


def broken(solution, problem=SLIDING, source="integral_equation"):
    return {name for name, row in rows(solution, problem, source).items() if row.outcome is Outcome.DISAGREES}


@pytest.mark.parametrize(
    ("solution", "problem", "count"),
    [
        (Hertz(BARE.radius, BARE.load, *STEEL), BARE, 10),
        (Hertz(BARE.radius, BARE.load, *STEEL, 0.25), replace(BARE, friction=0.25), 10),
        (exact, SLIDING, 14),
    ],
)
def test_exact_solutions_hold_every_law_that_they_claim(solution, problem, count):
    found = check(solution() if callable(solution) else solution, "exact", problem)
    assert len(found) == count
    assert {row.outcome for row in found} == {Outcome.AGREES}
    # exact, so only the error of the differences is left in the bound
    differences = ("equilibrium", "Hooke's law", "bonded displacements")
    assert all(row.bound < 1e-9 for row in found if not row.name.startswith(differences))
    assert all(row.bound < 1e-5 for row in found)


def test_both_methods_hold_every_law_and_claim_their_displacements_too():
    for source, solution in (
        ("fem_reference", finite_elements()),
        ("semianalytic", semianalytic.solve(**keywords(SLIDING))),
    ):
        found = rows(solution, source=source)
        assert {row.outcome for row in found.values()} == {Outcome.AGREES}, source
        assert {"sphere", "bonded displacements, interface 1", "Hooke's law, substrate"} <= set(found)
        assert found["reciprocity of load and sliding"].value < 1e-6
        assert ("influence coefficients" in found) == (source == "semianalytic")


def slip(change):
    """A stress changed by ``change``, which takes the sound one and the point."""
    return {"stress": lambda s, x, y, z, layer=None: change(s, x, y, np.asarray(z), layer)}


def twisted(s, x, y, z, layer):
    """A second harmonic of sigma_zz alone."""
    sigma = s(x, y, z, layer)
    sigma[2, 2] += 1e-4 * BARE.p_h * np.cos(2 * np.arctan2(y, x))
    return sigma


@pytest.mark.parametrize(
    ("change", "law"),
    [
        ({"pressure": lambda p, x, y=0.0: 1.005 * p(x, y)}, "load balance"),
        ({"pressure": lambda p, x, y=0.0: p(x, y) + 1e-4 * BARE.p_h}, "free surface"),
        (slip(lambda s, x, y, z, layer: s(x, y, z + 0.01 * BARE.a_h, None)), "surface pressure"),
        (
            slip(lambda s, x, y, z, layer: s(x, y, z, layer) * (1 + 0.01 * z / BARE.a_h)),
            "equilibrium, substrate",
        ),
        (slip(lambda s, x, y, z, layer: s(-np.asarray(x), y, z, layer)), "equilibrium, coating 1"),
        (slip(lambda s, x, y, z, layer: s(x, y, z, layer) * (1 + 1e-3 * np.sign(y))), "mirror in y"),
        (slip(twisted), "harmonics round the axis"),
        (
            slip(lambda s, x, y, z, layer: s(x, y, z, layer) * (1 + 1e-6 * (layer == 1))),
            "bonded tractions, interface 1",
        ),
    ],
)
def test_each_slip_breaks_the_law_that_speaks_of_it(change, law):
    assert law in broken(Altered(exact(), **change))


@pytest.mark.parametrize(
    ("change", "law"),
    [
        (lambda u, x, y, z: 1.05 * u(x, y, z), "Hooke's law, coating 1"),
        (lambda u, x, y, z: 1.001 * u(x, y, z), "sphere"),
        (
            lambda u, x, y, z: u(x, y, z) + 1e-3 * BARE.delta_h * (np.asarray(z) > SLIDING.interfaces[0]),
            "bonded displacements, interface 1",
        ),
        (
            lambda u, x, y, z: u(x, y, z) * np.array([1.1, 1, 1]).reshape(3, *[1] * np.ndim(x)),
            "reciprocity of load and sliding",
        ),
    ],
)
def test_displacements_that_slip_break_their_laws(change, law):
    assert law in broken(Altered(finite_elements(), displacement=change), source="fem_reference")


@pytest.mark.parametrize("name", ["pressure", "stress", "pressure_uncertainty", "stress_uncertainty"])
def test_number_that_is_none_is_never_agreement(name):
    def spoilt(field, *args, **keys):
        return field(*args, **keys) * np.nan

    found = rows(Altered(exact(), **{name: spoilt}))
    spoken = [row for row in found.values() if row.outcome is not Outcome.AGREES]
    assert spoken
    assert {row.outcome for row in spoken} == {Outcome.NO_RESULT}
    assert found["surface pressure"].outcome is Outcome.NO_RESULT


def test_law_that_cannot_be_evaluated_is_no_result_with_its_sentence_and_the_others_go_on():
    def fails(*_, **__):
        raise RuntimeError("no such plane")

    found = rows(Altered(exact(), stress=fails))
    assert found["load balance"].outcome is Outcome.AGREES
    lost = [row for row in found.values() if row.outcome is Outcome.NO_RESULT]
    assert lost
    assert all("no such plane" in row.message for row in lost)


def test_without_a_stated_uncertainty_no_law_is_held():
    found = check(Altered(exact(), stated=False), "exact", SLIDING)
    assert {row.outcome for row in found} == {Outcome.INCONCLUSIVE}


def test_uncertainty_blown_up_is_inconclusive_not_agreement():
    def vast(field, *args, **keys):
        return field(*args, **keys) + 0.01 * BARE.p_h

    found = rows(Altered(exact(), stress_uncertainty=vast))
    assert found["surface pressure"].outcome is Outcome.INCONCLUSIVE
    assert found["harmonics round the axis"].outcome is Outcome.INCONCLUSIVE


def test_error_within_the_uncertainties_that_enter_breaks_no_law():
    size = 1e-6 * BARE.p_h * np.array([[1, 1, 3], [1, 1, 1], [3, 1, 1]])

    def more(field, x, y, z, layer=None):
        angle = np.arctan2(*np.broadcast_arrays(y, x))
        return field(x, y, z, layer) + np.multiply.outer(size, (angle >= 0) & (angle < np.pi / 4))

    off = Altered(exact(), stress=more)
    assert {"surface shear", "mirror in y", "harmonics round the axis"} <= broken(off)
    found = rows(Altered(exact(), stress=more, stress_uncertainty=more))
    for name in ("surface shear", "mirror in y", "harmonics round the axis"):
        assert found[name].outcome is Outcome.AGREES, found[name]


def test_load_is_bounded_by_the_change_of_companions_next_to_the_edge():
    def vast(U, x, y=0.0):
        return U(x, y) + BARE.p_h * (np.hypot(x, y) > 0.96 * SLIDING.a_h)

    problem = replace(SLIDING, coatings=())
    found = semianalytic.solve(**keywords(problem), patches=129)
    row = rows(Altered(found, pressure_uncertainty=vast), problem, "semianalytic")["load balance"]
    assert row.outcome is Outcome.AGREES


def test_law_is_decided_where_the_residual_takes_the_largest_share_of_its_bound():
    row = decide("law", "me", "it holds", [1e-3, 1e-6], [2e-3, 2e-7])
    assert row.outcome is Outcome.DISAGREES
    assert (row.value, row.bound) == (1e-6, pytest.approx(2e-7, rel=1e-4))
    assert row.share == pytest.approx(5, rel=1e-4)
    assert decide("law", "me", "it holds", [], []).outcome is Outcome.NO_RESULT


def test_error_of_differences_lies_within_its_bound_and_a_polynomial_has_none():
    stencil = Stencil(np.array([[0.3], [0.4], [0.5]]), np.full((3, 1), 0.02))
    x, y, z = stencil.points
    values = np.stack([np.sin(2 * x) * np.exp(-z) * np.cos(y), x**5 * y + z**6])
    slope, error = stencil.gradient(values)
    true = np.array(
        [
            [2 * np.cos(0.6) * np.exp(-0.5) * np.cos(0.4), 5 * 0.3**4 * 0.4],
            [-np.sin(0.6) * np.exp(-0.5) * np.sin(0.4), 0.3**5],
            [-np.sin(0.6) * np.exp(-0.5) * np.cos(0.4), 6 * 0.5**5],
        ]
    )
    assert (np.abs(slope[..., 0] - true) <= error[..., 0] + 1e-13).all()
    assert np.abs(slope[..., 0] - true).max() < 1e-9


def test_propagated_uncertainty_bounds_the_gradient_of_any_error_within_it():
    random = np.random.default_rng(1)
    stencil = Stencil(np.array([[0.3, 1.0], [0.4, 1.0], [0.5, 2.0]]), np.full((3, 2), 0.02))
    U = random.uniform(0, 1, (4, stencil.points.shape[1]))
    for _ in range(20):
        slope, _ = stencil.gradient(U * random.uniform(-1, 1, U.shape))
        assert (np.abs(slope) <= stencil.propagated(U)).all()


def test_base_of_a_thick_coating_sinks_as_the_exact_solution_says():
    alone = CoatedContact(10e-3, 20.0, (), (840e9, 0.3))
    thick = replace(alone, coatings=((840e9, 0.3, 10 * alone.a_h),), substrate=STEEL)
    sink, left = thick_shift(thick, alone)
    found = integral_equation.solve(**keywords(thick), estimate_uncertainty=False)
    assert 1e-6 < left < 2e-3
    assert abs(found.approach - sink - alone.delta_h) <= left * alone.delta_h
    assert abs(sink) > 50 * left * alone.delta_h


def test_thin_coating_changes_the_approach_by_the_first_order_of_perturbation():
    thin = replace(BARE, coatings=((840e9, 0.3, 0.03 * BARE.a_h),))
    first = thin_shift(thin) / BARE.delta_h
    found = integral_equation.solve(**keywords(thin), estimate_uncertainty=False)
    assert -0.02 < first < -0.005
    assert abs(found.approach / BARE.delta_h - 1 - first) <= 2 * first**2


@pytest.mark.slow
def test_invariants_between_solutions_hold_for_both_methods():
    found = resolved(SLIDING, solvers())
    assert len(found) == 10
    assert {row.outcome for row in found} == {Outcome.AGREES}


def test_the_load_of_an_exact_ellipse_balances_at_any_ratio_of_its_axes():
    """Twice as many rings as it had failed one ratio of these sixty, by their quadrature alone."""
    for ratio in np.linspace(1.05, 8, 60):
        radii = (16e-3 * ratio, 16e-3)
        problem = CoatedContact(
            float(np.prod(radii) ** 0.5), 20.0, (), (210e9, 0.3), indenter=("ellipsoid", radii)
        )
        found = indenter_gap.load_balance(pressed_ellipsoid(*radii, 20.0, 210e9, 0.3), "exact", problem)
        assert found.outcome is Outcome.AGREES
        assert found.value < 1e-4
