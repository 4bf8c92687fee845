"""The largest tension of the surface, found by a source on its own solution.

sigma_xx on y = z = 0 has a cusp at r = a and is smooth elsewhere: in t of r = a cos t inside the contact and
r = a cosh t outside it, up to the edge from either side. The edge is one candidate, the local maxima in t are
the others: bracketed by samples, then found as the maximum of a Chebyshev polynomial, of no higher degree
than the uncertainty of the stress supports.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import chebyshev

from verification.judging.invariants.companion_uncertainty import followed
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, ContactSolution
from verification.problem.point_answers import Points
from verification.sources.references.layered_half_space import bending_length

# Of t: samples close to the edge, where thin films bend, then evenly. REACH: of a, beside 4 bending lengths.
CLOSE, STEP, REACH = np.geomspace(0.01, 0.5, 20), 0.09, 4.0
WINDOW, NODES = 3, 33  # samples either side of the largest one, Chebyshev nodes between the outermost
FITS = np.array([0.03, 0.1, 0.3])  # of the uncertainty: what the polynomial may leave
CLEAR = 0.1  # of the largest sample: by as much it may lie below the maximum that it brackets
# Of a: the distance from the edge at which the uncertainty of the stress no longer is that of the radius.
BESIDE = 1e-2
# x/a of the ends of the contact, where the change over the companions is followed: at a single point it may
# be small by chance.
ENDS = np.outer([-1.0, 1.0], 1 + np.array([-3e-6, -3e-7, 0.0, 3e-7, 3e-6])).ravel()


@dataclass(frozen=True)
class Tension:
    """``value`` [Pa] at ``place`` [m] along x; the uncertainties are None where the source states none."""

    value: float
    place: float
    uncertainty: float | None
    place_uncertainty: float | None


@dataclass(frozen=True, eq=False)
class Search:
    """Search for the largest sigma_xx on y = z = 0; without friction on the trailing half, x <= 0, alone.

    Its samples at ``x`` are evaluated by the caller, in one call with those of the surface line.
    """

    solution: ContactSolution
    problem: CoatedContact

    @cached_property
    def x(self) -> Array:
        """Places [m] of the samples: those of each branch, then five around each edge."""
        a = float(self.solution.contact_radius)
        branches = [side * _radius(a, t) for side, t in self._branches]
        return np.concatenate([*branches, *(side * around_edge(self.solution) for side in self._sides)])

    @property
    def edges(self) -> slice:
        """Samples around the edges."""
        return slice(-5 * len(self._sides), None)

    def largest(self, value: Array, U: Array | None) -> Tension:
        """The largest tension from sigma_xx [Pa] at ``x``; its uncertainty counts at ``edges`` alone."""
        if not np.isfinite(value).all():
            return Tension(np.nan, np.nan, None if U is None else np.nan, None if U is None else np.nan)
        a, U_a = float(self.solution.contact_radius), self.solution.sample(None, "contact_radius").uncertainty
        moved = U_a or 0.0  # every candidate, as the edge does
        sizes = [*(t.size for _, t in self._branches), *(5 for _ in self._sides)]
        parts = np.split(np.arange(value.size), np.cumsum(sizes)[:-1])
        around = parts[len(self._branches) :]
        edges = [(float(value[at[0]]), side * a, at) for side, at in zip(self._sides, around, strict=True)]
        highest, place, at = max(edges, key=lambda edge: edge[0])
        candidates = [(v, x, moved) for v, x, _ in edges]
        best = None
        for (side, t), branch in zip(self._branches, parts, strict=False):
            sample = value[branch]
            local = (sample[1:-1] >= sample[:-2]) & (sample[1:-1] >= sample[2:])
            i = 1 + int(np.argmax(np.where(local, sample[1:-1], -np.inf)))
            if local.any() and sample[i] + CLEAR * abs(sample[i]) > highest:
                found = self._maximum(side, t[max(i - WINDOW, 0)], t[min(i + WINDOW, t.size - 1)])
                candidates.append((found.value, found.place, (found.place_uncertainty or 0.0) + moved))
                if found.value > (highest if best is None else best.value):
                    best = found
        if best is None:
            if U is None:
                return Tension(highest, place, None, None)
            change = followed(self.solution, lambda one: _tension(one, ENDS * one.contact_radius), before=1.0)
            wide = float(edge_uncertainty(value[at], U[at], change))
            best = Tension(highest, place, wide, U_a)
        if best.uncertainty is None or best.place_uncertainty is None:
            return best
        # The place may be that of any candidate as large within the uncertainty.
        least = best.value - 2 * best.uncertainty
        wide = max(abs(x - best.place) + own for v, x, own in candidates if not v < least)
        return Tension(best.value, best.place, best.uncertainty, wide)

    @property
    def _sides(self) -> tuple[float, ...]:
        return (-1.0, 1.0) if self.problem.friction else (-1.0,)

    @cached_property
    def _branches(self) -> list[tuple[float, Array]]:
        """Side and t of the samples outside and inside the contact, the edge first."""
        problem, a = self.problem, float(self.solution.contact_radius)
        bend = bending_length(problem.coatings, problem.substrate) if problem.coatings else 0.0
        end = float(np.arccosh(1 + REACH + 4 * bend / a))
        outside = np.concatenate([[0.0], CLOSE, np.linspace(0.5, end, 2 + int((end - 0.5) / STEP))[1:]])
        inside = np.concatenate([[0.0], -CLOSE, -np.linspace(0.5, np.pi / 2, 8)[1:]])
        return [(side, t) for side in self._sides for t in (outside, inside)]

    def _maximum(self, side: float, first: float, last: float) -> Tension:
        """The smooth maximum for t between ``first`` and ``last``.

        The error of its place is |error of sigma'| / |sigma''|; that of sigma' is estimated by the
        uncertainty over the distance of two samples, about the size of an element, or, of a solution with
        coarser companions, by the largest change of the slope within that distance. To both twice the slopes
        of the first two terms left out are added, for those that follow. More terms follow the noise of the
        solution, fewer leave out more: of those that ``FITS`` give, the least uncertain place counts, its
        distance from the next as part of its uncertainty.
        """
        a = float(self.solution.contact_radius)
        middle, half = (first + last) / 2, abs(last - first) / 2
        s = chebyshev.chebpts1(NODES)
        x = side * _radius(a, middle + half * s)
        sigma, U = self.solution.sample(Points(x, layer=0), "stress")
        c = chebyshev.chebfit(s, sigma[0, 0], NODES - 1)
        # The nodes make the terms orthogonal: cut off, the sum of those left out bounds the residual.
        rest = np.cumsum(np.abs(c[::-1]))[::-1]
        usual = 0.0 if U is None else float(np.median(U[0, 0]))
        numbers = sorted({max(int(np.count_nonzero(rest > fit * usual)), 3) for fit in FITS})
        change = followed(self.solution, lambda one: _slopes(_tension(one, x), s, numbers))

        def found(terms: int, change: Array | None) -> Tension:
            kept = c[:terms]
            roots = chebyshev.chebroots(chebyshev.chebder(kept))
            real = roots[(np.abs(roots.imag) < 1e-6) & (np.abs(roots.real) <= 1)].real
            largest = s[np.argmax(sigma[0, 0])]
            at = float(max([*real, largest], key=lambda place: chebyshev.chebval(place, kept)))
            t = middle + half * at
            value, place = float(chebyshev.chebval(at, kept)), float(side * _radius(a, np.array(t)))
            if U is None:
                return Tension(value, place, None, None)
            near = np.abs(s - at) <= 1 / WINDOW
            wide = float(U[0, 0, near].max())
            slope = a * abs(np.sin(t) if t < 0 else np.sinh(t))
            bend = abs(float(chebyshev.chebval(at, chebyshev.chebder(kept, 2)))) / (half * slope) ** 2
            steep = wide * WINDOW if change is None else float(change[near].max())
            for n, coefficient in enumerate(c[terms : terms + 2], start=terms):
                steep += 2 * abs(coefficient * chebyshev.Chebyshev.basis(n).deriv()(at))
            return Tension(value, place, wide, steep / (half * slope * bend) if slope * bend else np.inf)

        each = [found(terms, None if change is None else change[n]) for n, terms in enumerate(numbers)]
        best, *others = sorted(each, key=lambda one: one.place_uncertainty or 0.0)
        if best.place_uncertainty is None or not others:
            return best
        apart = abs(best.place - others[0].place)
        return Tension(best.value, best.place, best.uncertainty, best.place_uncertainty + apart)


def around_edge(solution: ContactSolution) -> Array:
    """Radii [m] at which ``edge_uncertainty`` needs sigma_xx with its uncertainty, (5,); the first is a."""
    a, U = solution.sample(None, "contact_radius")
    shift = 0.0 if U is None else U
    return np.array([a, a * (1 - BESIDE), a * (1 + BESIDE), a - shift, a + shift])


def edge_uncertainty(value: Array, U: Array, change: Array | None) -> Array:
    """Uncertainty [Pa] of stresses at the solution's own contact edge, (...,).

    The error of the radius moves the place and not the value. The larger uncertainty ``BESIDE`` the edge,
    either side, plus the largest ``change`` at its own ``ENDS`` over the coarser companions, (..., ends); of
    a solution without any at least the excess of its uncertainty at the edge over the change by its uncertain
    radius.
    value, U : at the radii ``around_edge``, (..., 5).
    """
    beside = U[..., 1:3].max(axis=-1)
    if change is not None:
        return beside + change.max(axis=-1)
    return np.maximum(beside, U[..., 0] - np.abs(value[..., 3:] - value[..., :1]).max(axis=-1))


def _radius(a: float, t: Array) -> Array:
    return a * np.where(t < 0, np.cos(np.minimum(t, 0)), np.cosh(np.maximum(t, 0)))


def _slopes(value: Array, s: Array, numbers: list[int]) -> Array:
    """Slopes at the Chebyshev nodes ``s`` of the polynomials of ``numbers`` of terms through ``value``."""
    c = chebyshev.chebfit(s, value, s.size - 1)
    return np.stack([chebyshev.chebval(s, chebyshev.chebder(c[:terms])) for terms in numbers])


def _tension(solution: ContactSolution, x: Array) -> Array:
    return solution.stress(x, 0.0, 0.0, layer=0)[0, 0]
