"""Pressure of a contact with a smooth closed edge, fitted to the pressures of the patches.

    f = sqrt(t) q,   t = 1 - s^2 + 2 sum_n c_n H_n,   q = sum_n H_n sum_m b_mn P_m(tau),

with tau = 2 asinh(t/e)/asinh(1/e) - 1, s^2 = u^2 + v^2, u = (x - x0)/A, v = (y - y0)/B and the harmonic
polynomials H_n = Re (u + iv)^n, for n < 0 Im (u + iv)^-n; s^2 takes the place of H_0 in t. The edge is t = 0:
a circle for n = 0 alone, an ellipse where A and B differ. Under a smooth indenter q is smooth where p is not
(Johnson 1985, section 5.1). On a layer of thickness h it changes within h of the edge: its singularities,
images of the edge in the interface, lie near t = +-4ih/a. With e in proportion to h/a they are as far away in
tau for every thickness, and fewer polynomials are enough than of 2t - 1, the limit for large e: for
E1/E2 = 10, h = 0.02 a twelve for 1e-4 of p0 in place of more than twenty.

The coefficients are those that fit the pressures of the patches in the energy norm: with the columns
phi = df/db, df/dc at the patch centres and e the patches' pressure less f,

    (phi' K phi) x = phi' K e,

K the influence coefficients. Fitted point by point, f would extrapolate over the last patch.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import maximum_filter

from semianalytic import numbers

Array = NDArray[np.floating]

FULL = (*numbers.ACROSS, *(-n for n in numbers.ACROSS[1:]))  # without a symmetry


@dataclass(frozen=True, eq=False)
class Shape:
    """centre (x0, y0), axes (A, B) [m].  harmonics : n, (k,).  contour : c, (k,).  coefficients : b [Pa],
    (M, k).

    outside : f is fitted near the edge alone, where the pressure inside is not smooth, and fades to zero
    inside.  layer : e, of the width over which q changes at the edge.  twin : the mirror image at -x counts
    too.
    """

    centre: tuple[float, float]
    axes: tuple[float, float]
    harmonics: tuple[int, ...]
    contour: Array
    coefficients: Array
    outside: bool = False
    layer: float = np.inf
    twin: bool = False

    @property
    def round(self) -> bool:
        """Whether f depends on the distance from the origin alone."""
        return self.harmonics == numbers.ROUND and self.axes[0] == self.axes[1] and self.centre == (0.0, 0.0)

    @property
    def mirrors(self) -> tuple[bool, bool]:
        """Whether f is even in x and in y."""
        n = np.array(self.harmonics)
        in_y = bool(n.min() >= 0) and self.centre[1] == 0
        return self.centre[0] == 0 and in_y and not np.any(n % 2), in_y

    @cached_property
    def radius(self) -> float:
        """Radius of the disc of the same area [m]; the contact radius of a round contact."""
        area = self.axes[0] * self.axes[1]
        if self.contour.any():
            area *= float(
                np.mean(self.reach(2 * np.pi * np.arange(2 * numbers.AROUND) / (2 * numbers.AROUND)) ** 2)
            )
        return float(np.sqrt(2 * area if self.twin else area))

    @property
    def width(self) -> float:
        """Half the distance from the edge to the singularities of q [m], near t = +-ie."""
        return self.layer * min(self.axes) / 4

    def reach(self, angle: Array) -> Array:
        """s of the edge in the direction ``angle`` of u + iv: t along a ray is nearly 1 - (s/reach)^2."""
        reach: Array = np.ones(np.shape(angle))
        cos, sin = np.cos(angle), np.sin(angle)
        for _ in range(20 if self.contour.any() else 0):
            t = self._in_contour(reach * cos, reach * sin)
            reach = reach / np.sqrt(np.maximum(1 - t, 0.25))
            if np.all(np.abs(t) < 1e-14):
                break
        return reach

    def on_ray(self, s: Array | float, angle: Array) -> tuple[Array, Array]:
        """x and y [m] at a share s of the way from the centre to the edge."""
        reach, (x0, y0), (A, B) = s * self.reach(angle), self.centre, self.axes
        return x0 + A * reach * np.cos(angle), y0 + B * reach * np.sin(angle)

    def matching(self, first: "Shape", x: Array, y: Array) -> tuple[Array, Array]:
        """x and y [m] at the share of the way to the edge at which x and y are under the ``first``."""
        if self.round and first.round:
            ratio = self.radius / first.radius
            return x * ratio, y * ratio
        u, v = first._framed(x, y)
        angle = np.arctan2(v, u)
        X, Y = self.on_ray(np.hypot(u, v) / first.reach(angle), angle)
        return (np.where(x < 0, -X, X) if self.twin else X), Y

    def _in_frame(self, u: Array, v: Array) -> tuple[Array, Array, Array]:
        s2 = u * u + v * v
        t = 1 - s2
        if self.harmonics == numbers.ROUND:
            return t, s2, np.ones((1, *s2.shape))
        H = np.empty((len(self.harmonics), *s2.shape))
        fold, last = math.gcd(*self.harmonics), max(map(abs, self.harmonics))
        power, turn = {0: np.ones(s2.shape, dtype=complex)}, (u + 1j * v) ** fold
        for n in range(fold, last + 1, fold):
            power[n] = power[n - fold] * turn
        for k, n in enumerate(self.harmonics):
            H[k] = power[n].real if n >= 0 else power[-n].imag
        high = np.abs(self.harmonics) > 2
        t = t + 2 * np.tensordot(np.where(high, 0.0, self.contour), H, 1)
        # far away the higher harmonics would make t positive again
        t = np.where(
            t > -numbers.FAR_INSIDE, t + 2 * np.tensordot(np.where(high, self.contour, 0.0), H, 1), t
        )
        return t, s2, H

    def inside(self, x: Array, y: Array) -> Array:
        """t at x, y [m]."""
        return self._in_contour(*self._framed(x, y))

    def _in_contour(self, u: Array, v: Array) -> Array:
        """t, without the harmonic polynomials one by one."""
        t: Array = 1 - u * u - v * v
        if not self.contour.any():
            return t
        fold = math.gcd(*self.harmonics)
        power = np.zeros(max(map(abs, self.harmonics)) // fold + 1, dtype=complex)
        for n, c in zip(self.harmonics, self.contour, strict=True):
            power[abs(n) // fold] += c if n >= 0 else -1j * c
        low, w = 2 // fold + 1, (u + 1j * v) ** fold
        t = t + 2 * np.polynomial.polynomial.polyval(w, power[:low]).real
        return np.where(
            t > -numbers.FAR_INSIDE,
            t + 2 * (w**low * np.polynomial.polynomial.polyval(w, power[low:])).real,
            t,
        )

    def share(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Share of the way from the centre to the edge at x, y [m]; exact on a circle."""
        t, s2, _ = self.polynomials(x, y)
        return np.asarray(1 - t / (1 + np.sqrt(s2)))

    def away(self, x: ArrayLike, y: ArrayLike, least: ArrayLike) -> tuple[Array, Array]:
        """x, y [m], or where those nearer to the edge are ``least`` [m] from it, about, on the ray there."""
        x, y, share = np.asarray(x, dtype=float), np.asarray(y, dtype=float), self.share(x, y)
        least = np.asarray(least) / min(self.axes)
        to = np.where(share > 1, np.maximum(share, 1 + least), np.minimum(share, np.maximum(1 - least, 0.0)))
        by, (x0, y0) = to / np.where(share == 0, 1.0, share), self.centre
        centre = np.copysign(x0, x) if self.twin else x0
        return centre + by * (x - centre), y0 + by * (y - y0)

    def polynomials(self, x: ArrayLike, y: ArrayLike) -> tuple[Array, Array, Array]:
        """t, s^2 and H_n, (k,) + points, at x, y [m], broadcast."""
        return self._in_frame(*self._framed(np.asarray(x, dtype=float), np.asarray(y, dtype=float)))

    def _framed(self, x: Array, y: Array) -> tuple[Array, Array]:
        """x and y [m] from the centre over the axes, of two contacts from that of the nearer one."""
        (x0, y0), (A, B) = self.centre, self.axes
        return ((np.abs(x) if self.twin else x) - x0) / A, (y - y0) / B

    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        """f [Pa], 0 outside the edge; shape of x, y [m], broadcast."""
        t, _, H = self.polynomials(x, y)
        t = np.clip(t, 0, 1)
        return self._faded(t, np.sqrt(t) * self._smooth(t, H))

    def _faded(self, t: Array, f: Array) -> Array:
        if not self.outside:
            return f
        s = np.clip((numbers.FADED_INSIDE[1] - t) / (numbers.FADED_INSIDE[1] - numbers.FADED_INSIDE[0]), 0, 1)
        return f * s**3 * (10 - s * (15 - 6 * s))

    def at_distance(self, square: Array) -> Array:
        """f [Pa] of a round contact at the distances whose squares are given [m^2]."""
        t = np.clip(1 - square / self.axes[0] ** 2, 0, 1)
        return self._faded(t, np.sqrt(t) * legendre.legval(self._argument(t), self.coefficients[:, 0]))

    def square(self, x: Array, y: Array) -> Array:
        """f^2 = t q^2 [Pa^2], continued beyond the edge, where it is negative."""
        t, _, H = self.polynomials(x, y)
        return t * self._smooth(t, H) ** 2

    def _argument(self, t: Array) -> Array:
        """tau, from -1 at the edge to 1 in the centre."""
        if np.isinf(self.layer):
            return 2 * t - 1
        return np.asarray((2 / np.arcsinh(1 / self.layer)) * np.arcsinh(t / self.layer) - 1)

    def _argument_slope(self, t: Array) -> Array | float:
        """dtau/dt."""
        if np.isinf(self.layer):
            return 2.0
        return np.asarray(2 / (np.hypot(t, self.layer) * np.arcsinh(1 / self.layer)))

    def _smooth(self, t: Array, H: Array) -> Array:
        """q [Pa]."""
        P = legendre.legvander(self._argument(t), len(self.coefficients) - 1)
        return np.asarray(np.einsum("...k,k...->...", P @ self.coefficients, H)).reshape(np.shape(t))

    def columns(self, x: Array, y: Array, blunt: float) -> Array:
        """df/db, then df/dc, ((M + 1) k,) + points; 0 outside.  blunt : t below which 1/sqrt(t) is
        constant."""
        t, s2, H = self.polynomials(x, y)
        inside, M = t > 0, len(self.coefficients)
        t = np.clip(t, 0, 1)
        root = np.sqrt(t)
        P = np.moveaxis(legendre.legvander(self._argument(t), M - 1), -1, 0)
        of_b = (root * inside) * P[:, None] * H
        slope = legendre.legder(self.coefficients) if M > 1 else 0 * self.coefficients
        q = np.einsum("mk,mxy,kxy->xy", self.coefficients, P, H, optimize=True)
        dq = self._argument_slope(t) * np.einsum("mk,mxy,kxy->xy", slope, P[: len(slope)], H, optimize=True)
        of_t = np.where(inside, q / (2 * np.sqrt(np.maximum(t, blunt))) + root * dq, 0.0)
        of_c = [2 * of_t * (s2 if n == 0 else h) for n, h in zip(self.harmonics, H, strict=True)]
        return np.concatenate([of_b.reshape(-1, *t.shape), of_c])

    def changed(self, x: Array) -> "Shape":
        """The shape with its coefficients changed by x, ((M + 1) k,); c_0, c_2, c_1 become axes and
        centre."""
        k = len(self.harmonics)
        by = dict(zip(self.harmonics, x[-k:], strict=True))
        c0, c2 = by.get(0, 0.0), by.get(2, 0.0)
        A, B = (
            w / float(np.sqrt(1 - 2 * np.clip(c, -numbers.WIDEST, numbers.WIDEST)))
            for w, c in zip(self.axes, (c0 + c2, c0 - c2), strict=True)
        )
        centre = self.centre[0] + A * by.get(1, 0.0), self.centre[1] + B * by.get(-1, 0.0)
        kept = [n not in (0, 1, -1, 2) for n in self.harmonics]
        contour = self.contour + np.where(kept, x[-k:], 0.0)
        b = self.coefficients + x[:-k].reshape(-1, k)
        return replace(self, centre=centre, axes=(A, B), contour=contour, coefficients=b)

    def widened(self, shift: float) -> "Shape":
        """Shape with its edge ``shift`` [m] farther out."""
        A, B = self.axes
        return replace(self, axes=(A + shift, B + shift))

    def with_terms(self, terms: int, highest: float = np.inf) -> "Shape":
        """Shape with as many polynomials, and all harmonics of its symmetry up to the ``highest``."""
        families = (numbers.HALF,) if self.twin else (numbers.ROUND, numbers.EVEN, numbers.ACROSS, FULL)
        family = next(one for one in families if {*self.harmonics} <= {*one})
        wanted, held = tuple(n for n in family if abs(n) <= highest), min(terms, len(self.coefficients))
        shared = {*wanted} & {*self.harmonics}
        to, of = ([n in shared for n in some] for some in (wanted, self.harmonics))
        b, contour = np.zeros((terms, len(wanted))), np.zeros(len(wanted))
        b[:held, to], contour[to] = self.coefficients[:held, of], self.contour[of]
        return replace(self, harmonics=wanted, contour=contour, coefficients=b)


