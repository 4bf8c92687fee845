"""Cylinder on layers in plane strain: closed form, limits, the middle of long ellipses."""

import numpy as np
import pytest

from verification.manual.line_limit import BODIES, SOLID, middle_section
from verification.sources.references.line_contact import line_contact

R, P = 5e-3, 1e5
E, NU = SOLID
E_STAR = E / (1 - NU**2)
B = np.sqrt(4 * P * R / np.pi / E_STAR)
P0 = np.sqrt(P * E_STAR / np.pi / R)
X, Z = (grid * B for grid in np.meshgrid([0.0, 0.3, 0.7, 1.0, 1.3, 3.0], [0.01, 0.2, 0.786, 1.0, 4.0]))


def test_the_uncoated_contact_is_mcewens():
    """K. L. Johnson, Contact Mechanics, 1985, (4.43) to (4.49), with the largest shear of (4.46)."""
    found = line_contact(R, P, (), SOLID)
    assert found.b == pytest.approx(B, rel=1e-13)
    assert found.peak_pressure == pytest.approx(P0, rel=1e-13)
    A = B**2 - X**2 + Z**2
    root = np.sqrt(A**2 + 4 * X**2 * Z**2)
    m, n = np.sqrt((root + A) / 2), np.sqrt((root - A) / 2)
    share = (Z**2 + n**2) / (m**2 + n**2)
    expected = {
        0: -P0 / B * (m * (1 + share) - 2 * Z),
        2: -P0 / B * m * (1 - share),
        3: -P0 / B * n * (m**2 - Z**2) / (m**2 + n**2),
    }
    stress = found.stress(X, Z)
    for component, value in expected.items():
        np.testing.assert_allclose(stress[component], value, rtol=0, atol=1e-12 * P0)
    np.testing.assert_allclose(stress[1], NU * (stress[0] + stress[2]), rtol=1e-14)
    xx, _, zz, _ = found.stress(0.0, 0.786 * B)
    assert (xx - zz) / 2 == pytest.approx(0.300 * P0, rel=1e-3)


@pytest.mark.parametrize("ball", [None, (210e9, 0.3, ((210e9, 0.3, 0.1 * B),))])
def test_a_coating_of_the_substrates_material_changes_nothing(ball):
    coated = line_contact(R, P, ((E, NU, 0.2 * B), (E, NU, 0.5 * B)), SOLID, ball)
    bare = line_contact(R, P, (), SOLID, ball and (*ball[:2], ()))
    assert coated.b == pytest.approx(bare.b, rel=1e-13)
    for x, z in ((X, Z), (X[0], 0 * X[0])):
        np.testing.assert_allclose(coated.stress(x, z), bare.stress(x, z), rtol=0, atol=1e-12 * P0)


@pytest.mark.parametrize("ratio", [0.25, 4.0])
def test_a_thick_coating_is_a_body_of_its_own_and_a_thin_one_takes_no_part(ratio):
    hard, nu = ratio * E, 0.25
    alone = line_contact(R, P, (), (hard, nu))
    thick, half, thin = (line_contact(R, P, ((hard, nu, h * B),), SOLID) for h in (300.0, 0.4, 0.1))
    assert thick.b == pytest.approx(alone.b, rel=2 / 300**2)
    apart = np.abs(thick.stress(X, Z) - alone.stress(X, Z))
    assert apart[2:].max() < 1e-4 * P0
    assert apart[0].max() < 2 * P / (300 * B)  # P moves the base sideways, over its thickness
    assert abs(thin.b / B - 1) < abs(half.b / B - 1) / 2
    deep = (X[-1], Z[-1])  # far below, where the load alone counts
    np.testing.assert_allclose(
        thin.stress(*deep), line_contact(R, P, (), SOLID).stress(*deep), rtol=0, atol=0.01 * P0
    )


def test_the_surface_bears_the_pressure_and_the_interface_joins():
    h = 0.5 * B
    found = line_contact(R, P, ((4 * E, 0.25, h),), SOLID)
    x = B * np.linspace(-1.2, 1.2, 25)
    _, _, zz, xz = found.stress(x, 0.0)
    np.testing.assert_allclose(zz, -found.pressure(x), rtol=0, atol=1e-12 * P0)
    np.testing.assert_allclose(xz, 0, atol=1e-12 * P0)
    above, below = (found.stress(x, h, layer) for layer in (0, 1))
    np.testing.assert_allclose(above[2:], below[2:], rtol=0, atol=1e-12 * P0)
    strain = [
        (s[0] - nu * (s[1] + s[2])) / modulus for s, modulus, nu in ((above, 4 * E, 0.25), (below, E, NU))
    ]
    np.testing.assert_allclose(*strain, rtol=0, atol=1e-12 * P0 / E)


def test_its_gap_closes_and_its_terms_suffice():
    given = R, P, ((4 * E, 0.25, 0.3 * B),), SOLID
    found = line_contact(*given)
    more = line_contact(*given, terms=2 * found.d.size)
    assert more.b == pytest.approx(found.b, rel=1e-13)
    assert found.load == pytest.approx(P, rel=1e-13)
    x = found.b * np.linspace(-1, 1, 20001)
    assert np.trapezoid(found.pressure(x), x) == pytest.approx(P, rel=1e-5)


@pytest.mark.parametrize(
    ("body", "ratios"),
    [
        ("uncoated", (20, 50)),
        pytest.param("uncoated", (50, 100), marks=pytest.mark.slow),
        pytest.param("coated", (20, 50), marks=pytest.mark.slow),
    ],
)
def test_the_middle_of_a_long_ellipse_approaches_it(body, ratios):
    """Stresses as b/a, half width and peak pressure as (b/a)^2 ln(a/b)."""
    one, other = (middle_section(ratio, BODIES[body]) for ratio in ratios)
    for ratio, section in zip(ratios, (one, other), strict=True):
        square = np.log(ratio) / ratio**2
        assert abs(section.peak) < 0.5 * square
        assert abs(section.half_width) < 0.5 * square
        assert section.stress.max() < 1 / ratio
    assert other.stress.max() < 1.1 * one.stress.max() * ratios[0] / ratios[1]
    if body == "uncoated":  # K. L. Johnson, (3.66), at the middle of the surface
        at = (1 - 2 * NU) / (1 + ratios[1])
        assert other.stress[0, -3] == pytest.approx(at, rel=0.02)
