"""Uncertainty of a star-shaped pressure, and of the stress by it, in scaled units."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.interpolate import RegularGridInterpolator
from scipy.ndimage import maximum_filter

from fem_reference import element_numbers as chosen
from fem_reference.not_round.gap_closing import BY_CONDITIONS
from fem_reference.not_round.star_contact import StarPressure


def by_degree(lower: Any, companion: Any, beyond: Iterable[tuple[Any, Any]]) -> np.ndarray:
    """Uncertainty by the degree, from the changes to the ``lower`` one and to richer ones ``beyond``.

    companion, second of each ``beyond`` : the changes of either degree to its companion. A richer degree
    follows the mesh more closely: what those explain is left out.
    """
    unexplained = (change - own - companion for change, own in beyond)
    return np.asarray(chosen.OF_FIELDS * np.maximum.reduce([lower, *unexplained]))


@dataclass(frozen=True, eq=False)
class StarEstimate:
    """Uncertainty of a pressure on two meshes, by other degrees; each on the mesh and on its companion.

    lower : the next lower degree on the mesh.   beyond : richer ones
    """

    fine: StarPressure
    companion: StarPressure
    lower: StarPressure
    beyond: tuple[tuple[StarPressure, StarPressure], ...] = ()

    def of_values(
        self,
        at: Callable[[StarPressure], np.ndarray],
        largest: Callable[[np.ndarray], np.ndarray] = np.asarray,
    ) -> np.ndarray:
        """Uncertainty of what each pressure has ``at`` the same points or shares of the way to its edge.

        largest : of changes around each point
        """
        fine, companion, lower = (at(one) for one in (self.fine, self.companion, self.lower))
        of_mesh, to_lower = (largest(np.abs(fine - one)) for one in (companion, lower))
        richer = [(at(one), at(on_companion)) for one, on_companion in self.beyond]
        beyond = [(largest(np.abs(fine - one)), largest(np.abs(one - other))) for one, other in richer]
        return BY_CONDITIONS * of_mesh + by_degree(to_lower, of_mesh, beyond)

    def of_pressure(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Uncertainty of the pressure at points as far from the edge as x, y; 0 outside."""
        w, tau = self.fine.polar(x, y)
        return np.where(w < 1, self._changes[0](np.stack([np.minimum(w, 1), tau], axis=-1)), 0.0)

    def of_stress(self, x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Uncertainty of the stress by that of the pressure, without friction.

        On the surface that of the pressure there or as far inside, and no less than farther inside, for what
        is wrong there moves the stress at the edge too. At a depth z that by the last wave, which has no
        resultant, as by two line loads p d at a distance d: 2 p (d/rho)^2/pi, by K. L. Johnson, Contact
        Mechanics, equation 2.15; rho from the edge, along the surface towards the centre.
        """
        x, y, z = np.broadcast_arrays(x, y, z)
        w, tau = self.fine.polar(x, y)
        inside = w < 2
        share = np.where(inside, 1 - np.abs(1 - w), 0.0)
        here, edge = (self._changes[1](np.stack([at, tau], axis=-1)) for at in (share, np.ones(w.shape)))
        to_edge = np.hypot(np.abs(x) - self.fine.centre, y) / np.maximum(w, 1e-9)
        rho = np.hypot((1 - w) * to_edge, z)
        deep = 2 / np.pi * (self._last_wave * to_edge / np.maximum(rho, 1e-9)) ** 2
        return np.asarray(np.where(z > 0, np.minimum(deep, 1) * edge, np.where(inside, here, 0.0)))

    @property
    def _last_wave(self) -> float:
        """Width 1 - w of the last wave of the polynomials before the edge, T_(D/2)(2 w^2 - 1)."""
        return float(1 - np.cos(np.pi / self.fine.degree))

    @cached_property
    def _changes(self) -> tuple[RegularGridInterpolator, RegularGridInterpolator]:
        """Largest change near w, tau by the companion and other degrees; the largest from w = 0 to w.

        All at the same w, the share of the way to the own edge. A change at one point may be small by chance:
        within one wave of the polynomial around the contact, and next to w, the largest counts; nearer to the
        edge than its last wave, where no condition holds the pressure, the largest of all there.
        """
        w, turn = 1 - np.geomspace(1, 1e-4, 60), np.linspace(0, np.pi, 97)
        wave = 2 * round(turn.size / self.fine.degree) + 1
        last = w > 1 - self._last_wave

        def largest(change: np.ndarray) -> np.ndarray:
            near = maximum_filter(change, (5, wave), mode=("nearest", "mirror"))
            near[last] = near[last].max()
            return np.asarray(near)

        found = self.of_values(lambda one: one(*one.points(w[:, None], turn)), largest)
        here, inwards = (
            RegularGridInterpolator((np.append(w, 1.0), turn), np.vstack([one, one[-1:]]))
            for one in (found, np.maximum.accumulate(found))
        )
        return here, inwards
