"""Public entry of the finite element method: a physical problem in, a ``Solution`` out.

Inside, every problem has one length, one pressure and the modulus of the substrate as units (``scaling``).
For the sphere they are a_h = (3 W R / 4 E*)^(1/3) of the bare substrate and E a_h/R, as ``contact`` asks.

Levels: a rough and a coarse mesh find the contact radius, a companion somewhat coarser than the final mesh
finds it closely and is the yardstick of the error, the final one gives the result. A vertex stands at the
contact radius of every level, and sliding friction is solved afterwards on the last two.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.optimize import minimize_scalar

from .axisymmetric import Discretisation
from .contact import Touch, complementarity, touch
from .estimate import SAFETY, PressureBound, StressBound
from .load_control import carry_load
from .loading import loaded, resultant
from .mesh import Grading, MeridianMesh, meridian_mesh
from .recovery import HarmonicField
from .scaling import LayeredSolid, Units, first_radius
from .solution import Diagnostics, Meridian, NotConverged, Solution, Uncertainty
from .validation import check_choice, check_materials, check_positive, check_proportions, prescribed_pressure

__all__ = ["QUALITY", "solve", "solve_prescribed"]

Coatings = tuple[tuple[float, float, float], ...]

# triangle size over its distance from the contact edge
QUALITY = {"fast": 0.36, "default": 0.16, "fine": 0.12}
_COARSE = 0.5
_COMPANION = 1.4
# Beyond this size the factor of safety grows with it: over 18 coated contacts the error came to 0.57 of the
# difference from the companion, times SAFETY, at "default", to 1.08 of it at "fast".
_SETTLED = 0.2
LOAD_TOLERANCE = 2e-7
_NEARER = 2.0
_EDGE_SIZE = 1e-6
# The last triangle misplaces the edge by this share of its size, whatever the solid: close to the edge all
# contacts look alike. Measured on Hertz: 0.008 to 0.011 for edge sizes from 1e-2 to 1e-7 of the radius.
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
    size: float | None = None,
    far: float = 1000.0,
    max_iterations: int = 30,
    load_tolerance: float = LOAD_TOLERANCE,
    estimate_uncertainty: bool = True,
) -> Solution:
    """Rigid sphere pressed on, and with friction slid over, a coated half-space.

    radius [m], load [N], coatings ((E, nu, thickness), ...) [Pa, -, m] from the surface down, () for none,
    substrate (E, nu), friction f in q = f p, the traction on the solid in +x, taken not to change p
    (Goodman).
    order   : polynomial order of the displacement, 2 to 4
    quality : "fast" (about 1e-3), "default" (about 1e-5) or "fine"
    size    : triangle size over its distance from the contact edge, 0.08 to 0.5; None takes that of
    ``quality``
    far     : distance of the outer boundary over (a_h + thickness of all coatings)
    max_iterations : contact solves allowed on each mesh level
    load_tolerance : relative, at which the contact radius is settled on the last two levels
    The approach is that of the sphere towards points at infinity.
    Poisson ratios up to 0.49 do not lock at order 4; above, digits are lost as 1/(1 - 2 nu), and 0.5 is
    refused. Raises ValueError for bad input, NotConverged when no contact radius carries the load.
    """
    started = time.perf_counter()
    check_positive(
        radius=radius, load=load, far=far, max_iterations=max_iterations, load_tolerance=load_tolerance
    )
    check_materials(coatings, substrate, friction)
    check_choice("order", order, (2, 3, 4))
    size = _size(quality, size)
    E, nu = substrate
    a_h = (3 * load * radius * (1 - nu**2) / (4 * E)) ** (1 / 3)
    unit = Units(length=a_h, pressure=E * a_h / radius, modulus=E)
    solid = LayeredSolid.scaled(coatings, substrate, a_h, far)
    check_proportions(solid.thicknesses, "a_h")
    target = load / unit.load

    history: list[tuple[str, float, float]] = []
    a, slope = first_radius(solid, target), 3.0

    def touch_on(mesh: MeridianMesh, order: int) -> _Placed:
        d = Discretisation(mesh, order)
        return _Placed(touch(d, materials=solid.materials, far_displacement=solid.far_displacement), d)

    def level(name: str, grading: Grading, order: int, tolerance: float) -> _Placed:
        nonlocal a, slope
        carried = carry_load(
            target,
            start=a,
            slope=slope,
            tolerance=tolerance,
            max_iterations=max_iterations,
            mesh_at=partial(_mesh, solid, grading),
            solve_on=partial(touch_on, order=order),
        )
        history.extend((name, x * a_h, W * unit.load) for x, W in carried.history)
        if not carried.converged:
            raise NotConverged(
                f"the contact radius did not settle on the {name} mesh: after {len(carried.history)} "
                "solves, at "
                f"{carried.contact_radius:.4g} a_h, the load is {carried.contact.load / target:.6g} of "
                "the one "
                f"asked for; raise max_iterations, or check the thicknesses and the ratio of the moduli"
            )
        slope = carried.slope
        # the next level starts where this one would carry exactly the load
        a = carried.contact_radius * (target / carried.contact.load) ** (1 / slope)
        return carried.contact

    level("rough", Grading.of(0.6), 2, 0.02)
    level("coarse", Grading.of(_COARSE), order, 1e-3)
    companion = level("companion", _companion(size), order, load_tolerance) if estimate_uncertainty else None
    final = level("final", Grading.of(size, _EDGE_SIZE), order, load_tolerance)
    found = final.touch
    if found.contact_radius * a_h >= radius:
        raise ValueError(
            f"load = {load:g} N presses the contact radius to {found.contact_radius * a_h:g} m, beyond the "
            f"radius of the sphere, {radius:g} m; small strains need a far smaller load"
        )
    penetration, tension = complementarity(found, final.discretisation)
    if not (0 <= penetration <= 1e-3 and 0 <= tension <= 1e-3):  # so that NaN and -inf are refused too
        raise NotConverged(
            f"the contact is not one disc: penetration outside is {penetration:.2g} of the approach, tension "
            f"inside {tension:.2g} of the peak pressure; use quality='fine', or check the Poisson ratios"
        )

    if not np.isfinite(found.stiffness):
        raise NotConverged(f"the contact's stiffness dW/d delta is {found.stiffness}; use quality='fine'")

    load_miss = abs(found.load / target - 1)
    result = _state(solid, final.discretisation, found.fields, found.pressure, friction)
    bounds, stiffness_bound = _NO_BOUNDS, None
    if companion is not None:
        coarser = companion.touch
        other = _state(solid, companion.discretisation, coarser.fields, coarser.pressure, friction)
        near = touch_on(companion.discretisation.mesh.drawn_in(_NEARER), order).touch
        # change of the scalars at fixed load: the load is taken back along the contact's own stiffness
        missing = coarser.load - near.load
        far_share = (
            abs(missing / target / slope * coarser.contact_radius),
            abs(near.approach - coarser.approach + missing / coarser.stiffness),
            abs(near.pressure.values[0] - coarser.pressure.values[0]),
        )
        size_share = (
            abs(found.contact_radius - coarser.contact_radius),
            abs(found.approach - coarser.approach),
        )
        caution = _caution(size)
        bounds = _bounds(result, other, unit, size_share, far_share, load_miss, caution)
        stiffness_bound = (
            SAFETY * caution * abs(found.stiffness - coarser.stiffness)
            + abs(near.stiffness - coarser.stiffness)
            + load_miss * found.stiffness
        )
    return Solution(
        contact_radius=found.contact_radius * unit.length,
        approach=found.approach * unit.displacement,
        peak_pressure=_peak(found.pressure, found.pressure.vertices)[1] * unit.pressure,
        surface_nodes=_surface_nodes(final.discretisation) * unit.length,
        uncertainty=bounds.scalars,
        diagnostics=Diagnostics(
            iterations=len(history),
            dofs=2 * final.discretisation.N,
            triangles=int(final.discretisation.mesh.layer.size),
            order=order,
            residual_gap=penetration,
            residual_pressure=tension,
            residual_load=load_miss,
            residual_equilibrium=found.residual,
            seconds=time.perf_counter() - started,
            history=tuple(history),
        ),
        meridian=_meridian(result, unit, bounds),
        stiffness=found.stiffness * unit.load / unit.displacement,
        stiffness_uncertainty=(
            None if stiffness_bound is None else float(stiffness_bound * unit.load / unit.displacement)
        ),
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
    size: float | None = None,
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
    size = _size(quality, size)
    p = prescribed_pressure(pressure, load_radius)
    unit = Units(length=load_radius, pressure=p.scale, modulus=substrate[0])
    solid = LayeredSolid.scaled(coatings, substrate, load_radius, far)
    check_proportions(solid.thicknesses, "load_radius")

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

    result = state(_mesh(solid, Grading.of(size, _EDGE_SIZE), 1.0))
    d = result.discretisation
    bounds = _NO_BOUNDS
    if estimate_uncertainty:
        mesh = _mesh(solid, _companion(size), 1.0)
        other = state(mesh)
        far_share = (0.0, abs(other.sink - state(mesh.drawn_in(_NEARER)).sink), 0.0)
        bounds = _bounds(
            result, other, unit, (0.0, abs(result.sink - other.sink)), far_share, 0.0, _caution(size)
        )
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


@dataclass(frozen=True, eq=False)
class _Placed:
    """A contact with the discretisation it was found on."""

    touch: Touch
    discretisation: Discretisation

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


_NO_BOUNDS = _Bounds(None, None, None, None)


def _size(quality: str, size: float | None) -> float:
    check_choice("quality", quality, tuple(QUALITY))
    if size is None:
        return QUALITY[quality]
    check_positive(size=size)
    if not 0.08 <= size <= 0.5:
        raise ValueError(f"size = {size:g}; choose it between 0.08 (a minute, gigabytes) and 0.5 (coarse)")
    return size


def _caution(size: float) -> float:
    """What SAFETY is multiplied with: more where elements are too large for errors to fall as they should."""
    return max(1.0, size / _SETTLED)


def _companion(size: float) -> Grading:
    """The mesh that stands for the error: coarser everywhere, and blunter at the edge."""
    return Grading.of(_COMPANION * size, edge_size=4 * _EDGE_SIZE)


def _mesh(solid: LayeredSolid, grading: Grading, a: float) -> MeridianMesh:
    return meridian_mesh(contact_radius=a, thicknesses=solid.thicknesses, far=solid.far, grading=grading)


def _state(
    solid: LayeredSolid,
    d: Discretisation,
    fields: np.ndarray,
    pressure: Callable[[np.ndarray], np.ndarray],
    friction: float,
) -> _State:
    """Wrap the normal fields, and solve for sliding where there is friction."""
    normal = HarmonicField(d, fields, solid.materials, 0, pressure, -1.0)
    if friction == 0:
        return _State(normal, None, pressure)
    sliding = loaded(
        d,
        harmonic=1,
        materials=solid.materials,
        traction=lambda r: friction * pressure(r),
        far_displacement=solid.far_sliding,
    )
    tangential = HarmonicField(d, sliding, solid.materials, 1, pressure, -friction)
    return _State(normal, tangential, pressure)


def _surface_nodes(d: Discretisation) -> np.ndarray:
    """Radii of the surface unknowns out to 3 contact radii, mirrored to both signs of x."""
    r = d.locations[0, d.surface]
    r = r[r < 3 * d.mesh.contact_radius]
    return np.concatenate([-r[:0:-1], r])


def _peak(pressure: Callable[[np.ndarray], np.ndarray], vertices: np.ndarray) -> tuple[float, float]:
    """Radius and value of the largest pressure: the axis, or a ring where a stiff film bends like a plate."""
    r = np.unique(np.linspace(vertices[:-1], vertices[1:], 9))
    best = int(np.argmax(pressure(r)))
    if best == 0:
        return 0.0, float(pressure(r[:1])[0])
    found = minimize_scalar(
        lambda radius: -float(pressure(np.array([radius]))[0]),
        bounds=(r[best - 1], r[min(best + 1, r.size - 1)]),
        method="bounded",
        options={"xatol": 1e-6 * r[-1]},
    )
    return float(found.x), -float(found.fun)


def _bounds(
    result: _State,
    companion: _State,
    unit: Units,
    size_share: tuple[float, float],
    far_share: tuple[float, float, float],
    load_miss: float,
    caution: float,
) -> _Bounds:
    """Uncertainties from the companion (element size), a nearer boundary and the load left over."""
    d = result.discretisation
    at, peak = _peak(result.pressure, d.contact_vertices)
    a = d.mesh.contact_radius
    everywhere = far_share[2] + load_miss / 3 * peak
    pressure = PressureBound(
        result.pressure, companion.pressure, d.contact_vertices, size_share[0], everywhere, caution
    )
    size_peak = float(pressure(np.array([at]))[0]) - everywhere
    budget: tuple[tuple[str, str, float], ...] = (
        ("contact_radius", "element size", SAFETY * caution * size_share[0] * unit.length),
        ("contact_radius", "edge size", _EDGE_SHARE * _EDGE_SIZE * a * (size_share[0] > 0) * unit.length),
        ("contact_radius", "outer boundary", far_share[0] * unit.length),
        ("contact_radius", "load balance", load_miss / 3 * a * unit.length),
        ("approach", "element size", SAFETY * caution * size_share[1] * unit.displacement),
        ("approach", "outer boundary", far_share[1] * unit.displacement),
        ("approach", "load balance", load_miss * result.sink * unit.displacement),
        ("peak_pressure", "element size", size_peak * unit.pressure),
        ("peak_pressure", "outer boundary", far_share[2] * unit.pressure),
        ("peak_pressure", "load balance", load_miss / 3 * peak * unit.pressure),
    )
    budget = tuple((quantity, knob, float(value)) for quantity, knob, value in budget)
    total = {name: sum(value for quantity, _, value in budget if quantity == name) for name, _, _ in budget}
    sliding = None
    if result.tangential is not None and companion.tangential is not None:
        sliding = StressBound(result.tangential, companion.tangential, caution=caution)
    return _Bounds(
        scalars=Uncertainty(**total, budget=budget),
        normal=StressBound(result.normal, companion.normal, everywhere, caution),
        tangential=sliding,
        pressure=pressure,
    )


def _meridian(state: _State, unit: Units, bounds: _Bounds) -> Meridian:
    return Meridian(
        normal=state.normal,
        tangential=state.tangential,
        pressure=state.pressure,
        normal_bound=bounds.normal,
        tangential_bound=bounds.tangential,
        pressure_bound=bounds.pressure,
        mesh=state.discretisation.mesh,
        length=unit.length,
        displacement=unit.displacement,
        stress=unit.pressure,
    )
