"""Stress of the semi-analytical contact against the integral equation, everywhere but at the contact edge."""

import numpy as np
import pytest

import semianalytic
from verification.sources.references import integral_equation

R, W, SUBSTRATE = 10e-3, 20.0, (210e9, 0.3)
E_STAR = SUBSTRATE[0] / (1 - SUBSTRATE[1] ** 2)
A_H = (3 * W * R / (4 * E_STAR)) ** (1 / 3)
P_H = 3 * W / (2 * np.pi * A_H**2)


@pytest.mark.parametrize(
    ("layers", "friction"),
    [
        (((0.1, 0.45, 0.3),), 0.5),
        pytest.param(((10.0, 0.2, 0.05),), 0.25, marks=pytest.mark.slow),
        (((2.0, 0.25, 10.0),), 0.0),
        pytest.param(((3.0, 0.2, 0.05), (0.4, 0.4, 0.2)), 0.25, marks=pytest.mark.slow),
    ],
    ids=["tenth, thin", "10 x, h = 0.05 a_h", "thick", "two"],
)
def test_stress_is_within_2e_4_of_p_h(layers, friction):
    coatings = tuple((ratio * SUBSTRATE[0], nu, h * A_H) for ratio, nu, h in layers)
    problem = {"radius": R, "load": W, "coatings": coatings, "substrate": SUBSTRATE, "friction": friction}
    exact = integral_equation.solve(**problem, estimate_uncertainty=False)
    mine = semianalytic.solve(**problem, estimate_uncertainty=False)
    a, d = exact.contact_radius, mine.diagnostics.patch_size
    interfaces = np.cumsum([h for _, _, h in coatings])

    rng = np.random.default_rng(4)
    x, y = np.concatenate([rng.uniform(-1.2, 1.2, (2, 9)), rng.uniform(-4, 4, (2, 3))], axis=1) * a
    x[:4], y[:4] = np.array([-0.9, 0.0, 0.6, 1.1]) * a, 0
    away = np.abs(np.hypot(x, y) - a) > 3 * d  # issue: more than three patches from r = a
    x, y = x[away], y[away]
    depths = [(0.0, 0), (0.004 * a, 0)]
    depths += [(h, layer + side) for layer, h in enumerate(interfaces) for side in (0, 1)]
    depths += [(z * a, int(np.searchsorted(interfaces, z * a))) for z in (0.3, 2.0, 10.0)]
    for z, layer in depths:
        error = mine.stress(x, y, z, layer=layer) - exact.stress(x, y, z, layer)
        assert np.abs(error).max() < 2e-4 * P_H, (z / a, layer)
