"""Effect of a very thick or a very thin coating on the approach, from its compliance M(k).

M(k) is the compliance over that of a half-space of the coating's material, as computed by the references.
"""

import numpy as np

from verification.problem.coated_contact import CoatedContact
from verification.problem.gauss_legendre import on_panels
from verification.sources.references.layered_half_space import LayeredHalfSpace


def thick_shift(thick: CoatedContact, alone: CoatedContact) -> tuple[float, float]:
    """Displacement of the base of a thick coating under the load [m], with the error eta over the approach.

        u_e(0) = W/(pi E1*) int (M-1) dk

    Two points of the contact are at most 2 a apart, so that this varies over the contact by no more than

        eta = W a^2/(pi E1*) int |M-1| k^2 dk,   from |1 - J0(x)| <= x^2/4

    and the approach, which grows with the load, lies within Hertz's + u_e(0) -+ eta.  alone : the coating's
    material as a half-space.
    """
    h = thick.coatings[0][2]
    # M - 1 decays as exp(-2 k h).
    k, w = on_panels(np.concatenate([np.geomspace(1e-6, 1e-1, 21), np.linspace(0.2, 30, 150)]) / h, 12)
    excess = LayeredHalfSpace(thick.coatings, thick.substrate, k).compliance - 1
    per_force = thick.load / (np.pi * alone.E_star)
    eta = per_force * alone.a_h**2 * float(w @ (np.abs(excess) * k**2))
    return per_force * float(w @ excess), eta / alone.delta_h


def thin_shift(thin: CoatedContact) -> float:
    """First-order change of the approach of Hertz's contact of the substrate by a thin coating [m].

        d/dW [ 1/2 int p u_e dA ],   int p u_e dA = (9 W^2/pi E2*) int (m-1) (j1(ka)/ka)^2 dk

    p and a of Hertz, m the compliance over the substrate's: of the complementary energy, which is least in p,
    the first-order change is that at the unchanged pressure.
    """
    E, nu, h = thin.coatings[0]
    edges = np.concatenate([np.arange(0, 400, 2.0), np.geomspace(400, 4000 + 40 * thin.a_h / h, 100)])
    k, w = on_panels(edges / thin.a_h, 12)
    M = LayeredHalfSpace(thin.coatings, thin.substrate, k).compliance
    m = M * thin.E_star * (1 - nu**2) / E

    def energy(W: float) -> float:
        x = k * (3 * W * thin.radius / (4 * thin.E_star)) ** (1 / 3)
        small = x < 1e-2
        safe = np.where(small, 1.0, x)
        j1_over_x = np.where(small, 1 / 3 - x**2 / 30, (np.sin(safe) - safe * np.cos(safe)) / safe**3)
        return float(9 * W**2 / (2 * np.pi * thin.E_star) * (w @ ((m - 1) * j1_over_x**2)))

    step = 1e-3
    up, down = energy(thin.load * (1 + step)), energy(thin.load * (1 - step))
    return (up - down) / (2 * step * thin.load)