def start(pressure: Array, x: Array, y: Array, harmonics: tuple[int, ...], terms: int, area: float) -> Shape:
    """Shape of the loaded patches' moments: an ellipse, Hertz's pressure.

    pressure [Pa] : of all patches, centres x, y [m], (nx, ny).  area : of a patch [m^2].
    """
    loaded = pressure > 0
    count = np.count_nonzero(loaded)
    x, y = (np.broadcast_to(v, loaded.shape)[loaded] for v in (x, y))
    x0, y0 = (float(v.mean()) if n in harmonics else 0.0 for n, v in ((1, x), (-1, y)))
    u, v = x - x0, y - y0
    A, B = 2 * float(np.sqrt(np.mean(u * u))), 2 * float(np.sqrt(np.mean(v * v)))
    contour = np.zeros(len(harmonics))
    if harmonics == numbers.ROUND:
        A = B = float(np.sqrt(count * area / np.pi))
    elif -2 in harmonics:  # an ellipse whose axes are turned
        r = 4 * float(np.mean(u * v)) / (A * B)
        A, B = A * float(np.sqrt(1 - r * r)), B * float(np.sqrt(1 - r * r))
        contour[harmonics.index(-2)] = r / 2
    if harmonics in (numbers.ACROSS, FULL):
        A, B = _lobed(contour, harmonics, u / A + 1j * v / B, (A, B), area)
    b = np.zeros((terms, len(harmonics)))
    b[0, 0] = 1.5 * float(pressure[loaded].mean())
    return Shape((x0, y0), (A, B), harmonics, contour, b)


