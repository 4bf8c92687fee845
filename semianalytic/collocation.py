"""Contact of a sphere by collocation of the surface deflection under its edge profile.

With p = sqrt(t) q(t), t = 1 - (r/a)^2, the exact deflection of `abel` closes the gap at M + 1 points,

    u(r_i) - delta = -g(r_i),      t_i the Gauss-Legendre points of 0 < t < 1,

linear in the M coefficients and in delta, g the gap, r^2/2R of the parabola; the contact radius a follows
from the load, or from delta, by secant steps. The pressure over sqrt(t) is analytic in t with its nearest
singularities at 2 h beyond the edge, h the depth of what reflects, so that the error falls as exp(-c M
sqrt(h/a)): Boyd, Chebyshev and Fourier Spectral Methods (2001), section 2. Inverting Abel's integral for
every r < a gives the Fredholm equation of the second kind of Lebedev and Ufliand, PMM 22 (1958) 320-326.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import j0

from semianalytic import abel
from semianalytic.contact import NotConverged
from semianalytic.edge_profile import Profile
from semianalytic.inputs import Body, undeformed_gap

__all__ = ["SHARES", "RoundContact", "contact"]

Array = NDArray[np.floating]

SHARES = (1.0, 0.8, 0.64)  # of the terms, on a refinement study of them
MOST = 96  # terms
# Step in log a and weights of the central differences of sixth and of fourth order.
STEP, SIXTH, FOURTH = 0.02, np.array([45.0, -9.0, 1.0]) / 60, np.array([8.0, -1.0, 0.0]) / 12


class RoundContact(NamedTuple):
    """Edge profile, approach [m], d load / d approach [N/m] with the error of its differences."""

    profile: Profile
    approach: float
    stiffness: float
    stiffness_error: float


def contact(
    radius: float,
    load: float | None,
    approach: float | None,
    body: Body,
    shares: Sequence[float] = SHARES,
    gap: str = "parabola",
) -> list[RoundContact]:
    """Contact of a sphere, with every share of the terms in ``shares``.

    radius [m], and load [N] or approach [m], the other None; gap as in `inputs.undeformed_gap`.
    Raises NotConverged where no contact radius is found.
    """
    both, E_star = body.response, body.contact_modulus
    excess, depth = (both.excess, both.depth) if both else (np.zeros_like, np.inf)

    def Hertz(a: float) -> float:
        """Contact radius on a solid as compliant as the layers at the wavelength of a."""
        M = 1 + float(excess(np.array([2 / a]))[0])
        if not M > 0:
            raise NotConverged(f"the layers' compliance is {M:g} of the first one's; check the moduli")
        return (0.75 * load * radius * M / E_star) ** (1 / 3) if load else (radius * (approach or 0)) ** 0.5

    a, last = Hertz(radius), 0.0
    for _ in range(40):
        a, last = 0.5 * (a + Hertz(a)), a
        if abs(a - last) < 1e-6 * a:
            break

    def solved(waves: _Waves, a: float, share: float) -> RoundContact:
        problem = _Collocation(excess, waves, max(4, int(share * _terms(a / depth))))
        return problem.solve(a, undeformed_gap(gap, radius), load, approach, E_star)

    # a film that bends makes the contact far wider than Hertz's, and the terms go by its width
    waves = _Waves.of(a / depth)
    for _ in range(4):
        rough, a = a, solved(waves, a, SHARES[-1]).profile.radius
        if 0.9 < a / rough < 1.1:
            break
        waves = _Waves.of(a / depth)
    return [solved(waves, a, share) for share in shares]


def _terms(ratio: float) -> float:
    """For a contact ``ratio`` times as wide as the depth that reflects."""
    return float(min(MOST, 6 + 6 * np.sqrt(ratio)))


class _Waves(NamedTuple):
    """k a with quadrature weights times the transforms of every term, (nk,) and (terms, nk)."""

    k: Array
    transforms: Array

    @classmethod
    def of(cls, ratio: float) -> "_Waves":
        """For contacts up to a tenth wider than ``ratio`` times the depth that reflects."""
        # a may grow in the search
        k, weight = abel.wavenumbers(2.0, float(np.clip(1.2 * 14 * ratio, 1.0, abel.CYCLES)))
        return cls(k, weight * abel.cosine_transforms(int(_terms(1.2 * ratio)), k))


class _Collocation:
    """The equations at given r/a: what does not depend on a is computed once.

    excess : M(k) - 1 of k [rad/m].  waves : for about the contact radius.
    """

    def __init__(self, excess: Callable[[Array], Array], waves: _Waves, terms: int) -> None:
        self.excess, self.k, self.outer = excess, waves.k, waves.transforms[:terms]
        s, _ = abel.gauss_legendre(terms + 1)
        self.rho = np.sqrt((1 - s) / 2)
        self.inner = abel.over_circle(terms, self.rho)
        self.bessel = j0(np.outer(self.rho, self.k))

    def solve(
        self,
        guess: float,
        gap: Callable[[Array], Array],
        load: float | None,
        approach: float | None,
        E_star: float,
    ) -> RoundContact:
        """The contact; its stiffness from contacts of radii beside it, d log W / d log a over d log delta."""

        def at(a: float) -> tuple[Profile, float]:
            u = 2 / E_star * a * (self.inner + (self.bessel * self.excess(self.k / a)) @ self.outer.T)
            equations = np.concatenate([u, -np.ones((len(u), 1))], axis=1)
            *phi, delta = np.linalg.solve(equations, -gap(a * self.rho))
            return Profile(a, abel.from_potential(np.array(phi))), float(delta)

        def miss(log_a: float) -> float:
            profile, delta = at(float(np.exp(log_a)))
            share = profile.load / load if load else delta / (approach or 1.0)
            return float(np.log(share)) if share > 0 else -1.0

        x, f = np.log(guess), miss(np.log(guess))
        last, before = x - f / (3 if load else 2), f
        y = last
        for _ in range(60):
            f_y = miss(y)
            step = -f_y * (y - x) / (f_y - before) if f_y != before else 0.0
            x, before, y = y, f_y, y + float(np.clip(step, -0.5, 0.5))
            if abs(step) < 1e-13:
                break
            # rounding of the response keeps the steps from vanishing
            if abs(step) < 1e-9 and abs(f_y) >= 0.5 * abs(f):
                break
            f = f_y
        else:
            raise NotConverged(f"no contact radius near {guess:g} m carries the load; check the moduli")
        profile, delta = at(float(np.exp(y)))
        beside = [[at(float(np.exp(y + side * n * STEP))) for n in (1, 2, 3)] for side in (1, -1)]
        logs = np.log([[(one.load, depth) for one, depth in side] for side in beside])
        slopes = (weights @ (logs[0] - logs[1]) for weights in (SIXTH, FOURTH))
        stiffness, rougher = (float(W / d) * profile.load / delta for W, d in slopes)
        return RoundContact(profile, delta, stiffness, abs(stiffness - rougher))
