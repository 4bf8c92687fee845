"""Public entry of the finite element method: a physical problem in, a ``Solution`` out.

Inside, lengths are in a_h, moduli in E of the substrate and the sphere has radius 1 in the sense of ``contact``:
displacement in a_h^2/R, pressure in E a_h/R, load in E a_h^3/R, with a_h = (3 W R / 4 E*)^(1/3) of the substrate.

Levels: a coarse one finds the contact radius roughly, a companion about 1.4 times coarser than the final mesh finds it closely
and serves as the yardstick of the error, the final one gives the result. On every level radii are stretched until the
load is the one asked for, so that a mesh vertex stands at the contact radius itself.
"""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from .axisymmetric import Discretisation
from .contact import Touch, touch
from .estimate import StressBound, line_bound
from .far_field import boussinesq
from .mesh import Grading, MeridianMesh, meridian_mesh
from .recovery import HarmonicField
from .solution import Diagnostics, Meridian, NotConverged, Solution, Uncertainty
from .validation import check_choice, check_materials, check_positive

__all__ = ["QUALITY", "solve"]

# triangle size over distance from the contact edge
QUALITY = {"fast": 0.40, "default": 0.20, "fine": 0.15}
_COMPANION = 1.4
_TOLERANCE = 1e-9


@dataclass(frozen=True, eq=False)
class _Scaled:
    """The problem in the units of the module."""

    materials: tuple[tuple[float, float], ...]
    thicknesses: tuple[float, ...]
    load: float
    far: float

    def far_displacement(self, r: np.ndarray, z: np.ndarray) -> np.ndarray:
        return boussinesq(r, z, *self.materials[-1])


@dataclass(frozen=True, eq=False)
class _Level:
    """One converged contact."""

    discretisation: Discretisation
    touch: Touch

    def field(self, problem: _Scaled) -> HarmonicField:
        p = self.touch.pressure
        return HarmonicField(self.discretisation, self.touch.fields, problem.materials, 0, lambda r: -p(r))


def solve(
    *,
    radius: float,
    load: float,
    coatings: tuple[tuple[float, float, float], ...],
    substrate: tuple[float, float],
    friction: float = 0.0,
    order: int = 4,
    quality: str = "default",
    far: float = 1000.0,
    max_iterations: int = 40,
    estimate_uncertainty: bool = True,
) -> Solution:
    """Rigid sphere on a coated half-space by finite elements on the meridian plane.

    radius [m], load [N], coatings ((E, nu, thickness), ...) from the surface down, () is uncoated, substrate
    (E, nu), friction f in q = f p on the solid in +x.
    order   : polynomial order of the displacement, 2 to 4; the contact pressure has one order less
    quality : "fast" (about 1e-3), "default" (about 1e-5), "fine"
    far     : outer boundary over (a_h + total coating thickness)
    Raises ValueError for bad input, NotConverged when no contact radius carries the load.
    """
    started = time.perf_counter()
    check_positive(radius=radius, load=load, far=far)
    check_materials(coatings, substrate, friction)
    check_choice("order", order, (2, 3, 4))
    check_choice("quality", quality, tuple(QUALITY))
    problem, a_h = _scaled(radius, load, coatings, substrate, far)
    history: list[tuple[str, float, float]] = []
    unit = _Units(a_h, radius, substrate[0])

    size = QUALITY[quality]
    fine = _grading(size)
    rough_order = min(order, 3)
    a0 = _first_radius(problem)
    coarse = _converge(problem, a0, _grading(0.5), rough_order, 1e-4, max_iterations, history, "coarse")
    a1 = coarse.touch.contact_radius
    companion = None
    if estimate_uncertainty:
        companion = _converge(
            problem, a1, fine.coarser(_COMPANION), order, _TOLERANCE, max_iterations, history, "companion"
        )
        a1 = companion.touch.contact_radius
    final = _converge(problem, a1, fine, order, _TOLERANCE, max_iterations, history, "final")

    gap, pressure_residual = _complementarity(final, problem)
    touched = final.touch
    p_scale = unit.pressure
    diagnostics = Diagnostics(
        iterations=len(history),
        dofs=2 * final.discretisation.N + touched.pressure.nodes.size,
        triangles=int(final.discretisation.mesh.layer.size),
        order=order,
        residual_gap=touched.residuals[1],
        residual_pressure=pressure_residual,
        residual_load=abs(touched.load / problem.load - 1),
        residual_equilibrium=touched.residuals[0],
        seconds=time.perf_counter() - started,
        history=tuple((name, a * a_h, W * unit.load) for name, a, W in history),
    )
    field = final.field(problem)
    uncertainty, bounds = None, (None, None)
    if companion is not None:
        uncertainty, bounds = _estimate(problem, coarse, companion, final, unit)
    meridian = Meridian(
        normal=_in_si(field, unit),
        tangential=None,
        pressure=lambda r: touched.pressure(r / unit.length) * p_scale,
        normal_bound=bounds[0],
        tangential_bound=None,
        pressure_bound=bounds[1],
        depths=final.discretisation.mesh.depths * a_h,
        far=problem.far * a_h,
        mesh=final,
    )
    return Solution(
        contact_radius=touched.contact_radius * unit.length,
        approach=touched.approach * unit.displacement,
        peak_pressure=float(np.max(touched.pressure.values)) * unit.pressure,
        surface_nodes=_surface_nodes(final) * unit.length,
        uncertainty=uncertainty,
        diagnostics=replace(diagnostics, seconds=time.perf_counter() - started),
        meridian=meridian,
    )


