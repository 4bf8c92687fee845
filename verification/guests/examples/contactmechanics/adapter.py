"""ContactMechanics: constrained conjugate gradients, free half-space, uncoated; its response to a square."""

import numpy as np
from ContactMechanics import FreeFFTElasticHalfSpace
from ContactMechanics.Factory import make_system
from SurfaceTopography import Topography


def solve(substrate, radius=None, load=None, pressure=None, side=None, patches=257):
    """The contact of a paraboloid on the square [-1.5 a, 1.5 a]^2 of ``patches`` a side, an odd number."""
    E, nu = substrate
    E_star, n = E / (1 - nu**2), int(patches)
    if side is not None:
        half_space = FreeFFTElasticHalfSpace((n, n), E_star, (n * side, n * side))
        force = np.zeros((2 * n, 2 * n))
        force[n // 2, n // 2] = -pressure * side**2
        u = half_space.evaluate_disp(force)
        at = lambda v: n // 2 + np.rint(v / side).astype(int)  # noqa: E731
        return {"displacement": lambda x, y, z: np.tile(u[at(x), at(y)], (3, 1))}
    side = 3 * (3 * load * radius / (4 * E_star)) ** (1 / 3)
    x = (np.arange(n) - n // 2) * side / n
    heights = -(x[:, None] ** 2 + x[None, :] ** 2) / (2 * radius)
    half_space = FreeFFTElasticHalfSpace((n, n), E_star, (side, side))
    system = make_system(substrate=half_space, surface=Topography(heights, (side, side)))
    # The tolerance is that of the gap [m].
    result = system.minimize_proxy(external_force=load, pentol=1e-9 * side**2 / radius, maxiter=10_000)
    if not result.success:
        raise RuntimeError(result.message)
    p = np.asarray(half_space.force)[:n, :n] * (n / side) ** 2
    return {
        "contact_radius": np.sqrt((p > 0).sum() / np.pi) * side / n,
        "approach": float(system.offset),
        "peak_pressure": float(p.max()),
        "pressure": lambda at, y: np.interp(at, x, p[:, n // 2], right=0.0, left=0.0),
    }
