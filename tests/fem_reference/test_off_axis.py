"""Pressures without symmetry, harmonic by harmonic."""

from types import SimpleNamespace

import numpy as np
import pytest

from fem_reference import solve_prescribed
from fem_reference.contact.levels import ElementsNotConverged
from fem_reference.elasticity.loading import solve_traction
from fem_reference.not_round.gap_closing import Closed
from fem_reference.not_round.harmonic_compliance import harmonic_compliance
from fem_reference.not_round.off_axis import OffAxisFields, PressedSolid, discretised
from fem_reference.not_round.star_contact import StarPressure
from fem_reference.scaling import LayeredSolid, Scales

E, NU, F = 210e9, 0.3, 0.25
STEEL = (E, NU)
A, P0 = 1e-4, 1e9
COATINGS = ((4 * E, 0.2, 0.4 * A),)
SOLID = LayeredSolid.scaled(COATINGS, STEEL, A, 100.0, E)


def under_ellipse(axes, *, friction=0.0, harmonics=8, size=0.3):
    """Fields below p0 sqrt(1 - x^2/a^2 - y^2/b^2), the half axes over A."""
    compliance = harmonic_compliance(SOLID, discretised(SOLID, size, size / 2, 4), harmonics, 1)
    pressure = StarPressure.of_ellipse(0.0, axes, 2 * np.pi * axes[0] * axes[1] / 3 * P0 / E, 1, 2)
    found = Closed((compliance,), pressure, 1.0, 0, True, np.zeros((0, 0)), (abs, 0.0, 0))
    fields = OffAxisFields.of(compliance, found.nodal_loads, friction, pressure, size / 2)
    return PressedSolid(fields, None, Scales(length=A, pressure=E, modulus=E))


def test_meshes_beyond_the_memory_are_refused_before_they_are_solved():
    with pytest.raises(ElementsNotConverged, match=r"200000 nodes in 1[0-9] harmonics.*thicker films"):
        harmonic_compliance(SOLID, SimpleNamespace(N=200_000), 240, 2)


def test_a_round_pressure_has_the_fields_of_harmonics_0_and_1():
    d = discretised(SOLID, 0.4, 0.2, 4)
    compliance = harmonic_compliance(SOLID, d, 4, 1)
    s, w = np.polynomial.legendre.leggauss(12)
    ends = compliance.vertices
    r = ((ends[1:] + ends[:-1])[:, None] / 2 + np.diff(ends)[:, None] / 2 * s).ravel()
    weight = (np.diff(ends)[:, None] / 2 * w).ravel()

    def profile(r):
        return np.maximum(1 - r**2, 0) ** 2

    values = np.outer(compliance.harmonics == 0, 2 * np.pi * r * profile(r) * weight)
    loads = compliance.nodal_loads(r, values.T[..., None])[..., 0]
    found = OffAxisFields.of(compliance, loads, F, StarPressure.of_ellipse(0.0, (1.0, 1.0), 1.0, 1, 2), 0.2)
    assert [field.harmonic for field in found.fields] == [0, 1]
    for field, traction in zip(found.fields, (profile, lambda r: F * profile(r)), strict=True):
        expected = solve_traction(d, SOLID, field.harmonic, traction)
        np.testing.assert_allclose(field.fields, expected, rtol=0, atol=1e-9 * np.abs(expected).max())


def test_a_harmonic_between_those_solved_is_interpolated():
    d = discretised(SOLID, 0.5, 0.2, 4)
    many, all_ = harmonic_compliance(SOLID, d, 40, 2), harmonic_compliance(SOLID, d, 13, 2, density=20.0)
    assert len(many.solved) < len(many.harmonics)
    m = 12
    assert m in all_.solved
    assert m not in many.solved
    # the whole field, not the deflection alone: the stress below the surface is further off
    found, exact = (one.displacements(np.outer(one.harmonics == m, one.nodes))[m] for one in (many, all_))
    np.testing.assert_allclose(found, exact, rtol=0, atol=2e-4 * np.abs(exact).max())


def test_sliding_gives_the_tractions_of_the_product_with_the_direction():
    found = under_ellipse((1.0, 0.8), friction=F)
    sigma, p = found.stress(0.3 * A, 0.2 * A, 0.0), found.pressure(0.3 * A, 0.2 * A)
    np.testing.assert_allclose(p, P0 * np.sqrt(1 - 0.09 - 0.0625), rtol=1e-12)
    np.testing.assert_allclose(sigma[2], [-F * p, 0.0, -p], atol=1e-9 * p)


def test_exchanging_the_axes_exchanges_those_of_the_stress():
    x, y, z = A * np.array([[0.1, 0.4, -0.9], [0.3, -0.2, 0.5], [0.3, 0.5, 1.0]])
    one = under_ellipse((1.0, 0.6)).stress(x, y, z)
    other = under_ellipse((0.6, 1.0)).stress(y, x, z)
    np.testing.assert_allclose(one, other[[1, 0, 2]][:, [1, 0, 2]], rtol=0, atol=1e-6 * P0)


def test_friction_is_that_of_a_prescribed_load():
    given = {"coatings": COATINGS, "substrate": STEEL, "friction": F}
    profile = lambda r: P0 * np.sqrt(np.maximum(1 - (r / A) ** 2, 0))  # noqa: E731
    expected = solve_prescribed(pressure=profile, load_radius=A, quality="fast", **given)
    found = under_ellipse((1.0, 1.0), friction=F, size=0.2, harmonics=3)
    x, z = np.meshgrid(A * np.array([-1.2, -0.5, 0.0, 0.7]), A * np.array([0.1, 0.4, 0.9]))
    np.testing.assert_allclose(
        found.stress(x, 0.2 * A, z, None), expected.stress(x, 0.2 * A, z, None), rtol=0, atol=4e-4 * P0
    )


def test_half_a_turn_slides_the_other_way():
    x, y, z = A * np.array([[0.1, 0.4, -0.9], [0.3, -0.2, 0.5], [0.0, 0.4, 1.0]])
    one, other = (under_ellipse((1.0, 0.6), friction=f) for f in (F, -F))
    turned = PressedSolid(one._fine.turned, None, one._units)
    np.testing.assert_allclose(turned.stress(x, y, z), other.stress(x, y, z), rtol=0, atol=1e-9 * P0)
