"""Answers against closed forms: Hertz, Hamilton, Huber; principal stresses against eigenvalues."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from verification.cases.graded_coating import GradedCourse, moduli
from verification.desk.contact_answer import answer, differences, summary
from verification.problem.coated_contact import CoatedContact
from verification.problem.quantity import first_principal, largest_shear, von_mises
from verification.sources.source_registry import EXACT

BARE = CoatedContact(10e-3, 20.0, (), (210e9, 0.3))
SLIDING = replace(BARE, friction=0.25)
ELASTIC = replace(SLIDING, ball=(310e9, 0.27, ()))
# Two layers of the substrate's own material: the same field, with interfaces in it.
LAYERED = replace(SLIDING, coatings=((210e9, 0.3, 5e-6), (210e9, 0.3, 20e-6)))


@pytest.fixture(scope="module")
def solved():
    return {problem: answer(problem, "semianalytic") for problem in (BARE, SLIDING, ELASTIC, LAYERED)}


def at(found, quantity, where, body="flat"):
    (one,) = [e for e in found.extremes if (e.body, e.quantity, e.where) == (body, quantity, where)]
    return one


def test_size_of_the_contact_is_hertzs(solved):
    for problem, found in solved.items():
        for name, exact in (("peak_pressure", "p_h"), ("contact_radius", "a_h"), ("approach", "delta_h")):
            value, stated = found.numbers[name]
            assert value == pytest.approx(getattr(problem, exact), rel=2e-6)
            assert abs(value - getattr(problem, exact)) <= stated + 1e-12 * value


def trailing_edge(problem, nu):
    """sigma_xx at the trailing edge, p0 ((1 - 2 nu)/3 + f pi (4 + nu)/8). Hamilton and Goodman (1966)."""
    return problem.p_h * ((1 - 2 * nu) / 3 + problem.friction * np.pi * (4 + nu) / 8)


def test_elastic_ball_is_torn_at_its_own_trailing_edge(solved):
    flat, ball = (at(solved[ELASTIC], "sigma_xx", "surface", body) for body in ("flat", "ball"))
    assert flat.value == pytest.approx(trailing_edge(ELASTIC, 0.3), rel=2e-6)
    assert ball.value == pytest.approx(trailing_edge(ELASTIC, 0.27), rel=2e-6)
    assert (flat.x, ball.x) == pytest.approx((-ELASTIC.a_h, ELASTIC.a_h), rel=1e-6)


def on_axis(zeta, nu):
    """sigma_rr and sigma_zz over p0 on the axis of a Hertz contact. Johnson (3.45)."""
    rr = -(1 + nu) * (1 - zeta * np.arctan(1 / zeta)) + 0.5 / (1 + zeta**2)
    return rr, -1 / (1 + zeta**2)


def test_von_mises_on_the_axis_is_hubers(solved):
    best = minimize_scalar(
        lambda zeta: -abs(np.subtract(*on_axis(zeta, 0.3))), bounds=(0.1, 1.0), options={"xatol": 1e-10}
    )
    found = at(solved[BARE], "von_mises", "substrate")
    assert found.value == pytest.approx(-best.fun * BARE.p_h, abs=found.uncertainty)
    assert found.uncertainty < 2e-3 * BARE.p_h
    assert found.z == pytest.approx(best.x * BARE.a_h, rel=1e-2)
    assert found.x == pytest.approx(0.0, abs=1e-2 * BARE.a_h)


def test_interfaces_within_one_material_change_nothing(solved):
    bare, layered = solved[SLIDING], solved[LAYERED]
    assert at(layered, "sigma_xx", "surface").value == pytest.approx(
        at(bare, "sigma_xx", "surface").value, rel=1e-6
    )
    for k, below in ((1, "coating 2"), (2, "substrate")):
        base, top = (
            at(layered, "sigma_xx", f"base of coating {k}"),
            at(layered, "sigma_xx", f"top of {below}"),
        )
        assert base.value == pytest.approx(top.value, rel=1e-6)
        assert base.x == pytest.approx(top.x, rel=1e-3)
    deep, whole = at(layered, "von_mises", "substrate"), at(bare, "von_mises", "substrate")
    assert deep.value == pytest.approx(whole.value, abs=deep.uncertainty + whole.uncertainty)


def test_principal_stresses_are_eigenvalues():
    random = np.random.default_rng(16)
    xx, yy, zz, xz = s = random.normal(size=(4, 500))
    zero = np.zeros(500)
    tensor = np.array([[xx, zero, xz], [zero, yy, zero], [xz, zero, zz]])
    values = np.linalg.eigvalsh(np.moveaxis(tensor, -1, 0))
    np.testing.assert_allclose(first_principal(s), values[:, 2], rtol=1e-12, atol=1e-14)
    spread = ((values[:, [0, 1, 2]] - values[:, [1, 2, 0]]) ** 2).sum(axis=1) / 2
    np.testing.assert_allclose(von_mises(s), np.sqrt(spread), rtol=1e-12)
    np.testing.assert_allclose(largest_shear(s), (values[:, 2] - values[:, 0]) / 2, rtol=1e-12)


def test_largest_stresses_are_those_of_the_whole_body():
    """Eigenvalues of all six stresses at points around the contact, off the plane y = 0 too."""
    from verification.sources.source_registry import SOURCES

    solution = SOURCES["hamilton"].solve(SLIDING, {})
    found = answer(SLIDING, "semianalytic")
    a = SLIDING.a_h
    x, y, z = np.meshgrid(
        np.linspace(-1.6, 1.6, 65), np.linspace(0, 1.2, 25), np.linspace(0, 1.2, 25), indexing="ij"
    )
    sigma = solution.stress(a * x.ravel(), a * y.ravel(), a * z.ravel())
    values = np.linalg.eigvalsh(np.moveaxis(sigma, -1, 0))
    assert values[:, 2].max() <= at(found, "sigma_1", "substrate").value * (1 + 2e-6)
    mises = np.sqrt(((values[:, [0, 1, 2]] - values[:, [1, 2, 0]]) ** 2).sum(axis=1) / 2)
    largest = at(found, "von_mises", "substrate")
    assert 0.995 * largest.value <= mises.max() <= largest.value + largest.uncertainty


def test_courses_pass_through_the_largest_tensions(solved):
    found = solved[LAYERED]
    for course in found.courses:
        largest = at(found, "sigma_xx", course.where).value
        assert course.stress[0].max() == pytest.approx(largest, rel=0.03)
        assert course.stress[0].max() <= largest * (1 + 1e-5)


def test_summary_names_the_layer_the_place_and_the_side_of_the_largest_tension(solved):
    bare, sliding, elastic, layered = (summary(problem, found, {}) for problem, found in solved.items())
    assert "170 MPa" in bare
    assert "789 MPa" in bare
    assert "behind" in sliding
    assert "ahead" in elastic
    base = at(solved[LAYERED], "sigma_xx", "base of coating 1").value
    shears = [e.value for e in solved[LAYERED].extremes if e.quantity == "|sigma_xz|"]
    assert all(f"{value / 1e6:.0f} MPa" in layered for value in (base, max(shears)))
    named = summary(LAYERED, solved[LAYERED], {"flat": ("DLC", "", "steel")})
    assert "coating 1 (DLC)" in named
    assert "coating 2 (" not in named
    squeezed = replace(solved[BARE], extremes=tuple(replace(e, value=0.0) for e in solved[BARE].extremes))
    assert "170 MPa" not in summary(BARE, squeezed, {})


def test_summary_names_the_tension_of_a_coating_before_a_larger_one_elsewhere(solved):
    found = solved[LAYERED]
    below = at(found, "sigma_1", "substrate")
    torn = replace(found, extremes=tuple(replace(e, value=1e10) if e is below else e for e in found.extremes))
    first, second = summary(LAYERED, torn, {}).split(". ")[:2]
    assert first.startswith("Largest tension in the coatings: ")
    assert second == "Largest anywhere: 10000 MPa, in the substrate"


def test_summary_does_not_leave_out_a_large_uncertainty(solved):
    extremes = solved[SLIDING].extremes
    for share, said in ((0.04, False), (2.0, True)):
        doubted = tuple(replace(e, uncertainty=share * abs(e.value)) for e in extremes)
        assert ("±" in summary(SLIDING, replace(solved[SLIDING], extremes=doubted), {})) == said


def test_differences_are_by_key_with_both_uncertainties(solved):
    first = solved[SLIDING]
    assert all(d.value == 0 and d.within for d in differences(first, first))
    moved = replace(first.extremes[0], value=first.extremes[0].value * 1.01)
    second = replace(first, extremes=(moved, *first.extremes[1:]))
    (apart,) = [d for d in differences(first, second) if not d.within]
    assert apart.key == ("flat", "sigma_xx", "surface")
    assert apart.value == pytest.approx(0.01 * first.extremes[0].value)


@pytest.mark.slow
def test_sub_layers_converge_and_count_as_one_coating():
    course, found = GradedCourse(course="linear", top=4e11, base=210e9), []
    bare = CoatedContact(3e-3, 20.0, (), (210e9, 0.3), 0.1)
    for n in (2, 4, 8):
        coatings = tuple((E, 0.25, 0.5 * bare.a_h / n) for E in moduli(course, n))
        problem, fast = replace(bare, coatings=coatings), {"estimate_uncertainty": False}
        found.append(answer(problem, EXACT[0], fast, layers={"flat": (n,)}))
    assert {at.where for at in found[2].extremes if at.quantity == "sigma_1"} == {"coating 1", "substrate"}
    p0 = [one.numbers["peak_pressure"][0] for one in found]
    assert (p0[1] - p0[0]) / (p0[2] - p0[1]) == pytest.approx(4, rel=0.1)
