"""The physical problem: a sphere, rigid or elastic, in contact with a coated elastic half-space.

Origin at first contact, ``x`` along sliding, ``z`` into the body in question, surface at z = 0. Tension
positive, pressure and load positive in compression. SI units.
"""

from dataclasses import dataclass, fields, replace
from math import isclose, isfinite, pi
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from verification.problem.array_types import Array, Ball, Coatings
from verification.problem.indenter_shape import Indenter, require_shape
from verification.problem.point_answers import BALL, FLAT, Points

AT_RIM = 1e-8  # distance from the rim of a prescribed load over its radius, within which a point is on it


@dataclass(frozen=True)
class CoatedContact:
    """Sphere of ``radius`` [m] under ``load`` [N] on ``coatings`` bonded to ``substrate``.

    coatings : ((E [Pa], nu, thickness [m]), ...) from the surface down; () is the uncoated solid.
    substrate : (E [Pa], nu).   friction : f in q = f p, traction on the flat in +x and on the ball in -x.
    ball : None is rigid; (E, nu, coatings) of an elastic ball, its coatings from its surface inwards.
    indenter : None is the sphere; another shape with its numbers, see ``indenter_shape``, of which a ball is
    the solid.

    Near the contact both bodies are layered half-spaces, with the gap r^2/2R before they deform. The scales
    a_h, p_h, delta_h are those of both bodies without coatings.
    Raises ValueError with a message naming the quantity and its value.
    """

    radius: float
    load: float
    coatings: Coatings
    substrate: tuple[float, float]
    friction: float = 0.0
    ball: Ball | None = None
    indenter: Indenter | None = None

    def __post_init__(self) -> None:
        if self.indenter is not None:
            require_shape(self.indenter)
            shape, numbers = self.indenter
            if shape == "ellipsoid" and not isclose(self.radius**2, numbers[0] * numbers[1], rel_tol=1e-9):
                mean = (numbers[0] * numbers[1]) ** 0.5
                raise ValueError(
                    f"radius = {self.radius:g} m; of these radii it is sqrt(R_x R_y), {mean:g} m"
                )
        _require_positive("radius", self.radius)
        _require_positive("load", self.load)
        _require_solid(self.coatings, self.substrate, self.friction)
        if self.ball is not None:
            _require_solid(self.ball[2], self.ball[:2], 0.0, "ball.")

    @property
    def E_star(self) -> float:
        """Contact modulus of both substrates [Pa], 1/E* = sum (1 - nu^2)/E. Johnson (4.20)."""
        E, nu = self.substrate
        if self.ball is None:
            return E / (1 - nu**2)
        return 1 / ((1 - nu**2) / E + (1 - self.ball[1] ** 2) / self.ball[0])

    @property
    def a_h(self) -> float:
        """Hertz contact radius of the bare substrates, (3 W R / 4 E*)^(1/3) [m]. Johnson (4.22)."""
        return (3 * self.load * self.radius / (4 * self.E_star)) ** (1 / 3)

    @property
    def p_h(self) -> float:
        """Hertz peak pressure of the bare substrates, 3 W / (2 pi a_h^2) [Pa]. Johnson (4.24)."""
        return 3 * self.load / (2 * pi * self.a_h**2)

    @property
    def delta_h(self) -> float:
        """Hertz approach of the bare substrates, a_h^2 / R [m]. Johnson (4.23)."""
        return self.a_h**2 / self.radius

    @property
    def S_h(self) -> float:
        """Hertz stiffness dW/d delta of the bare substrate, 2 E* a_h [N/m]. Johnson (4.23) differentiated."""
        return 2 * self.E_star * self.a_h

    @property
    def bodies(self) -> tuple[str, ...]:
        """The elastic bodies by name."""
        return (FLAT,) if self.ball is None else (FLAT, BALL)

    def seen_from(self, body: str) -> "CoatedContact":
        """This contact with ``body`` as the flat: of the ball the two bodies are exchanged.

        Raises ValueError where the ball is rigid.
        """
        if body == FLAT:
            return self
        if body != BALL or self.ball is None:
            raise ValueError(f"body = {body!r}; this contact has {' and '.join(self.bodies)}")
        E, nu, coatings = self.ball
        return replace(self, coatings=coatings, substrate=(E, nu), ball=(*self.substrate, self.coatings))

    @property
    def dundurs_beta(self) -> float:
        """Dundurs' beta of the two materials in contact, which couples pressure and friction. Johnson (5.3).

        beta = [(1 - 2 nu_f)/G_f - (1 - 2 nu_b)/G_b] / 2 / [(1 - nu_f)/G_f + (1 - nu_b)/G_b]
        """
        surfaces = [(*self.coatings, self.substrate)[0][:2]]
        if self.ball is not None:
            surfaces.append((*self.ball[2], self.ball[:2])[0][:2])
        # 1/G with its sign: the ball opposes the flat
        one, two = [(2 * (1 + nu) / E, nu) for E, nu in surfaces] + [(0.0, 0.0)] * (2 - len(surfaces))
        coupled = one[0] * (1 - 2 * one[1]) - two[0] * (1 - 2 * two[1])
        return coupled / 2 / (one[0] * (1 - one[1]) + two[0] * (1 - two[1]))

    @property
    def elliptical(self) -> bool:
        """Whether the indenter is an ellipsoid, whose contact has half axes along x and y."""
        return self.indenter is not None and self.indenter[0] == "ellipsoid"

    @property
    def interfaces(self) -> tuple[float, ...]:
        """Depth of each interface [m], from the surface down."""
        return tuple(float(z) for z in np.cumsum([thickness for _, _, thickness in self.coatings]))

    @property
    def homogeneous(self) -> bool:
        """True where every layer of either body has the moduli of its substrate, so that Hertz holds."""
        ball = () if self.ball is None else self.ball[2]
        same = [(E, nu) == self.substrate for E, nu, _ in self.coatings]
        return all([*same, *((E, nu) == self.ball[:2] for E, nu, _ in ball if self.ball)])

    def under_disc(self, pressure: float, load_radius: float) -> "PrescribedLoad":
        """This solid, friction included, under ``pressure`` [Pa] on a disc of ``load_radius`` [m]."""
        shared = {f.name for f in fields(PrescribedLoad)} & {f.name for f in fields(self)}
        return PrescribedLoad(pressure, load_radius, **{name: getattr(self, name) for name in shared})


