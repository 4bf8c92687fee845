"""Adapter of a contact code: replace the four lines of Hertz by a call of the code."""

import numpy as np


def solve(radius, load, substrate, coatings=(), friction=0.0):
    """The contact of a rigid sphere; SI units, coatings from the surface down as (E, nu, thickness).

    raise NotImplementedError("why") where the code does not solve a problem.
    """
    E, nu = substrate
    E_star = E / (1 - nu**2)
    a = (3 * load * radius / (4 * E_star)) ** (1 / 3)
    p0 = 3 * load / (2 * np.pi * a**2)
    return {
        "contact_radius": a,
        "approach": a**2 / radius,
        "peak_pressure": p0,
        "pressure": lambda x, y: p0 * np.sqrt(np.maximum(1 - (x**2 + y**2) / a**2, 0)),
        # "stress": function of x, y, z, layer; an array of shape (3, 3) + x.shape, tension positive
    }
