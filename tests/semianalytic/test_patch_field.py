"""Fields below patches: those of the rings, away from the edge; planes; few depths for many."""

import numpy as np
import pytest

from semianalytic import numbers
from semianalytic.inputs import Body
from semianalytic.patches.prescribed import Prescribed, patch_mean
from semianalytic.stresses import patch_field, subsurface
from semianalytic.stresses.rings import Disc

N = 129
D = 2.24 / N
X = (np.arange(N) - N // 2) * D
HERTZ = Prescribed(1.0, lambda r: np.sqrt(np.maximum(1 - r**2, 0)))
GRID = {"grid_x": X, "pressure": patch_mean(HERTZ, X, D)}
BODIES = {
    "bare": Body((), (1.0, 0.3), 0.3),
    "two coatings": Body(((4.0, 0.25, 0.3), (0.3, 0.4, 0.15)), (1.0, 0.3), 0.3),
    "thin and stiff": Body(((10.0, 0.3, 0.05),), (1.0, 0.3), 0.3),
    "half a patch": Body(((4.0, 0.2, D / 2),), (1.0, 0.3), 0.3),
}


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("field", ["stress", "displacement"])
def test_field_is_that_of_the_rings(name, field):
    body = BODIES[name]
    rng = np.random.default_rng(5)
    r, angle = rng.uniform(0, 2, 60), rng.uniform(0, 2 * np.pi, 60)
    r[np.abs(r - 1) < 4 * D] = 0.5
    r[:3] = 10, 0, 30
    depths = np.concatenate([[0], np.cumsum(body.thickness), np.geomspace(0.003, 10, 8)])
    z = rng.choice(depths, r.size)
    points = r * np.cos(angle), r * np.sin(angle), z, body.layer_of(z, None)
    disc = Disc(1.0, HERTZ.of_square)
    exact = getattr(subsurface, field)(*points, pressures=[disc], body=body)[0]
    found = getattr(patch_field, field)(*points, **GRID, body=body)
    # of stress 2e-4 at f = 1 more than three patches from the edge, on half the default grid
    tolerance = {"stress": 1e-4, "displacement": 2e-5}[field] * max(1.0, np.abs(exact).max())
    np.testing.assert_allclose(found, exact, rtol=0, atol=tolerance)


def test_many_depths_are_interpolated_to_what_each_gives_alone():
    body = Body(((4.0, 0.25, 0.02), (0.3, 0.4, 0.15)), (1.0, 0.3), 0.3)
    rng = np.random.default_rng(11)
    x, y = rng.uniform(-0.6, 0.6, (2, 30))
    z = 0.02 * rng.uniform(0, 1, 30)
    layer = body.layer_of(z, None)
    together = patch_field.stress(x, y, z, layer, **GRID, body=body)
    alone = [patch_field.stress(x[i], y[i], z[i], layer[i], **GRID, body=body) for i in range(5)]
    np.testing.assert_allclose(together[:, :5], np.stack(alone, axis=-1), rtol=0, atol=2e-6)


@pytest.mark.parametrize(("n", "wide"), [(1025, numbers.WIDE), (257, 40)])
def test_deep_below_many_patches_the_forces_of_coarser_lattices_are_gathered(n, wide, monkeypatch):
    """Below more patches than are summed one by one: on and off the axis as from the rings."""
    monkeypatch.setattr(numbers, "WIDE", wide)
    body = BODIES["two coatings"]
    x = (np.arange(n) - n // 2) * 2.24 / n
    at = np.array([0.0, 0.3, 0.8]), np.array([0.0, 0.1, -0.4]), np.array([0.12, 0.2, 0.4])
    layer = body.layer_of(at[2], None)
    exact = subsurface.stress(*at, layer, pressures=[Disc(1.0, HERTZ.of_square)], body=body)[0]
    found = patch_field.stress(*at, layer, grid_x=x, pressure=patch_mean(HERTZ, x, 2.24 / n), body=body)
    np.testing.assert_allclose(found, exact, rtol=0, atol=2e-6 * (1025 / n) ** 2)


def test_a_single_patch_deep_down_is_a_point_force():
    pressure, z = np.zeros((N, N)), 20 * D
    pressure[N // 2, N // 2] = 1 / D**2
    body, at = BODIES["two coatings"], (np.array([0.0, 2 * D]), np.zeros(2))
    for depth in (0.5 * D, z):  # near the patch no node is a point force
        layer = body.layer_of(np.full(2, depth), None)
        found = patch_field.stress(*at, depth, layer, grid_x=X, pressure=pressure, body=body)
        assert np.isfinite(found).all()
    force = subsurface.PointField.of(np.array([z]), int(layer[0]), subsurface.stress_response(body))
    np.testing.assert_allclose(found, force(*at, z), rtol=0, atol=1e-2 * np.abs(found).max())


def test_no_points_and_no_pressure_give_no_stress():
    unloaded = GRID | {"pressure": np.zeros((N, N))}
    assert not patch_field.stress(np.zeros(2), 0.1, [0.0, 0.2], 0, **unloaded, body=BODIES["bare"]).any()
    assert patch_field.stress(np.zeros(0), 0.0, 0.0, 0, **GRID, body=BODIES["bare"]).shape == (6, 0)