@dataclass(frozen=True)
class PrescribedLoad:
    """Uniform ``pressure`` [Pa] on a disc of ``load_radius`` [m], on ``coatings`` bonded to ``substrate``.

    coatings, substrate, friction as in CoatedContact.
    Raises ValueError with a message naming the quantity and its value.
    """

    pressure: float
    load_radius: float
    coatings: Coatings
    substrate: tuple[float, float]
    friction: float = 0.0

    def __post_init__(self) -> None:
        _require_positive("pressure", self.pressure)
        _require_positive("load_radius", self.load_radius)
        _require_solid(self.coatings, self.substrate, self.friction)

    def is_singular(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> NDArray[np.bool_]:
        """Whether pressure and stress have no value at points [m]: on the rim, where the pressure jumps."""
        return np.hypot(np.hypot(x, y) - self.load_radius, z) <= AT_RIM * self.load_radius


def keywords(problem: Any) -> dict[str, Any]:
    """The fields of a problem by name, as keywords of a solver; a field that has its default is left out.

    So a solver that does not know a field solves all problems that do not use it.
    """
    return {f.name: value for f in fields(problem) if (value := getattr(problem, f.name)) != f.default}


@dataclass(frozen=True)
class ScalarUncertainty:
    """Uncertainty of the scalars of a reference, absolute, SI: of a closed form 0, otherwise by quadrature.

    budget : (scalar, contribution, value) of each that is not exact.
    """

    contact_radius: float = 0.0
    approach: float = 0.0
    peak_pressure: float = 0.0
    stiffness: float = 0.0
    budget: tuple[tuple[str, str, float], ...] = ()


class ContactSolution(Protocol):
    """Solution of a contact by a method or a reference: a source that answers ``sample``.

    sample : one field at points, or one scalar, see ``point_answers``; of a contact with an elastic ball its
    fields are those of either body.   frames : of points, in which its uncertainties are its own.
    coarser : the solution that its uncertainty is estimated by, None where there is none.
    uncertainty : of the scalars with its budget, None where none is stated.
    """

    @property
    def contact_radius(self) -> float: ...
    @property
    def approach(self) -> float: ...
    @property
    def peak_pressure(self) -> float: ...
    @property
    def uncertainty(self) -> Any: ...
    @property
    def diagnostics(self) -> Any: ...
    @property
    def surface_nodes(self) -> Array: ...
    @property
    def frames(self) -> tuple[str, ...]: ...
    @property
    def coarser(self) -> Any: ...
    def sample(self, points: Points | None, quantity: str, uncertainty: bool = True) -> Any: ...
    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array: ...
    def stress(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None) -> Array: ...
    def displacement(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array: ...


def _require_solid(coatings: Coatings, substrate: tuple[float, float], friction: float, of: str = "") -> None:
    for i, (E, nu, thickness) in enumerate(coatings):
        _require_positive(f"{of}coatings[{i}].E", E)
        _require_poisson(f"{of}coatings[{i}].nu", nu)
        _require_positive(f"{of}coatings[{i}].thickness", thickness)
    of = of or "substrate."
    _require_positive(f"{of}E", substrate[0])
    _require_poisson(f"{of}nu", substrate[1])
    if not (isfinite(friction) and friction >= 0):
        raise ValueError(f"friction = {friction:g}; Coulomb's coefficient is zero or positive")


def _require_positive(name: str, value: float) -> None:
    if not (isfinite(value) and value > 0):
        raise ValueError(f"{name} = {value:g}; it must be a positive finite number")


def _require_poisson(name: str, nu: float) -> None:
    # nu = 1/2 is physical; a method that does not support it raises its own error.
    if not -1 < nu <= 0.5:
        raise ValueError(f"{name} = {nu:g}; an isotropic solid has -1 < nu <= 0.5")