def _lobed(
    contour: Array, harmonics: tuple[int, ...], w: Array, axes: tuple[float, float], area: float
) -> tuple[float, float]:
    """Writes three lobes of the loaded patches w = u + iv, each of an ``area`` [m^2], to the ``contour``.

    The mean of H_n over a circle whose edge is moved by c_n cos(n theta) is c_n, n odd; an ellipse has none.
    Less than a patch in all comes from the staircase and is left out. Returns the axes [m] that leave the
    area as it is.
    """
    A, B = axes
    moments = {n: complex(np.mean(w ** abs(n))) for n in harmonics if abs(n) == 3}
    lobes = {n: one.real if n > 0 else one.imag for n, one in moments.items()}
    if sum(map(abs, lobes.values())) * min(axes) < np.sqrt(area):
        return axes
    for n, c in lobes.items():
        contour[harmonics.index(n)] = c
    whole = Shape((0.0, 0.0), axes, harmonics, contour, np.zeros((1, len(harmonics))))
    wider = float(np.sqrt(w.size * area / np.pi)) / whole.radius
    return A * wider, B * wider


@dataclass(frozen=True, eq=False)
class Step:
    """A change of the coefficients, ((M + 1) k,), and the same in the energy norm, where it is of order one.

    share : of it that was taken.
    """

    change: Array
    scaled: Array
    share: float = numbers.DAMPING


