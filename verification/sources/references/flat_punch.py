"""Rigid punch or sphere pressed on a layered half-space to a given contact radius, frictionless.

The Fredholm equation of the second kind, linear once the contact radius is given:

    phi(x) + (2/pi) int_0^a K(x,t) phi(t) dt = (E1*/pi) w(x),   P = 2 pi int_0^a phi dt
    K(x,t) = int_0^inf (M(k) - 1) cos(kx) cos(kt) dk

with w = delta under a flat punch, P = 2 a E1* kappa delta, kappa = 1 on the homogeneous solid, and with
w = delta - x^2/R under a sphere, where phi(a) = 0 fixes delta. Lebedev and Ufliand, PMM 22 (1958) 320-326,
for a layer on a rigid base; Hayes, Keer, Herrmann and Mockros, J. Biomechanics 5 (1972) 541-551, who tabulate
kappa.
"""

from dataclasses import dataclass

import numpy as np

from verification.problem.array_types import Coatings
from verification.problem.gauss_legendre import gauss_legendre, on_panels
from verification.sources.references.layered_half_space import LayeredHalfSpace, contact_modulus


@dataclass(frozen=True)
class Pressed:
    """Flat punch and sphere of one contact radius.

    kappa : stiffness of the flat punch over 2 a E1*.   load, approach : of the sphere, each times its radius
    R [N m, m^2]. The sphere's dW/d delta is the stiffness of the punch.
    """

    kappa: float
    load: float
    approach: float


def pressed(
    a: float, coatings: Coatings, substrate: tuple[float, float], nodes: int = 60, tail: float = 40.0
) -> Pressed:
    """Punch and sphere of contact radius ``a`` [m].

    nodes : Gauss-Legendre points under the punch; more where the layer is thin.
    tail : k h beyond which M - 1 is neglected.
    Raises ValueError where a is not positive.
    """
    if not a > 0:
        raise ValueError(f"a = {a:g} m; a punch has a positive radius")
    E_star = contact_modulus(coatings, substrate)
    if not coatings:
        return Pressed(1.0, 4 / 3 * E_star * a**3, a**2)
    thickness = coatings[0][2]
    nodes += int(2 * a / thickness)
    s, w = gauss_legendre(nodes)
    x, weight = 0.5 * a * (1 + s), 0.5 * a * w
    # Panels short against both the decay with h and the oscillation with a, shortest at k = 0 where M bends.
    end = tail / thickness
    edges = np.concatenate([[0.0], np.geomspace(1e-6, 1.0, 30) * min(1 / a, 1 / thickness)])
    step = min(2.0 / a, 0.5 / thickness)
    edges = np.concatenate([edges, np.arange(edges[-1] + step, end + step, step)])
    k, k_weight = on_panels(edges, 16)
    excess = k_weight * (LayeredHalfSpace(coatings, substrate, k).compliance - 1)
    cosine = np.cos(k[:, None] * np.append(x, a))
    K = (2 / np.pi) * (cosine.T * excess) @ cosine
    given = np.stack([np.ones(nodes), x**2], axis=1)
    phi = np.linalg.solve(np.eye(nodes) + K[:-1, :-1] * weight, given)
    # Nystrom's interpolation gives phi at the edge, where the sphere's must vanish.
    edge = np.array([1.0, a**2]) - (K[-1, :-1] * weight) @ phi
    approach = edge[1] / edge[0]
    load = 2 * E_star * (weight @ (phi @ np.array([approach, -1.0])))
    return Pressed(float(weight @ phi[:, 0] / a), float(load), float(approach))
