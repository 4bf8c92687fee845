"""Public entry of the finite element method: a physical problem in, a ``Solution`` out.

Inside, every problem has one length, one pressure and the modulus of the substrate as units (``_Units``).
For the sphere they are a_h = (3 W R / 4 E*)^(1/3) of the bare substrate and E a_h/R, as ``contact`` asks.

Levels: a rough and a coarse mesh find the contact radius, a companion somewhat coarser than the final mesh
finds it closely and is the yardstick of the error, the final one gives the result. A vertex stands at the
contact radius of every level, and sliding friction is solved afterwards on the last two.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from .axisymmetric import Discretisation
from .contact import Touch, touch
from .estimate import SAFETY, PressureBound, StressBound
from .far_field import boussinesq, cerruti
from .load_control import carry_load
from .loading import loaded, resultant
from .mesh import Grading, MeridianMesh, meridian_mesh
from .recovery import HarmonicField
from .solution import Diagnostics, Meridian, NotConverged, Solution, Uncertainty
from .validation import check_choice, check_materials, check_positive, check_proportions, prescribed_pressure

__all__ = ["QUALITY", "solve", "solve_prescribed"]

Materials = tuple[tuple[float, float], ...]
Coatings = tuple[tuple[float, float, float], ...]

# triangle size over its distance from the contact edge
QUALITY = {"fast": 0.36, "default": 0.16, "fine": 0.12}
_COARSE = 0.5
_COMPANION = 1.4
_LOAD_TOLERANCE = 2e-7
_NEARER = 2.0
_EDGE_SIZE = 1e-6
# The last triangle misplaces the edge by this share of its size, whatever the solid: close to the edge all
# contacts look alike. # Measured 0.01 between edge sizes of 1e-3 and 1e-6 of the contact radius.
_EDGE_SHARE = 0.03


def solve(
    *,
    radius: float,
    load: float,
    coatings: Coatings,
    substrate: tuple[float, float],
    friction: float = 0.0,
    order: int = 4,
    quality: str = "default",
    far: float = 1000.0,
    max_iterations: int = 30,
    estimate_uncertainty: bool = True,
) -> Solution:
    """Rigid sphere pressed on, and with friction slid over, a coated half-space.

    radius [m], load [N], coatings ((E, nu, thickness), ...) [Pa, -, m] from the surface down, () for none,
    substrate (E, nu), friction f in q = f p, the traction on the solid in +x, taken not to change p
    (Goodman).
    order   : polynomial order of the displacement, 2 to 4
    quality : "fast" (about 1e-3), "default" (about 1e-5) or "fine"
    far     : distance of the outer boundary over (a_h + thickness of all coatings)
    max_iterations : contact solves allowed on each mesh level
    Poisson ratios up to 0.49 do not lock at order 4; above, digits are lost as 1/(1 - 2 nu), and 0.5 is
    refused. Raises ValueError for bad input, NotConverged when no contact radius carries the load.
    """
    started = time.perf_counter()
    check_positive(radius=radius, load=load, far=far, max_iterations=max_iterations)
    check_materials(coatings, substrate, friction)
    check_choice("order", order, (2, 3, 4))
    check_choice("quality", quality, tuple(QUALITY))
    E, nu = substrate
    a_h = (3 * load * radius * (1 - nu**2) / (4 * E)) ** (1 / 3)
    unit = _Units(length=a_h, pressure=E * a_h / radius, modulus=E)
    solid = _solid(coatings, substrate, a_h, far)
    check_proportions(solid.thicknesses, "a_h")
    target = load / unit.load

    history: list[tuple[str, float, float]] = []
    a, slope = _first_radius(solid, target), 3.0

    def level(name: str, grading: Grading, order: int, tolerance: float) -> tuple[Touch, Discretisation]:
        nonlocal a, slope
        carried = carry_load(
            target,
            start=a,
            slope=slope,
            tolerance=tolerance,
            max_iterations=max_iterations,
            mesh_at=partial(_mesh, solid, grading),
            solve_on=lambda mesh: _Placed(touch_on(mesh, order), mesh),
        )
        history.extend((name, x * a_h, W * unit.load) for x, W in carried.history)
        if not carried.converged:
            reached = carried.contact.load / target
            raise NotConverged(
                f"the contact radius did not settle on the {name} mesh: after {len(carried.history)} "
                "solves, at "
                f"{carried.contact_radius:.4g} a_h, the load is {reached:.6g} of the one asked for; "
                f"raise max_iterations, or check the thicknesses and the ratio of the moduli"
            )
        slope = carried.slope
        # the next level starts where this one would carry exactly the load
        a = carried.contact_radius * (target / carried.contact.load) ** (1 / slope)
        return carried.contact.touch, Discretisation(carried.contact.mesh, order)

    def touch_on(mesh: MeridianMesh, order: int) -> Touch:
        return touch(
            Discretisation(mesh, order), materials=solid.materials, far_displacement=solid.far_displacement
        )

    size = QUALITY[quality]
    level("rough", _grading(0.6), 2, 0.02)
    level("coarse", _grading(_COARSE), order, 1e-3)
    if estimate_uncertainty:
        companion, companion_disc = level("companion", _companion(size), order, _LOAD_TOLERANCE)
    final, final_disc = level("final", _grading(size), order, _LOAD_TOLERANCE)
    penetration, tension = _complementarity(final, final_disc)
    if final.contact_radius * unit.length >= radius:
        raise ValueError(
            f"load = {load:g} N presses the contact radius to {final.contact_radius * unit.length:g} m, "
            "beyond the "
            f"radius of the sphere, {radius:g} m; small strains need a far smaller load"
        )
    if max(penetration, tension) > 1e-3:
        raise NotConverged(
            f"the contact is not one disc: penetration outside is {penetration:.2g} of the approach, "
            "tension inside "
            f"{tension:.2g} of the peak pressure; use quality='fine', or check that the layers are "
            "elastic solids"
        )

    result = _state(solid, final_disc, final.fields, final.pressure, friction)
    bounds = _NO_BOUNDS
    if estimate_uncertainty:
        other = _state(solid, companion_disc, companion.fields, companion.pressure, friction)
        near = touch_on(companion_disc.mesh.drawn_in(_NEARER), order)
        # change of the scalars at fixed load: the load is taken back along the contact's own stiffness
        missing = companion.load - near.load
        far_share = (
            abs(missing / target / slope * companion.contact_radius),
            abs(near.approach - companion.approach + missing / companion.stiffness),
            abs(near.pressure.values[0] - companion.pressure.values[0]),
        )
        size_share = (
            abs(final.contact_radius - companion.contact_radius),
            abs(final.approach - companion.approach),
        )
        bounds = _bounds(result, other, unit, size_share, far_share, abs(final.load / target - 1))
    return Solution(
        contact_radius=final.contact_radius * unit.length,
        approach=final.approach * unit.displacement,
        peak_pressure=float(final.pressure.values.max()) * unit.pressure,
        surface_nodes=_surface_nodes(final_disc) * unit.length,
        uncertainty=bounds.scalars,
        diagnostics=Diagnostics(
            iterations=len(history),
            dofs=2 * final_disc.N,
            triangles=int(final_disc.mesh.layer.size),
            order=order,
            residual_gap=penetration,
            residual_pressure=tension,
            residual_load=abs(final.load / target - 1),
            residual_equilibrium=final.residual,
            seconds=time.perf_counter() - started,
            history=tuple(history),
        ),
        meridian=_meridian(result, unit, bounds),
    )


def solve_prescribed(
    *,
    pressure: float | Callable[[np.ndarray], np.ndarray],
    load_radius: float,
    coatings: Coatings,
    substrate: tuple[float, float],
    friction: float = 0.0,
    order: int = 4,
    quality: str = "default",
    far: float = 1000.0,
    estimate_uncertainty: bool = True,
) -> Solution:
    """A coated half-space under a given pressure on the disc r <= ``load_radius``, with q = f p.

    pressure : a number (uniform) or a callable p(r) [Pa] taking an array of radii [m]
    The approach of the solution is u_z at the origin, its contact radius is ``load_radius``. Other arguments
    and errors as for ``solve``.
    """
    started = time.perf_counter()
    check_positive(load_radius=load_radius, far=far)
    check_materials(coatings, substrate, friction)
    check_choice("order", order, (2, 3, 4))
    check_choice("quality", quality, tuple(QUALITY))
    p_si, scale = prescribed_pressure(pressure, load_radius)
    unit = _Units(length=load_radius, pressure=scale, modulus=substrate[0])
    solid = _solid(coatings, substrate, load_radius, far)
    check_proportions(solid.thicknesses, "load_radius")

    def p(r: np.ndarray) -> np.ndarray:
        return p_si(r * load_radius) / scale

    def state(mesh: MeridianMesh) -> _State:
        d = Discretisation(mesh, order)
        fields = loaded(
            d,
            harmonic=0,
            materials=solid.materials,
            traction=p,
            far_displacement=solid.far_displacement,
        )
        return _state(solid, d, fields, p, friction)

    size = QUALITY[quality]
    result = state(_mesh(solid, _grading(size), 1.0))
    d = result.discretisation
    bounds = _NO_BOUNDS
    if estimate_uncertainty:
        mesh = _mesh(solid, _companion(size), 1.0)
        other = state(mesh)
        far_share = (0.0, abs(other.sink - state(mesh.drawn_in(_NEARER)).sink), 0.0)
        bounds = _bounds(result, other, unit, (0.0, abs(result.sink - other.sink)), far_share, 0.0)
    nodes = _surface_nodes(d)
    return Solution(
        contact_radius=load_radius,
        approach=result.sink * unit.displacement,
        peak_pressure=float(np.max(p(np.abs(nodes)))) * unit.pressure,
        surface_nodes=nodes * unit.length,
        uncertainty=bounds.scalars,
        diagnostics=Diagnostics(
            iterations=1,
            dofs=2 * d.N,
            triangles=int(d.mesh.layer.size),
            order=order,
            residual_gap=0.0,
            residual_pressure=0.0,
            residual_load=0.0,
            residual_equilibrium=0.0,
            seconds=time.perf_counter() - started,
            history=(("final", load_radius, resultant(d, p) * unit.load),),
        ),
        meridian=_meridian(result, unit, bounds),
    )


@dataclass(frozen=True)
class _Units:
    """SI values of the units a problem is solved in."""

    length: float
    pressure: float
    modulus: float

    @property
    def displacement(self) -> float:
        return self.length * self.pressure / self.modulus

    @property
    def load(self) -> float:
        return self.pressure * self.length**2


@dataclass(frozen=True)
class _Solid:
    """The layers in units: (E, nu) per layer, thickness per coating, extent of the mesh."""

    materials: Materials
    thicknesses: tuple[float, ...]
    far: float

    def far_displacement(self, r: np.ndarray, z: np.ndarray) -> np.ndarray:
        return boussinesq(r, z, *self.materials[-1])

    def far_sliding(self, r: np.ndarray, z: np.ndarray) -> np.ndarray:
        return cerruti(r, z, *self.materials[-1])


@dataclass(frozen=True, eq=False)
class _Placed:
    """A contact with the mesh it was found on."""

    touch: Touch
    mesh: MeridianMesh

    @property
    def load(self) -> float:
        return self.touch.load


@dataclass(frozen=True, eq=False)
class _State:
    """The fields of one level, in units."""

    normal: HarmonicField
    tangential: HarmonicField | None
    pressure: Callable[[np.ndarray], np.ndarray]

    @property
    def discretisation(self) -> Discretisation:
        return self.normal.discretisation

    @property
    def sink(self) -> float:
        """u_z at the origin."""
        d = self.discretisation
        origin = np.flatnonzero((d.locations[0] == 0) & (d.locations[1] == 0))
        return float(self.normal.fields[d.N + origin[0]])


@dataclass(frozen=True, eq=False)
class _Bounds:
    scalars: Uncertainty | None
    normal: StressBound | None
    tangential: StressBound | None
    pressure: PressureBound | None
    everywhere: float


_NO_BOUNDS = _Bounds(None, None, None, None, 0.0)


def _solid(coatings: Coatings, substrate: tuple[float, float], length: float, far: float) -> _Solid:
    E, nu = substrate
    thicknesses = tuple(h / length for _, _, h in coatings)
    return _Solid(
        materials=(*((E_k / E, nu_k) for E_k, nu_k, _ in coatings), (1.0, nu)),
        thicknesses=thicknesses,
        # a stiff coating spreads the load over a length that grows with its modulus
        far=far
        * (
            1
            + sum(h * max(1.0, E_k / E) ** 0.5 for h, (E_k, _, _) in zip(thicknesses, coatings, strict=True))
        ),
    )


def _grading(size: float, edge_size: float = 1e-6) -> Grading:
    """All sizes of a mesh from one: the fan at the edge and the far field forgive coarser triangles."""
    return Grading(
        size=size,
        edge_rate=min(1.4 * size, 0.6),
        edge_size=edge_size,
        axis_size=0.65 * size,
        far_size=2 * size,
    )


def _companion(size: float) -> Grading:
    """The mesh that stands for the error: coarser everywhere, and blunter at the edge."""
    return _grading(_COMPANION * size, edge_size=4 * _EDGE_SIZE)


def _mesh(solid: _Solid, grading: Grading, a: float) -> MeridianMesh:
    return meridian_mesh(contact_radius=a, thicknesses=solid.thicknesses, far=solid.far, grading=grading)


def _first_radius(solid: _Solid, load: float) -> float:
    """Contact radius if the layers above z gave the share (2/pi) atan(z/a) of the compliance."""
    depths = np.cumsum([0.0, *solid.thicknesses])
    a = 1.0
    for _ in range(30):
        share = np.diff(2 / np.pi * np.arctan(depths / a), append=1.0)
        compliance = sum(s * (1 - nu**2) / E for s, (E, nu) in zip(share, solid.materials, strict=True))
        a = (0.75 * load * compliance) ** (1 / 3)
    return float(a)


def _state(
    solid: _Solid,
    d: Discretisation,
    fields: np.ndarray,
    pressure: Callable[[np.ndarray], np.ndarray],
    friction: float,
) -> _State:
    """Wrap the normal fields, and solve for sliding where there is friction."""

    def sigma_zz(r: np.ndarray) -> np.ndarray:
        return -pressure(r)

    def q(r: np.ndarray) -> np.ndarray:
        return friction * pressure(r)

    normal = HarmonicField(d, fields, solid.materials, 0, sigma_zz)
    if friction == 0:
        return _State(normal, None, pressure)
    sliding = loaded(d, harmonic=1, materials=solid.materials, traction=q, far_displacement=solid.far_sliding)
    tangential = HarmonicField(d, sliding, solid.materials, 1, lambda r: -q(r))
    return _State(normal, tangential, pressure)


def _complementarity(contact: Touch, d: Discretisation) -> tuple[float, float]:
    """(deepest penetration outside over the approach, largest tension inside over the peak), both >= 0."""
    surface = d.on(d.facets(lambda x: x[1] == 0))
    r = d.locations[0, surface]
    gap = r**2 / 2 + contact.fields[d.N + surface] - contact.approach
    penetration = max(0.0, -float(gap[r > contact.contact_radius].min()))
    p = contact.pressure.values
    return penetration / contact.approach, max(0.0, -float(p.min())) / float(p.max())


def _surface_nodes(d: Discretisation) -> np.ndarray:
    """Radii of the surface unknowns out to 3 contact radii, mirrored to both signs of x."""
    surface = d.on(d.facets(lambda x: x[1] == 0))
    r = np.sort(d.locations[0, surface])
    r = r[r < 3 * d.mesh.contact_radius]
    return np.concatenate([-r[:0:-1], r])


def _bounds(
    result: _State,
    companion: _State,
    unit: _Units,
    size_share: tuple[float, float],
    far_share: tuple[float, float, float],
    load_miss: float,
) -> _Bounds:
    """Uncertainties from the companion (element size), a nearer boundary and the load left over."""
    d = result.discretisation
    pressure = PressureBound(result.pressure, companion.pressure, d.contact_vertices, size_share[0])
    peak = float(np.max(result.pressure(d.contact_vertices)))
    a = d.mesh.contact_radius
    budget = (
        ("contact_radius", "element size", SAFETY * size_share[0] * unit.length),
        ("contact_radius", "edge size", _EDGE_SHARE * _EDGE_SIZE * a * (size_share[0] > 0) * unit.length),
        ("contact_radius", "outer boundary", far_share[0] * unit.length),
        ("contact_radius", "load balance", load_miss / 3 * a * unit.length),
        ("approach", "element size", SAFETY * size_share[1] * unit.displacement),
        ("approach", "outer boundary", far_share[1] * unit.displacement),
        ("approach", "load balance", load_miss * result.sink * unit.displacement),
        ("peak_pressure", "element size", float(pressure(np.zeros(1))[0]) * unit.pressure),
        ("peak_pressure", "outer boundary", far_share[2] * unit.pressure),
        ("peak_pressure", "load balance", load_miss / 3 * peak * unit.pressure),
    )
    total = {name: sum(value for quantity, _, value in budget if quantity == name) for name, _, _ in budget}
    sliding = None
    if result.tangential is not None and companion.tangential is not None:
        sliding = StressBound(result.tangential, companion.tangential)
    return _Bounds(
        scalars=Uncertainty(**total, budget=budget),
        normal=StressBound(result.normal, companion.normal),
        tangential=sliding,
        pressure=pressure,
        everywhere=far_share[2] + load_miss / 3 * peak,
    )


def _meridian(state: _State, unit: _Units, bounds: _Bounds) -> Meridian:
    """The state as functions of SI positions giving SI values."""
    mesh = state.discretisation.mesh

    def in_si(field: HarmonicField) -> Any:
        def amplitudes(r: np.ndarray, z: np.ndarray, layer: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            u, sigma = field(r / unit.length, z / unit.length, layer)
            return u * unit.displacement, sigma * unit.pressure

        return amplitudes

    def bound_in_si(bound: StressBound | None, extra: float) -> Any:
        if bound is None:
            return None
        return lambda r, z, layer: (bound(r / unit.length, z / unit.length, layer) + extra) * unit.pressure

    def pressure_bound(r: np.ndarray) -> np.ndarray:
        assert bounds.pressure is not None
        r = r / unit.length
        inside = r <= mesh.contact_radius
        return (bounds.pressure(r) + np.where(inside, bounds.everywhere, 0.0)) * unit.pressure

    return Meridian(
        normal=in_si(state.normal),
        tangential=None if state.tangential is None else in_si(state.tangential),
        pressure=lambda r: state.pressure(r / unit.length) * unit.pressure,
        normal_bound=bound_in_si(bounds.normal, bounds.everywhere),
        tangential_bound=bound_in_si(bounds.tangential, 0.0),
        pressure_bound=None if bounds.pressure is None else pressure_bound,
        depths=mesh.depths * unit.length,
        far=float(mesh.points.max()) * unit.length,
        mesh=mesh.scaled(unit.length),
    )
