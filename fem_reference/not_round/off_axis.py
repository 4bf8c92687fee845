"""A coated half-space under any pressure that is even in y, as a sum of angular harmonics.

On a body of revolution a load of harmonic m gives displacements of that harmonic (``axisymmetric``). So the
fields under p(r, theta) = sum_m p_m(r) cos(m theta), which may slide along x, are a sum over meridian
problems (``harmonic_compliance``). What the tractions themselves add to the stress on the surface is not
split into harmonics.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from fem_reference import element_numbers as chosen
from fem_reference.elasticity.axisymmetric import Discretisation
from fem_reference.elasticity.recovery import HarmonicField, stress_of
from fem_reference.element_answer import ElementAnswer, PlainFields
from fem_reference.meshing.location import LocatedPoints, SolidPoints, solid_points
from fem_reference.meshing.mesh import Grading, meridian_mesh, surface_size
from fem_reference.not_round.harmonic_compliance import HarmonicCompliance
from fem_reference.not_round.star_contact import StarPressure
from fem_reference.scaling import LayeredSolid, Scales
from fem_reference.solved_contact import cartesian, tensor


def discretised(
    solid: LayeredSolid,
    size: float,
    surface: float,
    order: int,
    growth: float = 1.5,
    edges: tuple[float, ...] = (),
    stacks: tuple[tuple[float, ...], ...] = (),
) -> Discretisation:
    """Elements of a mesh whose surface is divided evenly below the radius 1, but around ``edges``.

    growth : of the size towards the outer boundary.   stacks : see ``meridian_mesh``
    """
    grading = Grading(
        size,
        1.9 * size,
        size,
        chosen.SHAPED_AXIS * size,
        far_size=min(growth * size, chosen.LARGEST_FAR),
        film_size=2 * size,
        rows=0.8 / size,
        surface=surface,
        edges=edges,
    )
    mesh = meridian_mesh(
        contact_radius=1.0, thicknesses=solid.thicknesses, far=solid.far, grading=grading, stacks=stacks
    )
    return Discretisation(mesh, order)


@dataclass(frozen=True, eq=False)
class OffAxisFields:
    """The fields of all harmonics to the ``last`` on one mesh, in scaled units.

    load : int p dA.   surface : size of the triangles there
    """

    discretisation: Discretisation
    solid: LayeredSolid
    last: int
    fields: tuple[HarmonicField, ...]
    load: float
    friction: float
    pressure: StarPressure
    surface: float

    @classmethod
    def of(
        cls,
        compliance: HarmonicCompliance,
        loads: np.ndarray,
        friction: float,
        pressure: StarPressure,
        surface: float,
    ) -> "OffAxisFields":
        """Fields under a pressure of the nodal ``loads`` (harmonics, nodes)."""
        d, materials = compliance.discretisation, compliance.solid.materials
        found = compliance.displacements(loads, friction)
        fields = tuple(HarmonicField(d, u, materials, m, np.zeros_like, 0.0, False) for m, u in found.items())
        load = float(loads[0].sum())
        return cls(d, compliance.solid, compliance.last, fields, load, friction, pressure, surface)

    @property
    def turned(self) -> "OffAxisFields":
        """Fields with the friction the other way, by half a turn about z, of a pressure even in x."""
        of = (replace(one, fields=(-1) ** one.harmonic * one.fields) for one in self.fields)
        return replace(self, fields=tuple(of), friction=-self.friction)

    @property
    def least(self) -> float:
        """Size of the triangles at the edges."""
        return float(surface_size(self.surface, 0.0))

    def __call__(self, points: SolidPoints) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Displacement (3, n) and stress (6, n), cylindrical, and what the last third of harmonics adds.

        Next to one of the ``edges`` both follow a series, and what one more power changes counts too.
        """
        at = points.located
        u, s, late_u, late_s = self._summed(points)
        surface = at.z == 0
        x, along = at.r_given * points.cos, surface & (np.abs(points.sin) < 1e-9)
        for k, edge in enumerate(self.pressure.edges):
            near = np.flatnonzero(along & (np.abs(x - edge) < chosen.WITHIN * self.least))
            if near.size:
                away = np.sign(edge) * (x[near] - edge) / self.least
                more, fewer = (
                    (_powers(away, n) @ c).T for n, c in zip(chosen.HALVES, self._series[k], strict=True)
                )
                s[:2, near] = more[:2] + self._root(x[near], edge)
                late_s[:2, near] = np.abs(more - fewer)[:2] + np.abs(more[2:])
        p = np.where(surface, self.pressure(at.r_given * points.cos, at.r_given * points.sin), 0.0)
        nu, f = self.solid.materials[0][1], self.friction
        s[:2] -= nu / (1 - nu) * p
        s[2] -= p
        s[3] -= f * p * points.cos
        s[5] += f * p * points.sin
        return u, s, late_u, late_s

    def _summed(self, points: SolidPoints) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Fields by the elements alone, without what the tractions themselves add on the surface."""
        at, theta = points.located, np.arctan2(points.sin, points.cos)
        u, strain = self._strains(at, theta)
        sides = {
            id(side): self._strains(side, theta[numbers])[1]
            for _, numbers, both in at.interfaces
            for side in both
        }
        none, materials = np.zeros((3, theta.size)), self.solid.materials
        s = stress_of(strain[0], none, at, materials, lambda side: sides[id(side)][0])
        late_s = stress_of(strain[1], none, at, materials, lambda side: sides[id(side)][1])
        return u[0], s, u[1], late_s

    def _strains(self, at: LocatedPoints, theta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Displacement (2, 3, n) and strain (2, 6, n): of all harmonics, tapered in the strain, and of the
        last third."""
        u, strain = map(np.array, zip(*(field.amplitudes(at) for field in self.fields), strict=True))
        m = np.array([field.harmonic for field in self.fields])
        waves = np.stack([np.cos(np.outer(m, theta)), np.sin(np.outer(m, theta))], axis=1)
        late = m > 2 / 3 * self.last
        u = np.tensordot([np.ones(m.size), late], u * waves[:, [0, 1, 0]], 1)
        tapered = _taper(m / self.last), late
        return u, np.tensordot(tapered, strain * waves[:, [0, 0, 0, 0, 1, 1]], 1)

    @cached_property
    def _series(self) -> list[list[np.ndarray]]:
        """Coefficients (powers, 4) beside each edge, with as many as ``HALVES``: of rr and tt less ``_root``,
        and of what the last third of harmonics adds.

        Fitted where triangles are no larger than their distance from the edge. A root fitted errs by 1e-3.
        """
        found = []
        away = self.least * np.outer([-1, 1], np.geomspace(*chosen.BESIDE_EDGE, 24)).ravel()
        for edge in self.pressure.edges:
            x, zero = edge + np.sign(edge) * away, np.zeros(away.size)
            located = self.discretisation.locator.points(np.abs(x), zero, zero.astype(int))
            _, s, _, late_s = self._summed(SolidPoints(located, np.sign(x), zero, x.shape))
            rest = np.concatenate([s[:2] - self._root(x, edge), late_s[:2]]).T
            terms = (_powers(away / self.least, n) for n in chosen.HALVES)
            found.append([np.linalg.lstsq(one, rest, rcond=None)[0] for one in terms])
        return found

    def _root(self, x: np.ndarray, edge: float) -> np.ndarray:
        """Root of rr and tt beside an edge, (2, n), in plane strain: of p inside, of f p outside."""
        nu = self.solid.materials[0][1]
        p, mirrored = (self.pressure(at, 0 * x) for at in (x, 2 * edge - x))
        rr = 2 * self.friction * np.sign(x - edge) * mirrored - (1 - 2 * nu) / (1 - nu) * p
        return np.array([rr, nu * rr])