@dataclass(frozen=True)
class _Units:
    """SI value of one unit of the module."""

    length: float
    radius: float
    modulus: float

    @property
    def displacement(self) -> float:
        return self.length**2 / self.radius

    @property
    def pressure(self) -> float:
        return self.modulus * self.length / self.radius

    @property
    def load(self) -> float:
        return self.modulus * self.length**3 / self.radius


def _scaled(radius, load, coatings, substrate, far):  # type: ignore[no-untyped-def]
    E, nu = substrate
    E_star = E / (1 - nu**2)
    a_h = (3 * load * radius / (4 * E_star)) ** (1 / 3)
    thicknesses = tuple(h / a_h for _, _, h in coatings)
    materials = (*((Ei / E, nui) for Ei, nui, _ in coatings), (1.0, nu))
    return _Scaled(materials, thicknesses, 4 / (3 * (1 - nu**2)), far * (1 + sum(thicknesses))), a_h


def _grading(size: float) -> Grading:
    return Grading(
        size=size, edge_rate=min(1.4 * size, 0.6), edge_size=1e-6, axis_size=0.65 * size, far_size=2 * size
    )


def _first_radius(problem: _Scaled) -> float:
    """Contact radius guessed from each layer's share of the compliance; the share above z is (2/pi) atan(z/a)."""
    depths = np.cumsum([0.0, *problem.thicknesses])
    a = 1.0
    for _ in range(30):
        share = np.diff(2 / np.pi * np.arctan(depths / a), append=1.0)
        compliance = sum(s * (1 - nu**2) / E for s, (E, nu) in zip(share, problem.materials, strict=True))
        a = (0.75 * problem.load * compliance) ** (1 / 3)
    return float(a)


def _converge(
    problem: _Scaled,
    a: float,
    grading: Grading,
    order: int,
    tolerance: float,
    max_iterations: int,
    history: list[tuple[str, float, float]],
    name: str,
) -> _Level:
    """Move the contact radius until the load is right: d log W / d log a by secants, 3 to begin with."""
    slope = 3.0
    mesh: MeridianMesh | None = None
    built = a
    previous: tuple[float, float] | None = None
    for _ in range(max_iterations):
        if mesh is None or not 0.95 < a / built < 1.05:
            mesh = meridian_mesh(
                contact_radius=a, thicknesses=problem.thicknesses, far=problem.far, grading=grading
            )
            built = a
        discretisation = Discretisation(mesh.stretched(a / built), order)
        solved = touch(
            discretisation,
            materials=problem.materials,
            far_displacement=problem.far_displacement,
            multiplier_order=order - 1,
        )
        history.append((name, a, solved.load))
        if not solved.load > 0 or not math.isfinite(solved.load):
            break
        error = math.log(problem.load / solved.load)
        if abs(error) <= tolerance:
            return _Level(discretisation, solved)
        here = (math.log(a), math.log(solved.load))
        if previous is not None and abs(here[0] - previous[0]) > 1e-7:
            slope = min(max((here[1] - previous[1]) / (here[0] - previous[0]), 1.0), 9.0)
        previous = here
        a *= math.exp(min(max(error / slope, -0.7), 0.7))
    _, a, load = history[-1]
    raise NotConverged(
        f"the contact radius did not settle in {max_iterations} solves: at {a:g} a_h the load is {load / problem.load:g} "
        f"of the one asked for; raise max_iterations, or check the ratio of moduli"
    )


def _surface_dofs(level: _Level) -> np.ndarray:
    """Unknowns of one field on the surface, ordered by radius."""
    d = level.discretisation
    numbers = d.on(d.facets(lambda x: x[1] == 0))
    return numbers[np.argsort(d.locations[0, numbers])]


