"""A coated half-space under any pressure that is even in y: one meridian problem for each angular harmonic.

On a body of revolution a load of harmonic m gives displacements of that harmonic (``axisymmetric``). With

    p(r, theta) = sum_m p_m(r) cos(m theta),        q = f p in +x,

the tractions of harmonic m on the surface are, with p_-m = p_m and p_0 counted twice,

    p_m,   q_r = f (p_(m-1) + p_(m+1))/2,   q_theta = -f (p_(m-1) - p_(m+1))/2,        m >= 1,

and p_0, q_r = f p_1/2 for m = 0. One matrix each; the fields are their sum. So a contact without symmetry,
solved by another method, is checked: under its pressure the gap has to vanish inside it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from skfem import FacetBasis, LinearForm, asm

from .axisymmetric import ELEMENTS, Discretisation
from .linear_system import constrained_solve
from .location import SolidPoints, solid_points
from .mesh import Grading, MeridianMesh, meridian_mesh
from .recovery import HarmonicField
from .scaling import LayeredSolid, Units
from .solution import cartesian, tensor
from .validation import check_choice, check_materials, check_positive, check_proportions

__all__ = ["PressedSolid", "check_pressure"]

Pressure = Callable[[Any, Any], Any]
Coatings = tuple[tuple[float, float, float], ...]

ANGLES = 4096  # midpoints on half a circle: p falls to zero like a square root there
RADIAL = 95  # degree up to which an edge of the surface is integrated: p_m has kinks inside it
COARSER = 1.4  # triangles of the companion over those of the mesh
NEGLIGIBLE = 1e-9  # of the largest pressure: a harmonic below is left out
# What lies beyond the last harmonic, over what the last third of them adds: of the deflection, whose terms
# fall as m^-5/2, of the stress, m^-3/2.
BEYOND = 1.2, 4.5


def check_pressure(
    *,
    pressure: Pressure,
    reach: float,
    coatings: Coatings,
    substrate: tuple[float, float],
    friction: float = 0.0,
    harmonics: int = 24,
    order: int = 4,
    size: float = 0.16,
    far: float = 1000.0,
    estimate_uncertainty: bool = True,
) -> "PressedSolid":
    """Deflection and stresses of a coated half-space under a given pressure, and the gap that it leaves.

    pressure : p(x, y) [Pa] of arrays [m], even in y.  reach [m] : distance from the origin without pressure
    coatings ((E, nu, thickness), ...), substrate (E, nu), friction f in q = f p : as in ``solve``
    harmonics : the last angular harmonic of the pressure
    size : of the triangles below the pressure, over ``reach``; they grow beyond
    far : distance of the outer boundary over (reach + thickness of all coatings)
    Raises ValueError for bad input, for a pressure that is not even in y or reaches farther.
    """
    check_positive(reach=reach, far=far, size=size, harmonics=harmonics)
    check_materials(coatings, substrate, friction)
    check_choice("order", order, (2, 3, 4))
    solid = LayeredSolid.scaled(coatings, substrate, reach, far, substrate[0])
    check_proportions(solid.thicknesses, "reach")
    angular = AngularPressure.of(pressure, reach)
    unit = Units(length=reach, pressure=angular.scale, modulus=substrate[0])

    def under(size: float, last: int) -> _Fields:
        mesh = meridian_mesh(
            contact_radius=1.0,
            thicknesses=solid.thicknesses,
            far=solid.far,
            grading=Grading(
                size,
                1.9 * size,
                size,
                size,
                far_size=min(2 * size, 0.7),
                film_size=2 * size,
                rows=0.35 / size,
            ),
        )
        return _Fields.of(solid, Discretisation(mesh, order), angular, friction, last)

    fine = under(size, int(harmonics))
    coarse = under(COARSER * size, int(harmonics)) if estimate_uncertainty else None
    return PressedSolid(fine, coarse, unit, pressure)


@dataclass(frozen=True, eq=False)
class AngularPressure:
    """p(r, theta) over its largest value ``scale`` [Pa], r over ``reach`` [m]."""

    pressure: Pressure
    reach: float
    scale: float

    @classmethod
    def of(cls, pressure: Pressure, reach: float) -> "AngularPressure":
        """Raises ValueError for a pressure that is not finite, even in y and zero beyond ``reach``."""
        r, theta = np.linspace(0, 1.5, 61)[:, None], np.pi * (np.arange(90) + 0.5) / 90
        x, y = reach * r * np.cos(theta), reach * r * np.sin(theta)
        p, mirrored = (np.asarray(pressure(x, side * y), dtype=float) for side in (1, -1))
        scale = float(np.max(np.abs(p)))
        if not (np.isfinite(scale) and scale > 0):
            raise ValueError(f"the pressure is {scale:g} Pa at most; it must be finite and not zero")
        if np.max(np.abs(p - mirrored)) > 1e-6 * scale:
            raise ValueError(
                "the pressure is not even in y; turn x and y so that y = 0 is a plane of symmetry"
            )
        beyond = float(np.max(np.abs(p[r[:, 0] > 1 + 1e-9])))
        if beyond > 1e-9 * scale:
            raise ValueError(f"the pressure is {beyond:g} Pa beyond reach = {reach:g} m; enlarge it")
        return cls(pressure, reach, scale)

    def at(self, r: np.ndarray) -> np.ndarray:
        """p at the angles of ``ANGLES`` on half circles of radius r, shape of r + (ANGLES,)."""
        theta = np.pi * (np.arange(ANGLES) + 0.5) / ANGLES
        x, y = (self.reach * r[..., None] * wave(theta) for wave in (np.cos, np.sin))
        return np.asarray(self.pressure(x, y), dtype=float) / self.scale

    def harmonics(self, r: np.ndarray, last: int) -> np.ndarray:
        """p_m at radii r for m = 0, .., last; (last + 1,) + shape of r."""
        theta = np.pi * (np.arange(ANGLES) + 0.5) / ANGLES
        waves = np.cos(np.arange(last + 1)[:, None] * theta) * (2 / ANGLES)
        waves[0] /= 2
        flat = r.ravel()
        found = np.empty((last + 1, flat.size))
        for begin in range(0, flat.size, 64):
            part = slice(begin, begin + 64)
            found[:, part] = waves @ self.at(flat[part]).T
        return found.reshape(last + 1, *r.shape)


def tractions(p: np.ndarray, friction: float) -> np.ndarray:
    """Normal p, q_r and q_theta of each harmonic under p_m, (harmonics,) + points; one harmonic more.

    Returns shape (harmonics + 1, 3) + points.
    """
    found = np.zeros((len(p) + 1, 3, *p.shape[1:]))
    found[: len(p), 0] = p
    if friction:
        halves = np.zeros((len(p) + 2, *p.shape[1:]))
        halves[: len(p)] = p / 2
        halves[0] *= 2
        below, above = halves[:-2], halves[2:]
        found[1:, 1] = friction * (below + above)
        found[1:, 2] = -friction * (below - above)
        found[0, 1] = friction * halves[1]
    return found


@dataclass(frozen=True, eq=False)
class _HarmonicOfLoad(HarmonicField):
    """Field of one harmonic under ``tractions`` of r: p, q_r, q_theta, (3, n)."""

    tractions: Callable[[np.ndarray], np.ndarray]

    def _surface_tractions(self, r: np.ndarray) -> np.ndarray:
        return -self.tractions(r)


@dataclass(frozen=True, eq=False)
class _Fields:
    """The fields of all harmonics on one mesh, in scaled units.

    work : int p u_z dA.  load : int p dA
    """

    discretisation: Discretisation
    fields: tuple[_HarmonicOfLoad, ...]
    last: int
    load: float
    work: float
    angular: AngularPressure
    radii: np.ndarray
    weights: np.ndarray

    @classmethod
    def of(
        cls, solid: LayeredSolid, d: Discretisation, angular: AngularPressure, friction: float, last: int
    ) -> "_Fields":
        facets = d.facets(lambda x: (x[1] == 0) & (x[0] < 1))
        basis = FacetBasis(d.triangulation, ELEMENTS[d.order](), facets=facets, intorder=RADIAL)
        r = np.asarray(basis.global_coordinates())[0]
        weights = r * np.asarray(basis.dx)
        p = angular.harmonics(r, last)
        of_load = tractions(p, friction)
        largest = np.abs(of_load).max(axis=(1, 2, 3))
        load = 2 * np.pi * float((p[0] * weights).sum())
        fields, work = [], 0.0
        for m in np.flatnonzero(largest > NEGLIGIBLE):
            forces = [_surface_load(basis, one) for one in of_load[m]]
            u = _solved(solid, d, int(m), forces, load, friction)
            count = 2 if m == 0 else 3
            angle = 2 * np.pi if m == 0 else np.pi
            work += angle * float(forces[0] @ u.reshape(count, -1)[-1])

            def at(r: np.ndarray, m: int = int(m)) -> np.ndarray:
                inside = r < 1
                found = np.zeros((3, r.size))
                found[:, inside] = tractions(angular.harmonics(r[inside], last), friction)[m]
                return found

            fields.append(_HarmonicOfLoad(d, u, solid.materials, int(m), _none, 0.0, False, at))
        return cls(d, tuple(fields), last, load, work, angular, r, weights)

    def __call__(self, points: SolidPoints) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Displacement (3, n) and stress (6, n), cylindrical, and what the last third of harmonics adds."""
        theta = np.arctan2(points.sin, points.cos)
        u, s = np.zeros((3, theta.size)), np.zeros((6, theta.size))
        late_u, late_s = np.zeros_like(u), np.zeros_like(s)
        for field in self.fields:
            cos, sin = np.cos(field.harmonic * theta), np.sin(field.harmonic * theta)
            displacement, stress = field(points.located)
            displacement *= np.stack([cos, sin, cos])
            stress *= np.stack([cos] * 4 + [sin] * 2)
            u += displacement
            s += stress
            if field.harmonic > 2 * self.last / 3:
                late_u += displacement
                late_s += stress
        return u, s, late_u, late_s

    def mean(self, field: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> float:
        """Mean of a field of x and y [reach], even in y, weighted with the pressure."""
        theta = np.pi * (np.arange(ANGLES) + 0.5) / ANGLES
        total = 0.0
        for r, w in zip(self.radii, self.weights, strict=True):
            p = self.angular.at(r)
            values = field(r[:, None] * np.cos(theta), r[:, None] * np.sin(theta))
            total += float(w @ (p * values).sum(axis=1)) * 2 * np.pi / ANGLES
        return total / self.load


def _none(r: np.ndarray) -> np.ndarray:
    return np.zeros(r.shape)


def _surface_load(basis: FacetBasis, traction: np.ndarray) -> np.ndarray:
    """int traction v r dr over the edges of ``basis``, of values at its points of quadrature."""
    form = LinearForm(lambda v, w: w.traction * v * w.x[0])
    return np.asarray(asm(form, basis, traction=traction))


def _solved(
    solid: LayeredSolid, d: Discretisation, m: int, forces: list[np.ndarray], load: float, friction: float
) -> np.ndarray:
    """Field vector of harmonic m under the load vectors of p, q_r, q_theta.

    On the outer boundary the displacement due to the resultant: normal for m = 0, tangential for m = 1.
    """
    normal, radial, angular = forces
    if m == 0:
        b = np.concatenate([radial, normal])
        far = list(load * solid.far_displacement(*d.locations[:, d.outer]))
        axis: tuple[int, ...] = (0,)
    else:  # virtual work q_r U + q_theta V + p Z with U = S - V
        b = np.concatenate([radial, angular - radial, normal])
        U, V, Z = friction * load * (m == 1) * solid.far_sliding(*d.locations[:, d.outer])
        far = [U + V, V, Z]
        axis = (0, 2) if m == 1 else (0, 1, 2)
    K = d.skeleton(solid.materials, m)
    given = np.zeros(b.size)
    for field, values in enumerate(far):
        given[field * d.N + d.outer] = values
    for field in axis:
        given[field * d.N + d.axis] = 0.0
    fixed = [field * d.N + d.outer for field in range(len(far))] + [field * d.N + d.axis for field in axis]
    solved = constrained_solve(
        K.matrix, given[:, None], np.concatenate([*fixed, K.inner.ravel()]), b[:, None]
    )
    return K.extended(solved.u)[:, 0]


@dataclass(frozen=True, eq=False)
class PressedSolid:
    """A coated half-space under a given pressure; x along sliding, z into it, tension positive, SI."""

    _fine: _Fields
    _coarse: _Fields | None
    _units: Units
    _pressure: Pressure

    @property
    def load(self) -> float:
        """Resultant of the pressure [N]."""
        return self._fine.load * self._units.load

    @cached_property
    def mesh(self) -> MeridianMesh:
        return self._fine.discretisation.mesh

    def pressure(self, x: Any, y: Any = 0.0) -> np.ndarray:
        """The given pressure [Pa]; x, y [m], broadcast."""
        return np.asarray(self._pressure(*np.broadcast_arrays(x, y)), dtype=float)

    def displacement(self, x: Any, y: Any, z: Any) -> np.ndarray:
        """Displacement (u_x, u_y, u_z) [m], shape (3,) + points; x, y, z [m], broadcast."""
        return self.displacement_with_uncertainty(x, y, z, uncertainty=False)[0]

    def displacement_with_uncertainty(
        self, x: Any, y: Any, z: Any, uncertainty: bool = True
    ) -> tuple[np.ndarray, np.ndarray]:
        """Displacement and its uncertainty [m]: the change from a coarser mesh, and the last harmonics'.

        Raises ValueError where no uncertainty was estimated.
        """
        (u, U), shape = self._sums(x, y, z, None, uncertainty, 0)
        return tuple(v.reshape(3, *shape) * self._units.displacement for v in (u, U))  # type: ignore[return-value]

    def stress(self, x: Any, y: Any, z: Any, layer: int | None = None) -> np.ndarray:
        """Stress tensor [Pa], shape (3, 3) + points; ``layer`` as in ``Solution.stress``."""
        return self.stress_with_uncertainty(x, y, z, layer, uncertainty=False)[0]

    def stress_with_uncertainty(
        self, x: Any, y: Any, z: Any, layer: int | None = None, uncertainty: bool = True
    ) -> tuple[np.ndarray, np.ndarray]:
        """Stress and its uncertainty [Pa], as ``displacement_with_uncertainty``."""
        (s, U), shape = self._sums(x, y, z, layer, uncertainty, 1)
        return tuple(v.reshape(3, 3, *shape) * self._units.pressure for v in (s, U))  # type: ignore[return-value]

    def gap(
        self, x: Any, y: Any, height: Callable[[Any, Any], Any], approach: float | None = None
    ) -> np.ndarray:
        """Gap [m] left under an indenter whose surface has ``height`` (x, y) [m]: height + u_z - approach.

        approach : of the indenter [m]; ``approach_of`` it by default.
        """
        approach = self.approach_of(height) if approach is None else approach
        return height(*np.broadcast_arrays(x, y)) + self.displacement(x, y, 0.0)[2] - approach

    def approach_of(self, height: Callable[[Any, Any], Any]) -> float:
        """Approach [m] at which the gap vanishes in the mean, weighted with the pressure."""
        reach = self._units.length
        lifted = self._fine.mean(lambda x, y: np.asarray(height(reach * x, reach * y)) / reach) * reach
        return lifted + self._fine.work / self._fine.load * self._units.displacement

    def _sums(
        self, x: Any, y: Any, z: Any, layer: int | None, uncertainty: bool, which: int
    ) -> tuple[tuple[np.ndarray, np.ndarray], tuple[int, ...]]:
        """Displacement (which = 0) or stress (1), Cartesian, (3 or 9, n), with its uncertainty; scaled."""
        if uncertainty and self._coarse is None:
            raise ValueError("this solution has no uncertainty; solve with estimate_uncertainty=True")
        values = []
        for fields in (self._fine, self._coarse) if uncertainty else (self._fine,):
            assert fields is not None
            points = solid_points(fields.discretisation.locator, self._units.length, x, y, z, layer)
            found = fields(points)
            turn = tensor if which else cartesian
            values.append([turn(found[k], points.cos, points.sin) for k in (which, 2 + which)])
        value, late = (one.reshape(9 if which else 3, -1) for one in values[0])
        if not uncertainty:
            return (value, np.zeros_like(value)), points.shape
        change = np.abs(value - values[1][0].reshape(value.shape)).max(axis=0)
        spread = BEYOND[which] * np.abs(late).max(axis=0)
        return (value, np.broadcast_to(change + spread, value.shape)), points.shape
