"""A solved contact as functions of position in SI units."""

import time
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from fem_reference import element_numbers as chosen
from fem_reference.elasticity.state import ElasticState
from fem_reference.element_answer import ElementAnswer, ElementUncertainty, PlainFields
from fem_reference.estimate import Estimates
from fem_reference.meshing.location import SolidPoints, solid_points
from fem_reference.scaling import Scales
from fem_reference.validation import check_friction


@dataclass(frozen=True, kw_only=True)
class ElementDiagnostics:
    """How the solution was reached.

    iterations : contact solves on all levels
    dofs, triangles, order : size of the final level
    residual_gap : deepest penetration outside the contact over the approach; 0 when none
    residual_pressure : largest tension inside over the peak; 0 when none
    residual_equilibrium : largest nodal out-of-balance force over the load; none under a prescribed pressure
    seconds : wall time
    history : (level, contact radius [m], load [N]) of every contact solve
    """

    iterations: int = 1
    dofs: int
    triangles: int
    order: int
    residual_gap: float = 0.0
    residual_pressure: float = 0.0
    residual_equilibrium: float = 0.0
    seconds: float
    history: tuple[tuple[str, float, float], ...]


@dataclass(frozen=True, eq=False)
class ElementSolution(PlainFields):
    """Contact of a sphere (or a prescribed pressure) on a coated half-space.

    Origin at first contact, x along sliding, z into the body in question; tension positive; SI units.
    Stresses and displacements are those of the flat, with ``body="ball"`` those of an elastic ball. A
    solution can be pickled; under a prescribed pressure given as a callable, if that can be.

    surface_nodes : increasing x on y = 0, z = 0 at which pressure is a nodal value
    states, estimates : fields of the flat, then of an elastic ball, and their estimated errors if any, in
        scaled ``units``
    stiffness     : d load / d approach [N/m] of the sphere, as of a flat punch of its contact radius
        (Pharr, Oliver and Brotzen, J. Mater. Res. 7 (1992) 613-617); None under a prescribed pressure
    stiffness_uncertainty : absolute, None when not estimated
    singular_radii : of the surface [m], where a prescribed pressure jumps or is infinite: pressure and stress
        are NaN there. sigma_xx is infinite under friction, and depends on the direction of approach without
    """

    contact_radius: float
    approach: float
    peak_pressure: float
    surface_nodes: np.ndarray = field(repr=False)
    diagnostics: ElementDiagnostics
    states: tuple[ElasticState, ...] = field(repr=False)
    estimates: tuple[Estimates, ...] = field(repr=False)
    units: Scales = field(repr=False)
    stiffness: float | None = None
    stiffness_uncertainty: float | None = None
    singular_radii: tuple[float, ...] = ()
    frames: ClassVar = ("fixed",)  # in which uncertainties are estimated

    def with_friction(self, friction: float) -> "ElementSolution":
        """Contact with this pressure, sliding with another coefficient ``friction``, or at rest with 0.

        The pressure does not depend on friction (Goodman), so only harmonic 1 is solved, on the final mesh
        and the companion. Every value equals that of a solution of the problem with this friction.
        Raises ValueError when ``friction`` is not a finite number.
        """
        started = time.perf_counter()
        check_friction(friction)
        opposed = (friction, -friction)  # on the flat, on the ball
        states = tuple(map(ElasticState.with_friction, self.states, opposed))
        estimates = tuple(map(Estimates.with_friction, self.estimates, states, opposed))
        seconds = self.diagnostics.seconds + time.perf_counter() - started
        diagnostics = replace(self.diagnostics, seconds=seconds)
        return replace(self, states=states, estimates=estimates, diagnostics=diagnostics)

    @property
    def uncertainty(self) -> ElementUncertainty | None:
        """Uncertainty of the three scalars, None when not estimated."""
        return self.estimates[0].scalars if self.estimates else None

    @property
    def state(self) -> ElasticState:
        """Fields of the flat in scaled units."""
        return self.states[0]

    @property
    def coarser(self) -> "ElementSolution | None":
        """The companion by which the errors were estimated, without estimates; None where there is none."""
        if not self.estimates:
            return None
        states = tuple(estimate.coarser[0] for estimate in self.estimates)
        approach = sum(state.central_displacement for state in states)
        return replace(
            self,
            contact_radius=states[0].mesh.contact_radius * self.units.length,
            approach=approach * self.units.displacement,
            peak_pressure=states[0].peak[1] * self.units.pressure,
            states=states,
            estimates=(),
            stiffness=None,
            stiffness_uncertainty=None,
        )

    def sample(self, points: Any, quantity: str, uncertainty: bool = True) -> ElementAnswer:
        """Value of a quantity at points, with its uncertainty when it was estimated.

        points : any record with the attributes of ``ElementPoints``; None of a scalar
        quantity : pressure, stress or displacement, or a scalar: contact_radius, approach, peak_pressure,
            stiffness
        uncertainty : False leaves it out
        Raises ValueError for a point outside the solid or outside its ``layer``, and for a rigid ball.
        """
        stated = uncertainty and bool(self.estimates)
        if quantity == "pressure":
            return self._regular(self._pressure(points, stated), points.x, points.y, 0.0)
        if quantity in ("stress", "displacement"):
            number = self._number(points.body)
            locator = self.states[number].discretisation.locator
            at = solid_points(locator, self.units.length, points.x, points.y, points.z, points.layer)
            found = self._field(at, number, quantity, stated)
            if quantity == "displacement":
                return found
            return self._regular(found, points.x, points.y, points.z)
        if quantity == "stiffness":
            return ElementAnswer(self.stiffness, self.stiffness_uncertainty if stated else None)
        if quantity in ("contact_radius", "approach", "peak_pressure"):
            return ElementAnswer(
                getattr(self, quantity), getattr(self.uncertainty, quantity) if stated else None
            )
        return ElementAnswer(None)

    def _pressure(self, points: Any, stated: bool) -> ElementAnswer:
        r = np.hypot(np.asarray(points.x, dtype=float), np.asarray(points.y, dtype=float)) / self.units.length
        p = self.state.pressure(r) * self.units.pressure
        return ElementAnswer(p, self.estimates[0].pressure(r) * self.units.pressure if stated else None)

    def _field(self, points: SolidPoints, number: int, quantity: str, stated: bool) -> ElementAnswer:
        """Stress or displacement of a body, with its uncertainty where ``stated``."""
        stress, cos, sin = quantity == "stress", np.abs(points.cos), np.abs(points.sin)
        turn, shape = (tensor, (3, 3)) if stress else (cartesian, (3,))
        unit = self.units.pressure if stress else self.units.displacement
        amplitudes = self.states[number](points)[stress]
        value = turn(amplitudes, points.cos, points.sin).reshape(*shape, *points.shape) * unit
        if not stated:
            return ElementAnswer(value)
        found, at = self.estimates[number], points.located
        error, *sliding = (
            one(at) if stress else one.displacement(at) for one in (found.normal, found.tangential) if one
        )
        for more in sliding:
            error = error + more * np.stack([cos] * 4 + [sin] * 2 if stress else [cos, sin, cos])
        # absolute values of all products in the rotation add up
        return ElementAnswer(value, turn(error, cos, sin, sign=1.0).reshape(value.shape) * unit)

    def _regular(self, answer: ElementAnswer, x: Any, y: Any, z: Any) -> ElementAnswer:
        """``answer``, or NaN at points closer to ``singular_radii`` than can be told apart from them."""
        if not self.singular_radii:
            return answer
        r, z = np.broadcast_arrays(np.hypot(x, y), np.asarray(z, dtype=float))
        away = np.min([np.hypot(r - one, z) for one in self.singular_radii], axis=0)
        at = away <= chosen.AT_SINGULAR * self.contact_radius
        return ElementAnswer(*(None if part is None else np.where(at, np.nan, part) for part in answer))

    def _number(self, body: str) -> int:
        known = ("flat", "ball")[: len(self.states)]
        if body not in known:
            raise ValueError(f"body = {body!r}; this contact has {' and '.join(known)}")
        return known.index(body)


def cartesian(u: np.ndarray, cos: np.ndarray, sin: np.ndarray, sign: float = -1.0) -> np.ndarray:
    """Turn (u_r, u_theta, u_z) to x, y, z; ``sign`` = 1 adds where a rotation subtracts."""
    return np.stack([u[0] * cos + sign * u[1] * sin, u[0] * sin + u[1] * cos, u[2]])


def tensor(s: np.ndarray, cos: np.ndarray, sin: np.ndarray, sign: float = -1.0) -> np.ndarray:
    """Rotate (rr, tt, zz, rz, rt, tz) to x, y, z; ``sign`` = 1 adds where a rotation subtracts."""
    rr, tt, zz, rz, rt, tz = s
    cross = cos * sin
    xx = cos**2 * rr + sin**2 * tt + sign * 2 * cross * rt
    yy = sin**2 * rr + cos**2 * tt + 2 * cross * rt
    xy = cross * (rr + sign * tt) + (cos**2 + sign * sin**2) * rt
    xz = cos * rz + sign * sin * tz
    yz = sin * rz + cos * tz
    return np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz]).reshape(3, 3, -1)
