"""Four common slips in one adapter: coatcheck guest check names each of them."""

import numpy as np

from verification.sources.references.hertz import Hertz


def solve(radius, load, substrate, friction):
    """Hamilton's sliding contact, with the slips of an afternoon."""
    E, nu = substrate
    right = Hertz(radius, load, E, nu, friction)
    # 1. E in place of E* = E/(1 - nu^2) makes the contact too large.
    a = (3 * load * radius / (4 * E)) ** (1 / 3)

    def pressure(x, y):
        return 1e-6 * right.pressure(x, y)  # 2. in MPa

    def stress(x, y, z):
        sigma = -right.stress(x, y, z)  # 3. compression positive
        return sigma[np.ix_([1, 0, 2], [1, 0, 2])]  # 4. y for x

    return {
        "contact_radius": a,
        "approach": a**2 / radius,
        "peak_pressure": 3 * load / (2 * np.pi * a**2),
        "pressure": pressure,
        "stress": stress,
    }