def _complementarity(level: _Level, problem: _Scaled) -> tuple[float, float]:
    """(largest penetration outside over the approach, largest tension inside over the peak); both >= 0."""
    d, touched = level.discretisation, level.touch
    surface = _surface_dofs(level)
    r = d.locations[0, surface]
    gap = r**2 / 2 + touched.fields[d.N + surface] - touched.approach
    outside = r > touched.contact_radius
    penetration = max(0.0, -float(gap[outside].min())) / touched.approach
    p = touched.pressure.values
    tension = max(0.0, -float(p.min())) / float(p.max())
    return penetration, tension


def _surface_nodes(level: _Level) -> np.ndarray:
    """Radii of the pressure's own nodes and of the surface nodes beyond, to 3 contact radii, both signs."""
    a = level.touch.contact_radius
    beyond = level.discretisation.locations[0, _surface_dofs(level)]
    r = np.concatenate([level.touch.pressure.nodes, beyond[(beyond > a * (1 + 1e-12)) & (beyond < 3 * a)]])
    return np.concatenate([-r[:0:-1], r])


def _in_si(field: HarmonicField, unit: _Units):  # type: ignore[no-untyped-def]
    """The field's amplitudes with SI units going in and coming out."""

    def amplitudes(r: np.ndarray, z: np.ndarray, layer: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        u, sigma = field(r / unit.length, _on_interfaces(field, z / unit.length), layer)
        return u * unit.displacement, sigma * unit.pressure

    return amplitudes


def _on_interfaces(field: HarmonicField, z: np.ndarray) -> np.ndarray:
    """Depths with those within rounding of an interface put on it, so that each side finds its triangles."""
    z = z.copy()
    for depth in field.discretisation.mesh.depths:
        z[np.abs(z - depth) <= 1e-12 * depth] = depth
    return z


def _estimate(problem: _Scaled, coarse: _Level, companion: _Level, final: _Level, unit: _Units):  # type: ignore[no-untyped-def]
    """Uncertainty record and the bounds of stress and pressure, from the companion and from a nearer boundary."""
    near = replace(problem, far=problem.far / 4)
    c = coarse.touch
    other = _fixed_radius(near, coarse)
    # change of the approach at fixed load: the load changes back along the contact's stiffness
    far_approach = abs(other.approach - c.approach - (other.load - c.load) / c.stiffness)
    far_radius = abs(math.log(other.load / c.load)) / 3 * c.contact_radius
    far_peak = abs(other.pressure.values[0] - c.pressure.values[0])
    size_radius = abs(final.touch.contact_radius - companion.touch.contact_radius)
    size_approach = abs(final.touch.approach - companion.touch.approach)

    p, q = final.touch.pressure, companion.touch.pressure
    vertices, bound = line_bound(lambda r: p(r) - q(r), p.vertices)
    U_a = size_radius

    def pressure_bound(r: np.ndarray) -> np.ndarray:
        r = np.asarray(r) / unit.length
        shift = np.maximum(np.abs(p(r + U_a) - p(r)), np.abs(p(np.abs(r - U_a)) - p(r)))
        return (np.interp(r, vertices, bound, right=0.0) + shift) * unit.pressure

    size_peak = float(bound[:2].max())
    field = final.field(problem)
    stress = StressBound(field, companion.field(problem))

    def stress_bound(r: np.ndarray, z: np.ndarray, layer: np.ndarray) -> np.ndarray:
        return stress(r / unit.length, _on_interfaces(field, z / unit.length), layer) * unit.pressure

    L, u, s = unit.length, unit.displacement, unit.pressure
    budget = (
        ("contact_radius", "element size", size_radius * L),
        ("contact_radius", "far boundary", far_radius * L),
        ("approach", "element size", size_approach * u),
        ("approach", "far boundary", far_approach * u),
        ("peak_pressure", "element size", size_peak * s),
        ("peak_pressure", "far boundary", far_peak * s),
    )
    total = {
        name: sum(value for quantity, _, value in budget if quantity == name)
        for name in ("contact_radius", "approach", "peak_pressure")
    }
    return Uncertainty(**total, budget=budget), (stress_bound, pressure_bound)


def _fixed_radius(problem: _Scaled, level: _Level) -> Touch:
    """The contact of ``level`` at the same radius on another domain."""
    d = level.discretisation
    mesh = meridian_mesh(
        contact_radius=level.touch.contact_radius,
        thicknesses=problem.thicknesses,
        far=problem.far,
        grading=_grading(0.5),
    )
    return touch(
        Discretisation(mesh, d.order),
        materials=problem.materials,
        far_displacement=problem.far_displacement,
        multiplier_order=d.order - 1,
    )
