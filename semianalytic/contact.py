"""Conjugate gradients for the pressure of a rigid indenter, its approach and its contact area.

Complementarity on surface patches, u = A p the surface deflection, g0 the undeformed gap:

    g = u + g0 - delta,   g = 0 where p > 0,   g >= 0 where p = 0,   p >= 0,

with sum(p) prescribed (load control) or delta prescribed (approach control). As Polonsky and Keer (Wear
231 (1999) 206-219), with five changes: a preconditioner z = P g that keeps the load (sum z = 0 fixes delta
in each step), g continued beyond the contact before P, about the inverse of A on the whole plane, is applied
(cut off at the edge it would press hard there: twice the iterations, three times under thin stiff coatings);
the deflection carried along, one convolution an iteration; the contact set left alone until its residual has
fallen, tension allowed meanwhile, then updated at once to what it will be when the residual is gone (the
primal-dual active set of Hintermueller, Ito and Kunisch, SIAM J. Optim. 13 (2002) 865-888, with inexact inner
solves); an end test on complementarity itself in place of the change of p.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

__all__ = ["Contact", "NotConverged", "press"]

Array = NDArray[np.floating]
Mask = NDArray[np.bool_]
Operator = Callable[[Array], Array]


class NotConverged(Exception):
    """The iteration stopped short of what was asked; the message says of what, and what to try."""


FALL = 0.5  # of the residual on a fixed contact set, that calls for its update
PATIENCE = 3  # iterations on a fixed contact set
REACH = 2.0  # patches over which the residual is continued beyond the contact, unless told otherwise
CALM = 12  # updates of the set after which it is updated in every iteration
EAGER = 10  # iterations with the residual continued; then cut off at the edge, P is symmetric again
STUBBORN = 50  # iterations after which the preconditioner is dropped: Polonsky and Keer's own iteration


@dataclass(frozen=True, eq=False)
class Contact:
    """Pressure and approach on the patches, and how well they fulfil the contact conditions.

    pressure [Pa], gap [m] : shape of the undeformed gap.  approach [m].
    gap_inside, penetration_outside : largest |g| where p > 0 and largest -g where p = 0, over the scale
    of the gap.  load_error : relative.  history : (gap, penetration) before each iteration.
    convolutions : applications of A.
    """

    pressure: Array
    gap: Array
    approach: float
    gap_inside: float
    penetration_outside: float
    load_error: float
    iterations: int
    convolutions: int
    history: tuple[tuple[float, float], ...]

    @classmethod
    def of_load(cls, pressure: Array) -> "Contact":
        """A pressure that was prescribed: no condition to fulfil, nothing iterated."""
        return cls(pressure, np.zeros_like(pressure), 0.0, 0.0, 0.0, 0.0, 0, 1, ())

    def embedded(self, where: tuple[slice, slice], n: int, open_gap: float) -> "Contact":
        """The same contact on an n x n grid of which it was a window; the gap beyond is said to be open."""
        pressure, gap = np.zeros((n, n)), np.full((n, n), open_gap)
        pressure[where], gap[where] = self.pressure, self.gap
        return replace(self, pressure=pressure, gap=gap)


class _Surroundings:
    """The contact set, and how what is known on it is continued beyond: means of ``reach`` patches."""

    def __init__(self, inside: Mask, reach: float) -> None:
        self.reach = reach
        self.indicator = inside.astype(float)
        share = self._mean(self.indicator, np.empty_like(self.indicator))
        # fading where less than a tenth of the mean is known
        self._weight = (1 - self.indicator) / np.maximum(share, 0.1)
        share *= self._weight
        share += self.indicator
        self.one = share  # a gap of 1, continued

    def continued(self, r: Array, out: Array) -> Array:
        """r, which is 0 outside, in contact, its local mean just outside, 0 far away."""
        self._mean(r, out)
        out *= self._weight
        out += r
        return out

    def _mean(self, r: Array, out: Array) -> Array:
        gaussian_filter(r, self.reach, mode="constant", truncate=3, output=out)
        return out


def _largest(a: Array) -> float:
    return float(max(a.max(), -a.min()))


def _dot(a: Array, b: Array) -> float:
    # not by BLAS: its threads go on turning after such a short sum, in the way of those of the FFT
    return float(np.einsum("ij,ij->", a, b))


def press(
    deflection: Operator,
    gap: Array,
    *,
    total: float | None = None,
    approach: float | None = None,
    start: Array,
    precondition: Operator,
    scale: float,
    tolerance: float,
    max_iterations: int,
    reach: float = REACH,
) -> Contact:
    """Pressure p >= 0 that closes the gap where it acts and leaves it open elsewhere.

    deflection : u = A p, linear, symmetric, positive.  gap : g0 [m], any shape.
    total : sum of p over the patches [Pa], for load control; else approach : delta [m].
    start : first guess of p.  precondition : z = P r, about the inverse of A.
    scale : length by which gap and penetration are judged [m].  tolerance : on each of them, relative.
    reach : patches over which the residual is continued beyond the contact.

    Raises NotConverged after max_iterations, ValueError unless exactly one of total and approach is given.
    """
    if (total is None) == (approach is None):
        raise ValueError("give either total (load control) or approach, not both and not neither")
    if not np.isfinite(start).all():
        raise NotConverged(
            "the first guess of the pressure is not finite; look at the influence coefficients"
        )

    # what every iteration fills anew: gap, gap in contact now and before, continued, P of it, an odd job's
    g, r, last, c, z, work = (np.empty(gap.shape) for _ in range(6))

    def balanced(p: Array) -> Array:
        return p if total is None else p * (total / p.sum())

    def free(r: Array, continued: Array, out: Array) -> Array:
        """P of the residual r, on the contact set."""
        if iterations >= STUBBORN:
            out[:] = r
            return out
        return np.multiply(precondition(continued if iterations < EAGER else r), near.indicator, out=out)

    def of_one() -> Array:
        return free(near.indicator, near.one, np.empty_like(gap)) if approach is None else gap

    def look(final: bool = False) -> float:
        """Fill g, r, c and z, with the delta that keeps the load; returns how far it moved, c not yet.

        final : delta stays as it is, and g and r are all that is filled.
        """
        np.add(u, gap, out=g)
        np.subtract(g, delta, out=g)
        np.multiply(g, near.indicator, out=r)
        if final:
            return 0.0
        free(r, near.continued(r, c), z)
        if approach is not None:
            return 0.0
        more = float(z.sum() / P_one.sum())
        np.subtract(g, more, out=g)
        np.multiply(g, near.indicator, out=r)
        np.subtract(z, np.multiply(P_one, more, out=work), out=z)
        return more

    p = balanced(np.maximum(start, 0.0))
    u = deflection(p)
    inside = p > 0
    near = _Surroundings(inside, reach)
    convolutions, updates, iterations, since, first = 1, 0, 0, 0, 0.0
    P_one = of_one()
    delta = approach or 0.0
    history: list[tuple[float, float]] = []
    step = np.zeros_like(gap)
    slope, carried, final, fresh = 1.0, False, False, False
    while True:
        if iterations == STUBBORN and since:
            # where the preconditioner misleads it has led far astray: begin again
            p = balanced(np.maximum(start, 0.0))
            u, inside, carried = deflection(p), p > 0, False
            near = _Surroundings(inside, reach)
            P_one, since, updates = of_one(), 0, CALM
            convolutions += 1
        if iterations == EAGER and since:
            P_one, since = of_one(), 0
        more = look(final)
        delta += more
        residual = _largest(r) / scale
        first = residual if since == 0 else first
        depth = float(np.subtract(r, g, out=work).max())  # of the penetration outside
        # on the way patches enter with a margin; at the end what was asked decides
        deep = (1.0 if residual <= tolerance else 0.5) * tolerance * scale
        tension = p < 0
        settled = not tension.any() and depth <= deep
        if settled and residual <= tolerance:
            if not carried:
                break
            u, carried, final = deflection(p), False, True  # the test must hold for A p itself
            convolutions += 1
            continue
        if final:
            final = False
            continue
        if iterations >= max_iterations:
            raise NotConverged(
                f"gap in contact {residual:.1e} and penetration {depth / scale:.1e} of the scale "
                f"{scale:.3g} m after {max_iterations} iterations (asked for {tolerance:.0e}); raise "
                "max_iterations or tolerance"
            )
        stays = settled or fresh
        if not stays:
            enter, due = ~inside, True
            if updates >= CALM:
                enter &= g < -deep
            else:
                due = residual <= max(FALL * first, 0.3 * tolerance) or since >= PATIENCE
                # what the set will be once the residual, and its continuation outside, are gone
                c -= np.multiply(near.one, more, out=work)
                enter &= np.subtract(g, c, out=work) < -0.5 * tolerance * scale
                tension &= p < z
            stays = not (due and (tension.any() or enter.any()))
        if not stays:
            inside = (inside & ~tension) | enter
            near = _Surroundings(inside, reach)
            P_one = of_one()
            updates, since = updates + 1, 0
            if tension.any():
                p = balanced(np.where(tension, 0.0, p))
                u, carried = deflection(p), False
                convolutions += 1
            fresh = True
            continue
        fresh = False
        history.append((residual, depth / scale))
        descent = _dot(r, z)
        beta = 0.0 if since == 0 else max(0.0, descent - _dot(last, z)) / slope
        slope = descent
        step *= beta
        step += z
        Au = deflection(step)
        convolutions += 1
        alpha = _dot(r, step) / _dot(step, Au)
        p -= np.multiply(step, alpha, out=work)
        u -= np.multiply(Au, alpha, out=work)
        carried = True
        r, last = last, r
        iterations, since = iterations + 1, since + 1
    error = 0.0 if total is None else abs(float(p.sum()) / total - 1)
    return Contact(
        p, g, delta, residual, max(0.0, depth) / scale, error, iterations, convolutions, tuple(history)
    )
