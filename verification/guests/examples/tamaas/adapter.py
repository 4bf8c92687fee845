"""tamaas: Polonsky-Keer iteration with a DC-FFT operator, uncoated; its response to a square."""

import numpy as np
import tamaas


def half_space(n, side, substrate):  # noqa: D103
    tamaas.set_log_level(tamaas.LogLevel.warning)
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [side, side], [n, n])
    model.E, model.nu = substrate
    tamaas.ModelFactory.registerNonPeriodic(model, "dcfft")
    return model


def solve(substrate, radius=None, load=None, pressure=None, side=None, patches=257):
    """The contact of a paraboloid on the square [-1.5 a, 1.5 a]^2 of ``patches`` a side, an odd number."""
    (E, nu), n = substrate, int(patches)
    if side is not None:
        model = half_space(n, n * side, substrate)
        t, u = np.zeros((2, *model.traction.shape))
        t.reshape(n, n)[n // 2, n // 2] = pressure
        model.operators["dcfft"](t, u)
        at = lambda v: n // 2 + np.rint(v / side).astype(int)  # noqa: E731
        return {"displacement": lambda x, y, z: np.tile(u.reshape(n, n)[at(x), at(y)], (3, 1))}
    side = 3 * (3 * load * radius * (1 - nu**2) / (4 * E)) ** (1 / 3)
    model = half_space(n, side, substrate)
    x = (np.arange(n) - n // 2) * side / n
    gap = (x[:, None] ** 2 + x[None, :] ** 2) / (2 * radius)
    solver = tamaas.PolonskyKeerRey(model, -gap, 1e-7)
    solver.setIntegralOperator("dcfft")
    solver.max_iter = 10_000
    solver.solve(load / side**2)
    p, u = np.array(model.traction).reshape(n, n), np.zeros_like(model.traction)
    model.operators["dcfft"](model.traction, u)  # the solver's own displacement has a free constant
    return {
        "contact_radius": np.sqrt((p > 0).sum() / np.pi) * side / n,
        "approach": float(u.reshape(n, n)[n // 2, n // 2]),
        "peak_pressure": float(p.max()),
        "pressure": lambda at, y: np.interp(at, x, p[:, n // 2], right=0.0, left=0.0),
    }
