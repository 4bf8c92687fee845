"""Axisymmetric pressure profile that vanishes like a square root at the contact edge.

    p(r) = sqrt(t) q(t),   t = 1 - (r/a)^2,   q = sum_m b_m P_m(2t - 1)

is the pressure of a smooth indenter; the polynomial q is smooth where p is not. Fitted to patch pressures
inside the contact it gives the contact radius a and the pressure between the last patch and the edge.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike, NDArray

__all__ = ["Prescribed", "Profile", "fit", "of_contact", "patch_mean"]

Array = NDArray[np.floating]

MISFIT = 0.02  # of the peak, above which a contact has no edge of this kind
GOOD = 0.003  # of the peak, below which no better fit is sought


@dataclass(frozen=True, eq=False)
class Profile:
    """radius : a [m].  coefficients : b_m [Pa], shape (M,)."""

    radius: float
    coefficients: Array

    def pressure(self, r: ArrayLike) -> Array:
        """p(r) [Pa], 0 outside; shape of ``r`` [m]."""
        t = np.maximum(1 - (np.asarray(r, dtype=float) / self.radius) ** 2, 0)
        return np.sqrt(t) * legendre.legval(2 * t - 1, self.coefficients)

    @property
    def load(self) -> float:
        """W = pi a^2 int_0^1 sqrt(t) q dt [N], exact by Gauss quadrature in sqrt(t)."""
        s, w = legendre.leggauss(len(self.coefficients) + 1)
        s = (1 + s) / 2
        q = legendre.legval(2 * s**2 - 1, self.coefficients)
        return float(np.pi * self.radius**2 * np.sum(w * s**2 * q))


@dataclass(frozen=True, eq=False)
class Prescribed:
    """Any pressure p(r) [Pa] on a disc of ``radius`` [m]; ``load`` is its integral [N], by Gauss points.

    The points are crowded at the rim, where p may fall like a square root.
    Raises ValueError where the function gives no finite pressure.
    """

    radius: float
    function: Callable[[Array], Array]

    def pressure(self, r: ArrayLike) -> Array:
        """p(r) [Pa], 0 outside; shape of ``r`` [m]."""
        r = np.asarray(r, dtype=float)
        value = np.zeros(r.shape)
        inside = r <= self.radius
        value[inside] = self.function(r[inside])
        return value

    @property
    def load(self) -> float:
        s, w = legendre.leggauss(200)
        t = (1 + s) / 2
        r = self.radius * (1 - t**2)
        p = np.asarray(self.function(r), dtype=float)
        if p.shape != r.shape or not np.all(np.isfinite(p)):
            raise ValueError("pressure(r) must return a finite value [Pa] for every r <= load_radius")
        return float(2 * np.pi * self.radius * np.sum(w * p * r * t))


def fit(pressure: Array, r: Array, d: float, *, radius: float, terms: int, skip: float) -> Profile:
    """Least squares of the profile on the patches r < a - skip d, the radius by Newton steps.

    A change of a adds da/a q(0) / sqrt(t) to p, so the coefficient of that column, fitted along, is the step.

    pressure [Pa], r [m] : same shape.  d : side of the patches [m].  radius : first guess of a [m].
    terms : M.  Returns the profile; its radius stays within a patch of the guess.
    """
    a = radius
    p, r = pressure.ravel(), r.ravel()
    for _ in range(8):
        used = r < a - skip * d
        t = 1 - (r[used] / a) ** 2
        root = np.sqrt(t)
        columns = np.concatenate(
            [legendre.legvander(2 * t - 1, terms - 1) * root[:, None], 1 / root[:, None]], 1
        )
        b = np.linalg.lstsq(columns, p[used], rcond=None)[0]
        at_edge = legendre.legval(-1.0, b[:terms])
        # a slope of the wrong sign at the edge does not determine the radius
        step = a * b[terms] / at_edge if at_edge > 0 else 0.0
        a = float(np.clip(a + step, radius - d, radius + d))
        if abs(step) < 1e-10 * a:
            break
    return Profile(a, b[:terms])


def of_contact(
    pressure: Array, r: Array, d: float, *, thickness: float | None, skip: float, share: float = 1.0
) -> Profile | None:
    """Profile of a contact's patch pressures, None where none fits to within ``MISFIT`` of their peak.

    A coating much thinner than the contact bends the pressure within its thickness of the edge, so the number
    of terms grows as the square root of the radius over it, as far as the patches resolve them; a refinement
    study of the patches refines the terms too, by ``share``.

    pressure [Pa], r [m] : (n, n), n odd, symmetric; one quadrant is used.  thickness : of the first coating
    [m], None when uncoated.  skip : patches inside the edge that are left out.  share : of the usual terms.
    """
    c = len(pressure) // 2
    p, r = pressure[c:, c:], r[c:, c:]
    a = float(np.sqrt(np.count_nonzero(pressure) / np.pi) * d)
    usual = 6 + 3.2 * np.sqrt(a / thickness) if thickness else 6
    terms = int(min(share * usual, 20, a / d / 5))
    least, best = MISFIT * float(p.max()), None
    while terms >= 3:
        # patches next to the edge may be too rough for as many terms: leave out more, then fewer terms
        for more in (0.0, 0.5, 1.5):
            shape = fit(p, r, d, radius=a, terms=terms, skip=skip + more)
            used = r < shape.radius - (skip + more) * d
            misfit = float(np.max(np.abs(p - shape.pressure(r)), where=used, initial=0))
            if misfit < least:
                least, best = misfit, shape
            if least < GOOD * float(p.max()):
                return best
        terms = int(0.8 * terms)
    return best


def patch_mean(shape: Profile | Prescribed, x: Array, d: float) -> Array:
    """Mean of an axisymmetric pressure over square patches of side d centred at (x_i, x_j), shape (n, n).

    Gauss points; near the rim along lines that end at it, crowded there for the square root. The remaining
    error of the load, about 1e-7, is removed at the rim patches.

    x : centres [m], symmetric, n odd.
    """
    c = len(x) // 2
    i, j = np.tril_indices(c + 1)
    X, Y = x[c + i], x[c + j]
    r = np.hypot(X, Y)
    near = np.abs(r - shape.radius) < 3 * d
    inner = ~near & (r < shape.radius)
    mean = np.zeros(r.shape)
    s, w = legendre.leggauss(3)
    distance = np.hypot(X[inner, None, None] + s[:, None] * d / 2, Y[inner, None, None] + s * d / 2)
    mean[inner] = np.einsum("pij,i,j->p", shape.pressure(distance), w, w) / 4
    s, w = legendre.leggauss(12)
    y = Y[near, None] + s * d / 2
    # X >= Y: the rim is crossed by lines along x, which end at X + d/2 or at the rim
    start = X[near, None] - d / 2
    rim = np.sqrt(np.maximum(shape.radius**2 - y**2, 0))
    length = np.clip(rim - start, 0, d)
    v, wv = (1 + s) / 2, w / 2
    along = (start + length)[..., None] - length[..., None] * v**2
    # rounding must not put the end of a line beyond the rim
    reach = np.where(length < d, shape.radius, np.inf)[..., None]
    value = shape.pressure(np.minimum(np.hypot(along, y[..., None]), reach))
    mean[near] = np.einsum("pjk,pj,j,k->p", value, length, w / 2, 2 * v * wv) / d
    number = np.where(j == 0, 4, np.where(i == j, 4, 8)) - 3 * (i == 0)  # of equal patches by symmetry
    at_rim = float(np.sum((number * mean)[near]))
    if at_rim:
        mean[near] *= 1 + (shape.load / d**2 - float(np.sum(number * mean))) / at_rim
    quadrant = np.zeros((c + 1, c + 1))
    quadrant[i, j] = quadrant[j, i] = mean
    half = np.concatenate([quadrant[:0:-1], quadrant])
    return np.concatenate([half[:, :0:-1], half], axis=1)
