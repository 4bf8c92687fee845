"""Elastic state of the layered solid on one mesh."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from .axisymmetric import Discretisation
from .contact import FixedRadiusContact
from .loading import solve_traction
from .mesh import MeridianMesh
from .recovery import HarmonicField
from .scaling import LayeredSolid

__all__ = ["ElasticState"]


@dataclass(frozen=True, eq=False)
class ElasticState:
    """Fields of a ``solid`` under normal pressure and, with friction, a tangential traction; scaled units."""

    solid: LayeredSolid
    normal: HarmonicField
    tangential: HarmonicField | None

    @classmethod
    def of_contact(cls, solid: LayeredSolid, contact: FixedRadiusContact) -> "ElasticState":
        """The state of the frictionless ``contact``."""
        d, pressure = contact.discretisation, contact.pressure
        return cls(solid, HarmonicField(d, contact.fields, solid.materials, 0, pressure, -1.0), None)

    @classmethod
    def under_pressure(
        cls, solid: LayeredSolid, d: Discretisation, pressure: Callable[[np.ndarray], np.ndarray]
    ) -> "ElasticState":
        """The state under a prescribed ``pressure`` (r) within the contact radius of the mesh of ``d``."""
        fields = solve_traction(d, solid, 0, pressure)
        return cls(solid, HarmonicField(d, fields, solid.materials, 0, pressure, -1.0), None)

    def with_friction(self, friction: float) -> "ElasticState":
        """The state with the tangential traction ``friction`` times the pressure; the pressure stays."""
        if friction == 0:
            return replace(self, tangential=None)
        d, pressure = self.discretisation, self.pressure
        fields = solve_traction(d, self.solid, 1, lambda r: friction * pressure(r))
        sliding = HarmonicField(d, fields, self.solid.materials, 1, pressure, -friction)
        return replace(self, tangential=sliding)

    @property
    def discretisation(self) -> Discretisation:
        return self.normal.discretisation

    @property
    def mesh(self) -> MeridianMesh:
        return self.discretisation.mesh

    @property
    def pressure(self) -> Callable[[np.ndarray], np.ndarray]:
        return self.normal.pressure

    @property
    def central_displacement(self) -> float:
        """u_z at the origin."""
        d = self.discretisation
        origin = np.flatnonzero((d.locations[0] == 0) & (d.locations[1] == 0))
        return float(self.normal.fields[d.N + origin[0]])
