"""Prescribed pressure on a disc, on patches and as a function of the distance from the axis."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from semianalytic import numbers
from semianalytic.stresses.ring_quadrature import gauss_legendre

Array = NDArray[np.floating]


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

    @cached_property
    def singular_radii(self) -> tuple[float, ...]:
        """The rim [m] where p jumps to 0 there, so that its stress has no value; () where it does not."""
        p = np.abs(self.pressure(self.radius * np.linspace(0.0, 1.0, 101)))
        return (self.radius,) if p[-1] > numbers.JUMP * p.max() else ()

    def refuse_inner_jump(self) -> None:
        """Raise ValueError where p jumps inside the disc: rings are integrated up to its rim.

        Of the largest step between 1024 radii the half with the larger part is kept until nothing is left to
        halve; what then is left of the step is a jump.
        """
        r = self.radius * np.linspace(0.01, 1.0, 1025)[:-1]
        p = self.pressure(r)
        k = int(np.argmax(np.abs(np.diff(p))))
        low, high = r[k : k + 2]
        for _ in range(60):
            middle = (low + high) / 2
            steps = np.abs(np.diff(self.pressure(np.array([low, middle, high]))))
            low, high = (low, middle) if steps[0] >= steps[1] else (middle, high)
        if steps.max() > numbers.JUMP * np.abs(p).max():
            raise ValueError(
                f"pressure(r) jumps at r = {high:g} m, inside load_radius = {self.radius:g} m; add the "
                f"solutions of two loads: one that is continuous there, the rest with load_radius {high:g} m"
            )

    def is_singular(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> NDArray[np.bool_]:
        """Whether pressure and stress have no value at points [m], broadcast: at ``singular_radii``."""
        r, z = np.broadcast_arrays(np.hypot(x, y), np.asarray(z, dtype=float))
        away = np.abs(r[..., None] - self.singular_radii)
        return np.hypot(away, z[..., None]).min(axis=-1, initial=np.inf) <= numbers.ROUNDING * self.radius

    def of_square(self, square: Array) -> Array:
        """p [Pa] of the square of r [m^2]."""
        return self.pressure(np.sqrt(square))

    @property
    def load(self) -> float:
        t, w = gauss_legendre(200)
        r = self.radius * (1 - t**2)
        p = np.asarray(self.function(r), dtype=float)
        with np.errstate(all="ignore"):
            ends = self.pressure(np.array([0.0, self.radius]))
        if p.shape != r.shape or not np.all(np.isfinite([*p, *ends])):
            raise ValueError("pressure(r) must return a finite value [Pa] for 0 <= r <= load_radius")
        return float(4 * np.pi * self.radius * np.sum(w * p * r * t))


def patch_mean(shape: Prescribed, x: Array, d: float) -> Array:
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
    s, w = gauss_legendre(3, -0.5, 0.5)
    distance = np.hypot(X[inner, None, None] + s[:, None] * d, Y[inner, None, None] + s * d)
    mean[inner] = np.einsum("pij,i,j->p", shape.pressure(distance), w, w)
    s, w = gauss_legendre(12)
    y = Y[near, None] + (s - 0.5) * d
    # X >= Y: the rim is crossed by lines along x, which end at X + d/2 or at the rim
    start = X[near, None] - d / 2
    rim = np.sqrt(np.maximum(shape.radius**2 - y**2, 0))
    length = np.clip(rim - start, 0, d)
    along = (start + length)[..., None] - length[..., None] * s**2
    # rounding must not put the end of a line beyond the rim
    reach = np.where(length < d, shape.radius, np.inf)[..., None]
    value = shape.pressure(np.minimum(np.hypot(along, y[..., None]), reach))
    mean[near] = np.einsum("pjk,pj,j,k->p", value, length, w, 2 * s * w) / d
    number = np.where(j == 0, 4, np.where(i == j, 4, 8)) - 3 * (i == 0)  # of equal patches by symmetry
    at_rim = float(np.sum((number * mean)[near]))
    if at_rim:
        mean[near] *= 1 + (shape.load / d**2 - float(np.sum(number * mean))) / at_rim
    quadrant = np.zeros((c + 1, c + 1))
    quadrant[i, j] = quadrant[j, i] = mean
    return np.pad(quadrant, ((c, 0), (c, 0)), mode="reflect")


def deconvolve(mean: Array) -> Array:
    """Constant patches equivalent to a pressure of these patch means: p - (d^2/12) laplacian(p).

    The means lack the second moment of the pressure in the patch, d^2/24, and constant patches once more.
    """
    q = np.pad(mean, 1)
    around = q[2:, 1:-1] + q[:-2, 1:-1] + q[1:-1, 2:] + q[1:-1, :-2]
    return mean - (around - 4 * mean) / 12
