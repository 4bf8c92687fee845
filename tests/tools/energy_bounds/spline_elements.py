"""Piecewise polynomials of one coordinate, as smooth across their knots as a field needs."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from verification.problem.array_types import Array
from verification.problem.gauss_legendre import gauss_legendre

Numbers = NDArray[np.intp]
_HERMITE = np.array([[2, -3, 0, 1], [2, 3, 0, -1], [1, -1, -1, 1], [-1, -1, 1, 1]]) / 4


@dataclass(frozen=True, eq=False)
class Points:
    """The places ``x`` of [-1, 1] in every piece between knots; Gauss points with their weights."""

    knots: Array
    x: Array
    on_piece: Array

    @classmethod
    def gauss(cls, knots: Array, each: int) -> "Points":
        return cls(knots, *gauss_legendre(each))

    @cached_property
    def place(self) -> Array:
        return (self.knots[:-1, None] + np.diff(self.knots)[:, None] / 2 * (1 + self.x)).ravel()

    @cached_property
    def weight(self) -> Array:
        return (np.diff(self.knots)[:, None] / 2 * self.on_piece).ravel()


@dataclass(frozen=True, eq=False)
class Pieces:
    """Polynomials of ``degree`` between ``knots``, with ``smoothness`` -1 (none), 0 or 1 across them.

    The functions are numbered: values at the knots, derivatives at the knots (smoothness 1), then those of
    each piece, integrals of Legendre polynomials that vanish at its ends as the smoothness demands.
    """

    knots: Array
    degree: int
    smoothness: int

    @property
    def values(self) -> Numbers:
        """Numbers of the values at the knots."""
        return np.arange(self.knots.size)

    @property
    def slopes(self) -> Numbers:
        """Numbers of the derivatives at the knots."""
        return self.knots.size + self.values

    @property
    def inner(self) -> Numbers:
        """Numbers of the functions of each piece, shape (pieces, functions)."""
        pieces, each = self.knots.size - 1, self.degree - 1 - 2 * self.smoothness
        return (self.smoothness + 1) * self.knots.size + np.arange(pieces * each).reshape(pieces, each)

    @property
    def size(self) -> int:
        """Number of functions."""
        return (self.smoothness + 1) * self.knots.size + self.inner.size

    def table(self, points: Points, derivative: int = 0) -> Array:
        """A derivative of every function at every point, shape (size, points)."""
        each = legendre.legval(points.x, legendre.legder(self._shapes.T, derivative))
        found = np.zeros((self.size, self.knots.size - 1, points.x.size))
        for i, half in enumerate(np.diff(self.knots) / 2):
            numbers = [*self.values[i : i + 2]] if self.smoothness >= 0 else []
            of_piece = each / half**derivative
            if self.smoothness == 1:
                numbers += [*self.slopes[i : i + 2]]
                of_piece[2:4] *= half
            found[[*numbers, *self.inner[i]], i] = of_piece
        return found.reshape(self.size, -1)

    @cached_property
    def _shapes(self) -> Array:
        """Legendre coefficients of the functions of one piece: those of its ends, then its own."""
        own: Array = np.eye(self.degree + 1)[self.smoothness + 1 : self.degree - self.smoothness]
        for _ in range(self.smoothness + 1):
            own = np.asarray(legendre.legint(own, lbnd=-1, axis=1), dtype=float)
        ends = np.zeros((2 * (self.smoothness + 1), self.degree + 1))
        if self.smoothness == 0:
            ends[:, :2] = [[0.5, -0.5], [0.5, 0.5]]
        elif self.smoothness == 1:
            ends[:, :4] = [legendre.poly2leg(c) for c in _HERMITE]
        return np.vstack([ends, own[:, : self.degree + 1]])
