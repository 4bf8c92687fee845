"""The quantities of a study, where closed forms know them: a coating of the substrate's own material."""

from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy as np
import pytest
from synthetic_results import contact

from verification.problem.coated_contact import CoatedContact
from verification.sources.references import integral_equation
from verification.sources.references.hertz import Hertz
from verification.study.largest_stresses import QUANTITIES, quantities, von_mises

FRICTIONS = (0.0, 0.25, 0.5)
NU = 0.3


@dataclass(frozen=True)
class Uncoated:
    """Hamilton's field under a coating that differs from the substrate in nothing."""

    h: float  # over a

    @cached_property
    def problem(self) -> CoatedContact:
        return contact((210e9, NU, self.h), friction=1.0)

    @cached_property
    def exact(self) -> Hertz:
        p = self.problem
        return Hertz(p.radius, p.load, *p.substrate, 1.0)

    @cached_property
    def found(self):
        return {f: at for (_, f), at in quantities(self.exact, self.problem, FRICTIONS).items()}


@pytest.fixture(scope="module")
def uncoated():
    return {h: Uncoated(h) for h in (0.1, 1.0, 4.0)}


@pytest.mark.parametrize("h", [0.1, 1.0, 4.0])
@pytest.mark.parametrize("f", FRICTIONS)
def test_surface_tension_peaks_at_the_trailing_edge(uncoated, h, f):
    exact = uncoated[h].exact
    at = uncoated[h].found[f]["sigma_xx_surface"]
    # Johnson (3.43), Hamilton (1983)
    expected = exact.peak_pressure * ((1 - 2 * NU) / 3 + f * pi * (4 + NU) / 8)
    assert at.value == pytest.approx(expected, rel=1e-12)
    assert at.uncertainty < 1e-12 * exact.peak_pressure
    assert at.x == -exact.contact_radius
    assert at.z == 0


@pytest.mark.parametrize("h", [0.1, 1.0, 4.0])
@pytest.mark.parametrize("f", FRICTIONS)
def test_no_place_on_a_fine_grid_beats_the_maxima(uncoated, h, f):
    case = uncoated[h]
    a, depth = case.exact.contact_radius, case.problem.interfaces[0]
    # a grid of its own, that no sample of the search lies on
    reach = 2 * a + 2.4 * depth
    x = np.concatenate([np.linspace(-reach, reach, 4003), -a * (1 + np.geomspace(1e-6, 0.05, 40))])
    sliding = case.exact.stress(x, 0.0, depth)
    mirrored = case.exact.stress(-x, 0.0, depth)
    sign = np.array([[1.0, 1, -1], [1, 1, -1], [-1, -1, 1]])[:, :, None]
    sigma = (1 + f) / 2 * sliding + (1 - f) / 2 * sign * mirrored
    found = case.found[f]
    p0 = case.exact.peak_pressure
    for name, values in (
        ("sigma_xx_base", sigma[0, 0]),
        ("sigma_xx_substrate", sigma[0, 0]),
        ("sigma_xz_interface", np.abs(sigma[0, 2])),
        ("sigma_zz_interface", sigma[2, 2]),
    ):
        assert found[name].value >= values.max() - 2e-6 * p0, name
        assert found[name].value <= max(values.max(), 0) + 1e-4 * p0, name
    for name, z in (
        ("von_mises_coating", np.linspace(0, min(depth, 2 * a), 41)),
        ("von_mises_substrate", np.linspace(depth, depth + 2 * a, 41)),
    ):
        grid = np.meshgrid(np.linspace(-1.6, 1.6, 161) * a, z)
        s = (1 + f) / 2 * case.exact.stress(grid[0], 0.0, grid[1])
        s = s + (1 - f) / 2 * sign[..., None] * case.exact.stress(-grid[0], 0.0, grid[1])
        best = von_mises(np.stack([s[0, 0], s[1, 1], s[2, 2], s[0, 2]])).max()
        assert found[name].value >= best - 1e-4 * p0, name
        assert found[name].value <= best + 0.01 * p0, name


def test_one_solution_with_unit_friction_speaks_for_every_other():
    problem = contact((420e9, 0.25, 0.6), friction=1.0)
    keywords = {"radius": problem.radius, "load": problem.load, "estimate_uncertainty": False}
    keywords |= {"coatings": problem.coatings, "substrate": problem.substrate}
    unit = quantities(integral_equation.solve(**keywords, friction=1.0), problem, (0.0, 0.3))
    bare = CoatedContact(problem.radius, problem.load, problem.coatings, problem.substrate, 0.0)
    none = quantities(integral_equation.solve(**keywords), bare, (0.0,))
    for name in QUANTITIES:
        assert unit[0.0, 0.0][name].value == pytest.approx(none[0.0, 0.0][name].value, rel=1e-9, abs=1e-3), (
            name
        )
    # sliding asked for outright, at the trailing side of the base where unit friction finds its peak
    at = unit[0.0, 0.3]["sigma_xx_base"]
    sliding = integral_equation.solve(**keywords, friction=0.3)
    assert at.value == pytest.approx(sliding.stress(at.x, 0.0, at.z, layer=0)[0, 0], rel=1e-6)


def test_friction_of_a_frictionless_solution_is_refused():
    problem = contact((420e9, 0.25, 0.6))
    with pytest.raises(ValueError, match="friction=1"):
        quantities(Hertz(1e-2, 20.0, 210e9, 0.3, 0.5), problem, (0.25,))


def test_residual_stress_adds_to_the_coating_alone(uncoated):
    case, stress = uncoated[1.0], -0.4 * uncoated[1.0].exact.peak_pressure
    found = quantities(case.exact, case.problem, (0.0, 0.5), (0.0, stress))
    for f in (0.0, 0.5):
        plain, more = found[0.0, f], found[stress, f]
        surface = plain["sigma_xx_surface"].value + stress
        assert more["sigma_xx_surface"].value == pytest.approx(max(surface, 0), rel=1e-12)
        for name in ("sigma_xx_substrate", "sigma_xz_interface", "sigma_zz_interface", "von_mises_substrate"):
            assert more[name].value == plain[name].value
    # on the axis, without friction: |sigma_xx + s - sigma_zz|, or |s| far from the contact
    a = case.exact.contact_radius
    z = np.linspace(0, a, 2001)
    sigma = case.exact.stress(0 * z, 0.0, z)
    expected = max(np.abs(sigma[0, 0] + stress - sigma[2, 2]).max(), abs(stress))
    assert found[stress, 0.0]["von_mises_coating"].value >= expected * (1 - 1e-5)
