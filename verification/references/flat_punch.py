"""Rigid flat punch on a layered half-space, frictionless: the Fredholm equation of the second kind.

    phi(x) + (2/pi) int_0^a K(x,t) phi(t) dt = (E1*/pi) delta,   P = 2 pi int_0^a phi dt = 2 a E1* kappa delta
    K(x,t) = int_0^inf (M(k) - 1) cos(kx) cos(kt) dk

with kappa = 1 on the homogeneous solid. Lebedev and Ufliand, PMM 22 (1958) 320-326, for a layer on a rigid
base; Hayes, Keer, Herrmann and Mockros, J. Biomechanics 5 (1972) 541-551, who tabulate kappa.
"""

import numpy as np
from numpy.polynomial import legendre

from verification.references.layered import LayeredHalfSpace

__all__ = ["kappa"]


def kappa(
    a: float,
    coatings: tuple[tuple[float, float, float], ...],
    substrate: tuple[float, float],
    nodes: int = 60,
    tail: float = 40.0,
) -> float:
    """Stiffness P/delta of a punch of radius ``a`` [m] over that of the half-space of the top material.

    nodes : Gauss-Legendre points under the punch; more are taken where the layer is thin.
    tail : k h at which M - 1 is taken for zero.
    Raises ValueError where a is not positive.
    """
    if not a > 0:
        raise ValueError(f"a = {a:g} m; a punch has a positive radius")
    if not coatings:
        return 1.0
    thickness = coatings[0][2]
    nodes += int(2 * a / thickness)
    s, w = legendre.leggauss(nodes)
    x, weight = 0.5 * a * (1 + s), 0.5 * a * w
    # Panels short against both the decay with h and the oscillation with a, shortest at k = 0 where M bends.
    end = tail / thickness
    edges = np.concatenate([[0.0], np.geomspace(1e-6, 1.0, 30) * min(1 / a, 1 / thickness)])
    step = min(2.0 / a, 0.5 / thickness)
    edges = np.concatenate([edges, np.arange(edges[-1] + step, end + step, step)])
    half = 0.5 * np.diff(edges)
    g, gw = legendre.leggauss(16)
    k = ((edges[:-1] + half)[:, None] + half[:, None] * g).ravel()
    excess = (half[:, None] * gw).ravel() * (LayeredHalfSpace(coatings, substrate, k).compliance - 1)
    cosine = np.cos(k[:, None] * x)
    A = np.eye(nodes) + (2 / np.pi) * (cosine.T * excess) @ cosine * weight
    phi = np.linalg.solve(A, np.ones(nodes))
    return float(weight @ phi / a)
