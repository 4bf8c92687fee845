"""nanite: approach by its models of force against indentation, of Hertz or of one layer (Clifford)."""

import numpy as np
from nanite.model import model_hertz_paraboloidal, model_power_layer_clifford_2009
from scipy.optimize import brentq


def solve(radius, load, substrate, coatings=()):
    """The indentation, negative in nanite, at which a model has the load."""
    E, nu = substrate
    given = {"R": radius}
    if coatings:
        ((E_L, nu_L, t),) = coatings
        model = model_power_layer_clifford_2009.model_func
        given |= {"E_S": E, "nu_S": nu, "E_L": E_L, "nu_L": nu_L, "t": t}
    else:
        model = model_hertz_paraboloidal.model_func
        given |= {"E": E, "nu": nu}

    def excess(depth):
        return float(model(np.array([-depth]), **given)[0]) / load - 1

    return {"approach": brentq(excess, 1e-6 * radius, radius, xtol=1e-15)}