def _taper(share: np.ndarray) -> np.ndarray:
    """Weights of harmonics over the last one: the sum of a root's then oscillates less next to its end."""
    return np.asarray(np.cos(np.pi / 2 * np.clip((share - chosen.FULL) / (1 - chosen.FULL), 0, 1)) ** 2)


def _powers(away: np.ndarray, halves: int) -> np.ndarray:
    """1, d, d^2, and d^(k + 1/2) for k = 1, .. on either side of the edge, (n, powers); d < 0 is inside.

    The layers, and all of the pressure but what is at the edge, give a stress that is smooth across it.
    """
    sides = np.maximum([-away, away], 0)
    roots = [side ** (k + 1.5) for k in range(halves) for side in sides]
    return np.stack([np.ones(away.size), away, away**2, *roots], axis=1)


@dataclass(frozen=True, eq=False)
class PressedSolid(PlainFields):
    """A coated half-space under a pressure; x along sliding, z into it, tension positive, SI."""

    _fine: OffAxisFields
    _coarse: OffAxisFields | None
    _units: Scales

    @property
    def load(self) -> float:
        """Resultant of the pressure [N]."""
        return self._fine.load * self._units.load

    def sample(self, points: Any, quantity: str, uncertainty: bool = True) -> ElementAnswer:
        """Value of a quantity at points, with its uncertainty when it was estimated.

        points : any record with the attributes of ``ElementPoints``, of the flat
        quantity : pressure, taken as exact; stress or displacement, uncertain by the change from a coarser
            mesh and by the last harmonics'
        uncertainty : False leaves it out
        """
        if quantity == "pressure":
            p = self._given(points)
            return ElementAnswer(p, np.zeros(p.shape) if uncertainty else None)
        if quantity not in ("stress", "displacement"):
            return ElementAnswer(None)
        if points.body != "flat":
            raise ValueError(f"body = {points.body!r}; this contact has flat")
        return self._sums(points, quantity, uncertainty and self._coarse is not None)

    def _given(self, points: Any) -> np.ndarray:
        x, y = np.broadcast_arrays(np.asarray(points.x, dtype=float), np.asarray(points.y, dtype=float))
        unit = self._units
        return np.asarray(self._fine.pressure(x / unit.length, y / unit.length)) * unit.pressure

    def _matching(self, points: Any, other: StarPressure) -> tuple[Any, Any]:
        """Points [m] of the ``other`` pressure that are compared with x, y."""
        return points.x, points.y

    def _sums(self, points: Any, quantity: str, stated: bool) -> ElementAnswer:
        """Stress or displacement, Cartesian, with the largest uncertainty of its components for each."""
        if quantity == "displacement":
            which, turn, unit = 0, cartesian, self._units.displacement
        else:
            which, turn, unit = 1, tensor, self._units.pressure  # type: ignore[assignment]
        ahead = (3,) * (1 + which)
        values = []
        for fields in (self._fine, self._coarse) if stated else (self._fine,):
            assert fields is not None
            at = (points.x, points.y) if fields is self._fine else self._matching(points, fields.pressure)
            locator = fields.discretisation.locator
            places = solid_points(locator, self._units.length, *at, points.z, points.layer)
            found, shape = fields(places), (*ahead, *places.shape)
            values.append([turn(found[k], places.cos, places.sin).reshape(shape) for k in (which, 2 + which)])
        value, late = values[0]
        if not stated:
            return ElementAnswer(value * unit)
        axes = tuple(range(len(ahead)))
        change = np.abs(value - values[1][0]).max(axis=axes)
        spread = change + chosen.BEYOND[which] * np.abs(late).max(axis=axes)
        return ElementAnswer(value * unit, np.broadcast_to(spread, value.shape) * unit)
