"""A solved contact as functions of position in SI units."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .mesh import MeridianMesh

__all__ = ["Diagnostics", "Meridian", "NotConverged", "Solution", "Uncertainty"]

# (r, z, layer) of shape (n,) -> displacement (3, n), stress (6, n) amplitudes, see recovery.py
AmplitudeFunction = Callable[[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]
BoundFunction = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]


_NOT_ESTIMATED = "this solution carries no uncertainty; solve with estimate_uncertainty=True"


class NotConverged(Exception):
    """The solver did not reach its tolerance; the text says what was reached and what to try."""


@dataclass(frozen=True)
class Uncertainty:
    """Absolute numerical uncertainty in SI units; ``budget`` has rows (quantity, knob, value)."""

    contact_radius: float
    approach: float
    peak_pressure: float
    budget: tuple[tuple[str, str, float], ...]


@dataclass(frozen=True)
class Diagnostics:
    """How the solution was reached.

    iterations : contact solves on all levels
    dofs, triangles, order : size of the final level
    residual_gap : largest |gap| at the contact's nodes over the approach
    residual_pressure : most negative gap outside, or pressure inside, over approach or peak; 0 when none
    residual_load : |load - asked| / asked
    residual_equilibrium : largest nodal out-of-balance force over the load
    seconds : wall time
    history : (level, contact radius [m], load [N]) of every contact solve
    """

    iterations: int
    dofs: int
    triangles: int
    order: int
    residual_gap: float
    residual_pressure: float
    residual_load: float
    residual_equilibrium: float
    seconds: float
    history: tuple[tuple[str, float, float], ...]


@dataclass(frozen=True, eq=False)
class Meridian:
    """The fields behind a solution as functions of position, both in units of their own.

    normal, tangential : amplitudes of harmonic 0 and 1 (None without friction)
    pressure : r -> p
    normal_bound, tangential_bound, pressure_bound : their uncertainties, None when not estimated
    mesh : the meridian mesh, for the .vtu writer
    length, displacement, stress : SI values of the units
    """

    normal: AmplitudeFunction
    tangential: AmplitudeFunction | None
    pressure: Callable[[np.ndarray], np.ndarray]
    normal_bound: BoundFunction | None
    tangential_bound: BoundFunction | None
    pressure_bound: Callable[[np.ndarray], np.ndarray] | None
    mesh: MeridianMesh
    length: float
    displacement: float
    stress: float

    @property
    def depths(self) -> np.ndarray:
        """Depths of the interfaces [m]."""
        return self.mesh.depths * self.length

    @property
    def far(self) -> float:
        """Extent of the meshed solid [m]."""
        return float(self.mesh.points.max()) * self.length

    def radius(self, x: Any, y: Any) -> np.ndarray:
        """r over the unit of length, broadcast from x and y [m]."""
        return np.hypot(np.asarray(x, dtype=float), np.asarray(y, dtype=float)) / self.length

    def points(self, x: Any, y: Any, z: Any, layer: int | None) -> "_Points":
        """Broadcast and check the points, snap them to interfaces within rounding, find their layers."""
        x, y, z = np.broadcast_arrays(*(np.asarray(c, dtype=float) for c in (x, y, z)))
        shape = x.shape
        x, y, z = x.ravel(), y.ravel(), z.ravel().copy()
        r = np.hypot(x, y)
        # the upper side of an interface belongs to the layer above it
        levels = np.concatenate([[0.0], self.depths])
        thickness = np.diff(levels, append=np.inf)
        for k, level in enumerate(levels):
            h = min(thickness[max(k - 1, 0)], thickness[k], self.mesh.contact_radius * self.length)
            z[np.abs(z - level) <= 1e-9 * h] = level
        if z.size and not (np.all(z >= 0) and np.all(np.isfinite(r)) and np.all(np.isfinite(z))):
            worst = z[~(z >= 0)][0] if np.any(~(z >= 0)) else np.nan
            raise ValueError(
                f"z = {worst:g} m is not inside the solid; depth counts down from 0 at the surface"
            )
        if z.size and max(z.max(), r.max()) > self.far * (1 + 1e-9):
            raise ValueError(
                f"a point {max(z.max(), r.max()):g} m out is beyond the meshed solid ({self.far:g} m); "
                f"ask for a larger far boundary"
            )
        found = np.searchsorted(self.depths, z, side="left")
        if layer is not None:
            if not 0 <= layer <= self.depths.size:
                raise ValueError(f"layer = {layer}; the solid has layers 0 to {self.depths.size}")
            lower = np.concatenate([[0.0], self.depths])[layer]
            upper = np.concatenate([self.depths, [np.inf]])[layer]
            if np.any((z < lower) | (z > upper)):
                wrong = z[(z < lower) | (z > upper)][0]
                raise ValueError(
                    f"z = {wrong:g} m is not in layer {layer}, which reaches from {lower:g} to {upper:g} m"
                )
            found = np.full(z.shape, layer)
        unit = np.where(r > 0, r, 1.0)
        cos = np.where(r > 0, x / unit, 1.0)
        return _Points(r / self.length, z / self.length, cos, y / unit, found, shape)


@dataclass(frozen=True, eq=False)
class _Points:
    """Cylindrical coordinates, r and z over the unit of length, and layers; ``shape`` is what was asked."""

    r: np.ndarray
    z: np.ndarray
    cos: np.ndarray
    sin: np.ndarray
    layer: np.ndarray
    shape: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Solution:
    """Contact of a rigid sphere (or a prescribed pressure) on a coated half-space.

    Origin at first contact, x along sliding, z into the solid; tension positive; SI units.
    surface_nodes : increasing x on y = 0, z = 0 at which pressure is a nodal value
    uncertainty   : of the three scalars, None when not estimated
    stiffness     : d load / d approach [N/m] of the sphere, as of a flat punch of its contact radius
        (Pharr, Oliver and Brotzen, J. Mater. Res. 7 (1992) 613-617); None under a prescribed pressure
    stiffness_uncertainty : absolute, None when not estimated
    """

    contact_radius: float
    approach: float
    peak_pressure: float
    surface_nodes: np.ndarray
    uncertainty: Uncertainty | None
    diagnostics: Diagnostics
    meridian: Meridian = field(repr=False)
    stiffness: float | None = None
    stiffness_uncertainty: float | None = None

    def pressure(self, x: Any, y: Any = 0.0) -> np.ndarray:
        """Contact pressure [Pa] at the surface points (x, y), broadcast; zero outside the contact."""
        m = self.meridian
        return m.pressure(m.radius(x, y)) * m.stress

    def pressure_uncertainty(self, x: Any, y: Any = 0.0) -> np.ndarray:
        """Absolute numerical uncertainty of ``pressure`` [Pa], same shape.

        Raises ValueError when the solution was solved without an estimate.
        """
        m = self.meridian
        if m.pressure_bound is None:
            raise ValueError(_NOT_ESTIMATED)
        return m.pressure_bound(m.radius(x, y)) * m.stress

    def stress(self, x: Any, y: Any, z: Any, layer: int | None = None) -> np.ndarray:
        """Stress tensor sigma[i, j, ...] [Pa] in x, y, z; shape (3, 3) + broadcast shape of the points.

        layer : 0 at the surface to the number of coatings in the substrate; picks the side of an interface,
        None
            means the upper one. Raises ValueError for a point outside the solid or outside its ``layer``.
        """
        at = self.meridian.points(x, y, z, layer)
        _, sigma = self.meridian.normal(at.r, at.z, at.layer)
        if self.meridian.tangential is not None:
            _, sliding = self.meridian.tangential(at.r, at.z, at.layer)
            sigma = sigma + sliding * np.stack([at.cos] * 4 + [at.sin] * 2)
        return _tensor(sigma * self.meridian.stress, at.cos, at.sin).reshape(3, 3, *at.shape)

    def stress_uncertainty(self, x: Any, y: Any, z: Any, layer: int | None = None) -> np.ndarray:
        """Absolute numerical uncertainty of every component of ``stress`` [Pa], same shape.

        Raises ValueError like ``stress``, and when the solution was solved without an estimate.
        """
        if self.meridian.normal_bound is None:
            raise ValueError(_NOT_ESTIMATED)
        at = self.meridian.points(x, y, z, layer)
        cos, sin = np.abs(at.cos), np.abs(at.sin)
        bound = self.meridian.normal_bound(at.r, at.z, at.layer)
        if self.meridian.tangential_bound is not None:
            bound = bound + self.meridian.tangential_bound(at.r, at.z, at.layer) * np.stack(
                [cos] * 4 + [sin] * 2
            )
        # every product in the rotation counts with its modulus
        return _tensor(bound * self.meridian.stress, cos, sin, sign=1.0).reshape(3, 3, *at.shape)

    def displacement(self, x: Any, y: Any, z: Any) -> np.ndarray:
        """Displacement (u_x, u_y, u_z) [m], u_z into the solid; shape (3,) + that of the points."""
        at = self.meridian.points(x, y, z, None)
        u, _ = self.meridian.normal(at.r, at.z, at.layer)
        if self.meridian.tangential is not None:
            sliding, _ = self.meridian.tangential(at.r, at.z, at.layer)
            u = u + sliding * np.stack([at.cos, at.sin, at.cos])
        xyz = np.stack([u[0] * at.cos - u[1] * at.sin, u[0] * at.sin + u[1] * at.cos, u[2]])
        return xyz.reshape(3, *at.shape) * self.meridian.displacement


def _tensor(s: np.ndarray, cos: np.ndarray, sin: np.ndarray, sign: float = -1.0) -> np.ndarray:
    """Rotate (rr, tt, zz, rz, rt, tz) to x, y, z; ``sign`` = 1 adds where a rotation subtracts."""
    rr, tt, zz, rz, rt, tz = s
    cross = cos * sin
    xx = cos**2 * rr + sin**2 * tt + sign * 2 * cross * rt
    yy = sin**2 * rr + cos**2 * tt + 2 * cross * rt
    xy = cross * (rr + sign * tt) + (cos**2 + sign * sin**2) * rt
    xz = cos * rz + sign * sin * tz
    yz = sin * rz + cos * tz
    return np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz]).reshape(3, 3, -1)