def fitted(
    shape: Shape,
    pressure: Array,
    x: Array,
    y: Array,
    deflection: Callable[[Array], Array],
    weight: Array | None,
    patch: float,
    *,
    before: Step | None = None,
    fixed_edge: bool = False,
) -> tuple[Shape, Step]:
    """The shape nearer to the patches' pressure in the energy norm, and the step to it.

    The step is relaxed: rounds of fit and contact would oscillate. Its share is Aitken's, from the step
    before (Irons and Tuck, Int. J. Numer. Meth. Engng 1 (1969) 275-277).

    pressure [Pa] : of the patches at centres x, y [m], (nx, ny).  deflection : K p.  weight : patches that
    each one represents.  patch [m] : the side.  fixed_edge : change the coefficients b alone.
    """
    k, across = len(shape.harmonics), min(shape.axes)
    columns = shape.columns(x, y, numbers.BLUNT * patch / across)[: -k if fixed_edge else None]
    left = pressure - replace(shape, outside=False).pressure(x, y)
    if shape.outside:
        window = np.clip(
            (numbers.FADED_INSIDE[1] - shape.polynomials(x, y)[0])
            / (numbers.FADED_INSIDE[1] - numbers.FADED_INSIDE[0]),
            0,
            1,
        )
        columns, left = columns * window, left * window
    loaded = (left != 0) | (columns[0] != 0)  # where either pressure acts
    deflected = np.stack([deflection(column)[loaded] for column in columns])
    if weight is not None:
        deflected *= weight[loaded]
    normal, right = deflected @ columns[:, loaded].T, deflected @ left[loaded]
    size = np.sqrt(np.diag(normal))
    normal = (normal + normal.T) / 2 / np.outer(size, size)
    scaled = np.linalg.lstsq(normal, right / size, rcond=1e-14)[0]
    change = scaled / size
    if fixed_edge:
        return shape.changed(np.concatenate([change, np.zeros(k)])), Step(change, scaled)
    share = numbers.DAMPING
    if before is not None and before.scaled.size == scaled.size:
        difference = scaled - before.scaled
        share = -before.share * float(before.scaled @ difference) / float(difference @ difference)
        share = float(np.clip(share, 0.25, 1.0))
    # no farther than a patch at a time
    moved = share * float(np.abs(change[-k:]).sum()) * across
    taken = share * change
    taken[-k:] *= min(1.0, patch / moved) if moved else 1.0
    shape = _between_centres(shape.changed(taken), pressure > 0, x, y, patch)
    return shape, Step(change, scaled, share)


def _between_centres(shape: Shape, loaded: NDArray[np.bool_], x: Array, y: Array, patch: float) -> Shape:
    """The shape with its edge outside the centres of loaded patches and inside those of unloaded ones."""
    t = shape.inside(x, y)
    beside = maximum_filter(loaded, 3) & ~loaded
    slack = 2 * numbers.MISFIT * patch / min(shape.axes)
    low, high = float(t[loaded].min()), float(t[beside].max(initial=-np.inf))
    change = np.zeros((len(shape.coefficients) + 1) * len(shape.harmonics))
    if low < -slack:
        change[-len(shape.harmonics)] = (-slack - low) / 2
    elif high > slack:
        change[-len(shape.harmonics)] = (slack - high) / 2
    return shape.changed(change) if change.any() else shape
