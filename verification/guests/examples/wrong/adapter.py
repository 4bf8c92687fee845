"""Four common slips in one adapter: coatcheck guest check names each of them."""

import numpy as np

from verification.sources.references.hertz import Hertz


def solve(radius, load, substrate, friction):
    """Hamilton's sliding contact, with the slips of an afternoon."""
    E, nu = substrate
    # 1. E in place of E* = E/(1 - nu^2) makes the contact too large.
    right = Hertz(radius, load, E * (1 - nu**2), nu, friction)

    def pressure(x, y):
        return 1e-6 * right.pressure(x, y)  # 2. in MPa

    def stress(x, y, z):
        sigma = -right.stress(x, y, z)  # 3. compression positive
        return sigma[np.ix_([1, 0, 2], [1, 0, 2])]  # 4. y for x

    return {
        "contact_radius": right.contact_radius,
        "approach": right.approach,
        "peak_pressure": 1e-6 * right.peak_pressure,
        "pressure": pressure,
        "stress": stress,
    }
