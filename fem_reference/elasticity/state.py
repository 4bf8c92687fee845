"""Elastic state of the layered solid on one mesh."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize_scalar

from fem_reference.contact.fixed_radius import Ball, FixedRadiusContact
from fem_reference.elasticity.axisymmetric import Discretisation
from fem_reference.elasticity.loading import solve_traction
from fem_reference.elasticity.recovery import HarmonicField
from fem_reference.meshing.location import SolidPoints
from fem_reference.meshing.mesh import MeridianMesh
from fem_reference.scaling import LayeredSolid


@dataclass(frozen=True, eq=False)
class ElasticState:
    """Fields of a ``solid`` under normal pressure and, with friction, a tangential traction; scaled units."""

    solid: LayeredSolid
    normal: HarmonicField
    tangential: HarmonicField | None

    @classmethod
    def of_contact(
        cls, solid: LayeredSolid, contact: FixedRadiusContact, body: Ball | None = None
    ) -> "ElasticState":
        """The state of the flat in the frictionless ``contact``, or of the elastic ``body`` pressed on it."""
        side, pressure = body or contact, contact.pressure
        field = HarmonicField(side.discretisation, side.fields, solid.materials, 0, pressure, -1.0, True)
        return cls(solid, field, None)

    def with_friction(self, friction: float) -> "ElasticState":
        """The state with the tangential traction ``friction`` times the pressure; the pressure stays."""
        if friction == 0:
            return replace(self, tangential=None)
        d, pressure = self.discretisation, self.pressure
        fields = solve_traction(d, self.solid, 1, lambda r: friction * pressure(r))
        root_at_edge = self.normal.root_at_edge
        sliding = HarmonicField(d, fields, self.solid.materials, 1, pressure, -friction, root_at_edge)
        return replace(self, tangential=sliding)

    def __call__(self, points: SolidPoints) -> tuple[np.ndarray, np.ndarray]:
        """Displacement (3, n) and stress (6, n), cylindrical as in ``HarmonicField``."""
        u, sigma = self.normal(points.located)
        if self.tangential is not None:
            cos, sin = points.cos, points.sin
            u_sliding, sliding = self.tangential(points.located)
            u = u + u_sliding * np.stack([cos, sin, cos])
            sigma = sigma + sliding * np.stack([cos] * 4 + [sin] * 2)
        return u, sigma

    @property
    def discretisation(self) -> Discretisation:
        return self.normal.discretisation

    @property
    def mesh(self) -> MeridianMesh:
        return self.discretisation.mesh

    @property
    def pressure(self) -> Callable[[np.ndarray], np.ndarray]:
        return self.normal.pressure

    def truncation(self, harmonic: int) -> tuple[float, float, float]:
        """Changes of displacement, stress, curvature due to the far field prescribed on the outer boundary.

        What the far field leaves out, the share of the coatings, falls with at least the square of the
        distance and is set to zero on the boundary: at half the distance three times as much is found as was
        left out there. Inside it is smooth: its strain is that over the distance, the curvature of u_z twice
        that over the distance squared.
        """
        d, field = self.discretisation, self.tangential if harmonic else self.normal
        assert field is not None
        distance = d.locations.max(axis=0) / self.mesh.far
        halfway = np.flatnonzero((distance > 0.35) & (distance < 0.55))
        load = -field.factor * 2 * np.pi * d.contact_load(self.pressure).sum()
        far = self.solid.far_fields(harmonic, load, d.locations[:, halfway])
        missing = float(np.abs(field.fields.reshape(-1, d.N)[:, halfway] - far).max()) / 3
        stiffest = max(E / (1 - 2 * nu) for E, nu in self.solid.materials)
        return missing, stiffest * missing / self.mesh.far, 2 * missing / self.mesh.far**2

    @property
    def peak(self) -> tuple[float, float]:
        """Radius and value of the largest pressure, on the axis or, where a stiff film bends, on a ring."""
        vertices = self.discretisation.contact_vertices
        r = np.unique(np.linspace(vertices[:-1], vertices[1:], 9))
        best = int(np.argmax(self.pressure(r)))
        if best == 0:
            return 0.0, float(self.pressure(r[:1])[0])
        found = minimize_scalar(
            lambda radius: -float(self.pressure(np.array([radius]))[0]),
            bounds=(r[best - 1], r[min(best + 1, r.size - 1)]),
            method="bounded",
            options={"xatol": 1e-6 * r[-1]},
        )
        return float(found.x), -float(found.fun)

    @property
    def central_displacement(self) -> float:
        """u_z at the origin."""
        d = self.discretisation
        return float(self.normal.fields[d.N + d.surface[0]])
