"""Derivatives of a field by central differences with an estimate of their error.

Romberg's extrapolation of the steps h, 2h, 4h:

    D = [64 d(h) - 20 d(2h) + d(4h)] / 45,   d(h) = [f(+h) - f(-h)] / 2h

Its error is estimated by the change by the third step, |D - (4 d(h) - d(2h))/3|.
"""

from dataclasses import dataclass

import numpy as np

from verification.problem.array_types import Array

_WEIGHTS = np.array([64.0, -20.0, 1.0]) / 45
_SHORTER = np.array([4.0, -1.0, 0.0]) / 3
_STEPS = np.array([1.0, 2.0, 4.0])


@dataclass(frozen=True, eq=False)
class Stencil:
    """Points round ``place``s (3, n) [m] with steps ``step`` (3, n) [m] along each axis.

    The first n points are the places, then 18 for each: (axis, sign, step).
    """

    place: Array
    step: Array

    @property
    def points(self) -> Array:
        """All points, (3, 19 n)."""
        n = self.place.shape[1]
        around = np.broadcast_to(self.place[:, None, None, None, :], (3, 3, 2, 3, n)).copy()
        for axis in range(3):
            for number, sign in enumerate((1.0, -1.0)):
                around[axis, axis, number] += sign * _STEPS[:, None] * self.step[axis]
        return np.concatenate([self.place, around.reshape(3, -1)], axis=1)

    @property
    def corners(self) -> Array:
        """The places and the farthest points at their depth, (3, 5 n)."""
        n = self.place.shape[1]
        around = self.points[:, n:].reshape(3, 3, 2, 3, n)
        return np.concatenate([self.place, around[:, :2, :, -1].reshape(3, -1)], axis=1)

    def gradient(self, values: Array) -> tuple[Array, Array]:
        """d/dx, d/dy, d/dz at the places and the estimated error of the differences, (3,) + (..., n)."""
        f = self._around(values)
        slope = (f[..., 0, :, :] - f[..., 1, :, :]) / (2 * _STEPS[:, None])
        best, shorter = (
            np.einsum("s,...asn->a...n", weights, slope) / self._steps(values)
            for weights in (_WEIGHTS, _SHORTER)
        )
        return best, np.abs(best - shorter)

    def propagated(self, uncertainty: Array) -> Array:
        """Largest effect of uncertain values on the gradient, (3,) + (..., n)."""
        f = self._around(uncertainty)
        each = (f[..., 0, :, :] + f[..., 1, :, :]) / (2 * _STEPS[:, None])
        return np.einsum("s,...asn->a...n", np.abs(_WEIGHTS), each) / self._steps(uncertainty)

    def _around(self, values: Array) -> Array:
        n = self.place.shape[1]
        return values[..., n:].reshape(*values.shape[:-1], 3, 2, 3, n)

    def _steps(self, values: Array) -> Array:
        return self.step.reshape(3, *(1,) * (values.ndim - 1), -1)
