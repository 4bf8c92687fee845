"""Every number of the semi-analytical method follows from its coefficients.

The surface coefficients times 1.01 are those of solids whose moduli are all 1.01 times smaller; the exact
reference says what these, or another load, gap or compliance, do to contact radius, peak pressure and
approach. A changed ``subsurface.stress`` changes every stress by 1 %. A few cases run in CI, all of them with
``-m slow``.
"""

from dataclasses import replace

import numpy as np
import pytest

from semianalytic.coefficients import frf, influence, point_force
from semianalytic.patches import neighbours
from semianalytic.stresses import subsurface
from verification.cases.case_file import read_case, shipped_cases
from verification.problem.either_body import on_body
from verification.sources.exact_sources import solve_exactly
from verification.sources.method_sources import solve_semianalytic
from verification.sources.references import solids_in_contact
from verification.sources.references.layered_half_space import LayeredHalfSpace

STEP = 1.01
WITHIN = 0.02  # of the change
MEDIAN, LINE = 0.9, 0.5  # least response of the stresses to their coefficients, over 1 %
IN_CI = ("01_uncoated_steel", "08_dlc_chromium_steel", "14_ratio_4_sliding", "20_sapphire_silver_steel")
CASES = [
    pytest.param(name, marks=() if name in IN_CI else pytest.mark.slow, id=name) for name in shipped_cases()
]
NUMERICS = {"estimate_uncertainty": False}
ALONG = np.array([-1.9, -1.3, -0.8, -0.45, 0.0, 0.3, 0.6, 0.85, 1.2])  # of a


def softer(problem):
    """The problem with all moduli 1.01 times smaller."""

    def less(coatings):
        return tuple((E / STEP, nu, h) for E, nu, h in coatings)

    E, nu = problem.substrate
    ball = problem.ball and (problem.ball[0] / STEP, problem.ball[1], less(problem.ball[2]))
    return replace(problem, coatings=less(problem.coatings), substrate=(E / STEP, nu), ball=ball)


def changes(before, after):
    """ln of the ratio of contact radius, peak pressure and approach, over ln 1.01."""
    ratio = [
        getattr(after, name) / getattr(before, name)
        for name in ("contact_radius", "peak_pressure", "approach")
    ]
    return np.log(ratio) / np.log(STEP)


def times(function, factor=STEP):
    """``function`` with what it returns multiplied."""
    return lambda *values, **options: factor * function(*values, **options)


def stresses(case, solution):
    """Stress (3, 3, n) at nine points of every line of the case, by name."""
    found = {}
    for line in case.lines:
        s = solution.contact_radius * (2 * np.abs(ALONG) if line.direction[2] else ALONG)
        found[line.name] = on_body(solution, line.body).stress(*line.points(s), line.layer)
    return found


@pytest.fixture(scope="module", params=CASES)
def case(request):
    return read_case(shipped_cases()[request.param])


@pytest.fixture(scope="module")
def solved(case):
    return solve_semianalytic(case.problem, NUMERICS)


@pytest.fixture(scope="module")
def exact(case):
    return solve_exactly(case.problem, NUMERICS)


def test_surface_coefficients_act_as_the_moduli(case, solved, exact, monkeypatch):
    wanted = changes(exact, solve_exactly(softer(case.problem), NUMERICS))
    if case.problem.homogeneous:
        assert wanted == pytest.approx([1 / 3, -2 / 3, 2 / 3], rel=0.01)
    monkeypatch.setattr(influence, "surface_coefficients", times(influence.surface_coefficients))
    found = changes(solved, solve_semianalytic(case.problem, NUMERICS))
    assert found == pytest.approx(wanted, rel=WITHIN)


def test_the_gap_acts_as_the_radius(case, solved, exact, monkeypatch):
    sharper = replace(case.problem, radius=case.problem.radius / STEP)
    wanted = changes(exact, solve_exactly(sharper, NUMERICS))
    of_name = neighbours.undeformed_gap
    monkeypatch.setattr(neighbours, "undeformed_gap", lambda *given: times(of_name(*given)))
    found = changes(solved, solve_semianalytic(case.problem, NUMERICS))
    assert found == pytest.approx(wanted, rel=WITHIN)


def test_the_response_of_the_layers_acts_as_in_the_exact_contact(case, solved, exact, monkeypatch):
    bodies = [case.problem.coatings, *([case.problem.ball[2]] if case.problem.ball else [])]
    if not any(bodies):
        pytest.skip("no body is coated")
    M = LayeredHalfSpace.compliance.fget
    monkeypatch.setattr(LayeredHalfSpace, "compliance", property(lambda one: 1 + STEP * (M(one) - 1)))
    assert solids_in_contact.LayeredHalfSpace is LayeredHalfSpace
    wanted = changes(exact, solve_exactly(case.problem, NUMERICS))
    monkeypatch.setattr(frf, "compliance_excess", times(frf.compliance_excess))
    found = changes(solved, solve_semianalytic(case.problem, NUMERICS))
    assert found == pytest.approx(wanted, rel=WITHIN, abs=WITHIN * np.abs(wanted).max())


def test_stress_coefficients_act_on_every_stress(case, solved, monkeypatch):
    before = stresses(case, solved)
    monkeypatch.setattr(subsurface, "stress", times(subsurface.stress))
    after = stresses(case, solved)
    response = {}
    for line, sigma in before.items():
        size = np.abs(sigma).max(axis=(0, 1))
        there = size > 1e-6 * case.problem.p_h
        response[line] = (np.abs(after[line] - sigma).max(axis=(0, 1))[there] / size[there]) / (STEP - 1)
    assert np.median(np.concatenate(list(response.values()))) >= MEDIAN
    assert {line: r for line, r in response.items() if np.median(r) < LINE} == {}


def test_the_stress_response_acts_on_the_stress_below_the_layers(case, solved, monkeypatch):
    if not case.problem.coatings:
        pytest.skip("the stress of an uncoated solid is in closed form")
    a, deep = solved.contact_radius, case.problem.interfaces[-1]
    at = a * ALONG, np.zeros_like(ALONG), deep + 0.3 * a
    before = solved.stress(*at)
    monkeypatch.setattr(point_force, "stress_frf", times(point_force.stress_frf))
    assert solved.stress(*at) == pytest.approx(STEP * before, rel=1e-6, abs=1e-7 * case.problem.p_h)


def test_friction_acts_as_in_the_exact_contact(case, solved, exact):
    f = case.problem.friction or 0.25
    # away from the edge, where a tiny change of a moves a steep stress
    at = exact.contact_radius * ALONG, np.zeros_like(ALONG), 0.4 * exact.contact_radius

    def slope(sliding):
        return sliding(STEP * f).stress(*at) - sliding(f).stress(*at)

    theirs = slope(lambda f: solve_exactly(replace(case.problem, friction=f), NUMERICS))
    assert np.abs(slope(solved.with_friction) - theirs).max() < WITHIN * np.abs(theirs).max()
