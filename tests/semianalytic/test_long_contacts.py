"""Contacts that patches resolve poorly: long ellipses, flat punches with a small round edge."""

import numpy as np
import pytest
from scipy.special import ellipe, ellipk

import semianalytic

E, NU = 210e9, 0.3
E_STAR = E / (1 - NU**2)


@pytest.mark.parametrize(
    ("ratio", "along"), [(20.0, 0), pytest.param(40.0, 1, marks=pytest.mark.slow)], ids=lambda v: str(v)
)
def test_a_long_ellipse_is_hertz(ratio, along):
    """K. L. Johnson, Contact Mechanics, (4.26) to (4.28); semi-axes a, b = a/ratio."""
    m = 1 - 1 / ratio**2
    K, L = ellipk(m), ellipe(m)
    a = 1e-3
    b, p0 = a / ratio, 1e9
    curved = p0 * b / (E_STAR * m * a**2) * np.array([K - L, ratio**2 * L - K])  # of height A x^2 + B y^2
    radii = tuple((1 / (2 * curved))[:: -1 if along else 1])
    load = 2 / 3 * np.pi * a * b * p0
    s = semianalytic.solve(
        radius=float(np.sqrt(radii[0] * radii[1])),
        load=load,
        coatings=(),
        substrate=(E, NU),
        indenter=("ellipsoid", radii),
    )
    expected = {"contact_radius": np.sqrt(a * b), "approach": p0 * b * K / E_STAR, "peak_pressure": p0}
    for name, value in expected.items():
        assert abs(getattr(s, name) - value) <= getattr(s.uncertainty, name) <= 1e-4 * value, name


@pytest.mark.parametrize(
    ("edge", "wider", "patches"),
    [pytest.param(0.2, 1.0043, 513, marks=pytest.mark.slow), (1.8, 1.0005, 129), (2.0, 1.04, 129)],
)
def test_a_flat_punch_with_a_round_edge_is_sneddon(edge, wider, patches):
    """f = (r - b)^2/2R beyond b. I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47-57."""
    b = 5e-6
    R, a = edge * b, wider * b
    t = np.arcsin(b / a)
    cosine, rest = np.cos(t), np.pi / 2 - t
    approach = a / R * (a * cosine - b * rest)
    load = 2 * E_STAR * a * a / R
    load *= a * (cosine - cosine**3 / 3) - b * (rest / 2 + np.sin(t) * cosine / 2)

    def height(x, y):
        return np.maximum(np.hypot(x, y) - b, 0) ** 2 / 2 / R

    s = semianalytic.indent(
        profile=height, half_width=1.12 * a, load=load, coatings=(), substrate=(E, NU), patches=patches
    )
    assert abs(s.approach - approach) <= s.uncertainty.approach <= 0.02 * approach
    assert abs(s.contact_radius - a) <= s.uncertainty.contact_radius
