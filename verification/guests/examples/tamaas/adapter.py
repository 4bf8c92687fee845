"""tamaas: Polonsky-Keer iteration with a DC-FFT operator, uncoated, not periodic."""

import numpy as np
import tamaas


def solve(radius, load, substrate, patches=257):
    """The contact of a paraboloid on the square [-1.5 a, 1.5 a]^2 of ``patches`` a side, an odd number."""
    E, nu = substrate
    side = 3 * (3 * load * radius * (1 - nu**2) / (4 * E)) ** (1 / 3)
    tamaas.set_log_level(tamaas.LogLevel.warning)
    n = int(patches)
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [side, side], [n, n])
    model.E, model.nu = E, nu
    tamaas.ModelFactory.registerNonPeriodic(model, "dcfft")
    x = (np.arange(n) - n // 2) * side / n
    gap = (x[:, None] ** 2 + x[None, :] ** 2) / (2 * radius)
    solver = tamaas.PolonskyKeerRey(model, -gap, 1e-7)
    solver.setIntegralOperator("dcfft")
    solver.max_iter = 10_000
    solver.solve(load / side**2)
    p = np.array(model.traction).reshape(n, n)
    u = np.zeros_like(model.traction)
    model.operators["dcfft"](model.traction, u)  # the solver's own displacement has a free constant
    touching = p > 0
    return {
        "contact_radius": np.sqrt(touching.sum() / np.pi) * side / n,
        "approach": float(u.reshape(n, n)[n // 2, n // 2]),
        "peak_pressure": float(p.max()),
        "pressure": lambda at, y: np.interp(at, x, p[:, n // 2], right=0.0, left=0.0),
    }
