"""Public entry of the finite element method: a physical problem in, a ``Solution`` out.

Inside, every problem has one length, one pressure and the modulus of the flat's substrate as units
(``scaling``). For the sphere they are a_h = (3 W R / 4 E*)^(1/3) of the bare substrates and E a_h/R, as
``fixed_radius`` requires. Sliding friction is solved last, on the final mesh and its companion (``levels``).
"""

import time
from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from fem_reference import element_numbers as chosen
from fem_reference.contact.fixed_radius import complementarity
from fem_reference.contact.levels import ElementsNotConverged, family, meshes_at, solve_levels
from fem_reference.elasticity.axisymmetric import Discretisation
from fem_reference.elasticity.loading import solve_traction
from fem_reference.elasticity.recovery import HarmonicField
from fem_reference.elasticity.state import ElasticState
from fem_reference.estimate import Estimates, contact_estimates, estimates, of_scalar
from fem_reference.meshing.mesh import Grading
from fem_reference.scaling import Coatings, LayeredSolid, Scales
from fem_reference.solved_contact import ElementDiagnostics, ElementSolution
from fem_reference.validation import (
    check_ball,
    check_choice,
    check_materials,
    check_positive,
    check_proportions,
    check_radius,
    prescribed_pressure,
)

Ball = tuple[float, float, Coatings]


def solve(
    *,
    radius: float,
    load: float,
    coatings: Coatings,
    substrate: tuple[float, float],
    friction: float = 0.0,
    ball: Ball | None = None,
    order: int = 4,
    quality: str = "default",
    size: float | None = None,
    far: float = 1000.0,
    estimate_uncertainty: bool = True,
    gap: str = "parabola",
) -> ElementSolution:
    """Sphere pressed on, and with friction slid over, a coated half-space.

    radius [m], load [N], coatings ((E, nu, thickness), ...) [Pa, -, m] from the surface down, () for none,
    substrate (E, nu), friction f in q = f p, the traction on the flat in +x, on the ball in -x, assumed not
    to change p (Goodman).
    ball    : None is rigid; (E, nu, coatings) of an elastic one, its coatings from its surface inwards. Near
        the contact it is a layered half-space.
    order   : polynomial order of the displacement, 2 to 4
    quality : "fast" (about 1e-3), "default" (about 1e-5) or "fine"; finer next to a large step of moduli
    size    : triangle size over its distance from the contact edge, 0.08 to 0.5; None for that of ``quality``
    far     : distance of the outer boundary over (a_h + thickness of all coatings)
    gap     : "parabola" r^2/2R or "sphere" R - sqrt(R^2 - r^2)
    The approach is that of distant points of both bodies.
    Poisson ratios up to 0.49 do not lock at order 4; above, digits are lost as 1/(1 - 2 nu), and 0.5 is
    refused. Raises ValueError for bad input, ElementsNotConverged when no contact radius has the load.
    """
    started = time.perf_counter()
    check_positive(radius=radius, load=load, far=far)
    check_materials(coatings, substrate, friction)
    check_choice("order", order, (2, 3, 4))
    check_choice("gap", gap, ("parabola", "sphere"))
    E, nu = substrate
    compliance = (1 - nu**2) / E
    if ball is not None:
        check_ball(ball)
        compliance += (1 - ball[1] ** 2) / ball[0]
    size = _size(quality, size, [(*coatings, substrate), (*ball[2], ball[:2]) if ball else ()])
    a_h = (3 * load * radius * compliance / 4) ** (1 / 3)
    unit = Scales(length=a_h, pressure=E * a_h / radius, modulus=E)
    solids: tuple[LayeredSolid, ...] = (LayeredSolid.scaled(coatings, substrate, a_h, far, E),)
    check_proportions(solids[0].thicknesses, "a_h")
    if ball is not None:
        solids += (LayeredSolid.scaled(ball[2], ball[:2], a_h, far, E),)
        check_proportions(solids[1].thicknesses, "a_h", "the ball's ")
    target = load / unit.load

    contacts, history = solve_levels(
        solids,
        target,
        order=order,
        size=size,
        meshes=3 if estimate_uncertainty else 1,
        curvature=a_h / radius if gap == "sphere" else 0.0,
    )
    final = contacts[0]
    d = final.discretisation
    check_radius(final.contact_radius * a_h, radius)
    penetration, tension = complementarity(final)
    if not all(0 <= part <= chosen.NO_DISC for part in (penetration, tension)):  # also true of NaN, -inf
        raise ElementsNotConverged(
            f"the contact is not one disc: penetration outside is {penetration:.2g} of the approach, tension "
            f"inside {tension:.2g} of the peak pressure; use quality='fine', or check the Poisson ratios"
        )
    if not np.isfinite(final.stiffness):
        raise ElementsNotConverged(
            f"the contact's stiffness dW/d delta is {final.stiffness}; use quality='fine'"
        )
    pairs = zip(solids, (None, final.ball), strict=False)
    states = tuple(ElasticState.of_contact(solid, final, body) for solid, body in pairs)
    found: tuple[Estimates, ...] = ()
    stiffness_error = None
    if estimate_uncertainty:
        found, stiffness_error = contact_estimates(contacts, states, unit)
    frictionless = ElementSolution(
        contact_radius=final.contact_radius * unit.length,
        approach=final.approach * unit.displacement,
        peak_pressure=states[0].peak[1] * unit.pressure,
        surface_nodes=_surface_nodes(d) * unit.length,
        diagnostics=ElementDiagnostics(
            iterations=len(history),
            dofs=sum(2 * state.discretisation.N for state in states),
            triangles=sum(int(state.mesh.layer.size) for state in states),
            order=order,
            residual_gap=penetration,
            residual_pressure=tension,
            residual_equilibrium=final.residual,
            seconds=time.perf_counter() - started,
            history=tuple((name, a * a_h, W * unit.load) for name, a, W in history),
        ),
        states=states,
        estimates=found,
        units=unit,
        stiffness=final.stiffness * unit.load / unit.displacement,
        stiffness_uncertainty=stiffness_error,
    )
    return frictionless.with_friction(friction)


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
) -> ElementSolution:
    """A coated half-space under a given pressure on the disc r <= ``load_radius``, with q = f p.

    pressure : a number (uniform) or a callable p(r) [Pa] of an array of radii [m]
    The approach of the solution is u_z at the origin, its contact radius is ``load_radius``. Other arguments
    and errors as for ``solve``.
    """
    started = time.perf_counter()
    check_positive(load_radius=load_radius, far=far)
    check_materials(coatings, substrate, friction)
    check_choice("order", order, (2, 3, 4))
    size = _size(quality, size, [(*coatings, substrate)])
    p = prescribed_pressure(pressure, load_radius)
    unit = Scales(length=load_radius, pressure=p.scale, modulus=substrate[0])
    solid = LayeredSolid.scaled(coatings, substrate, load_radius, far, substrate[0])
    check_proportions(solid.thicknesses, "load_radius")

    def state_on(grading: Grading) -> ElasticState:
        d = Discretisation(meshes_at((solid,), grading, 1.0)[0], order)
        fields = solve_traction(d, solid, 0, p)
        return ElasticState(solid, HarmonicField(d, fields, solid.materials, 0, p, -1.0, False), None)

    state, *coarser = map(state_on, family(size)[: 3 if estimate_uncertainty else 1])
    found: tuple[Estimates, ...] = ()
    if estimate_uncertainty:
        approach = of_scalar([one.central_displacement for one in (state, *coarser)], order + 1)
        found = estimates((state,), (tuple(coarser),), unit, approach)
    d = state.discretisation
    nodes = _surface_nodes(d)
    frictionless = ElementSolution(
        contact_radius=load_radius,
        approach=state.central_displacement * unit.displacement,
        peak_pressure=float(np.max(p(np.abs(nodes)))) * unit.pressure,
        surface_nodes=nodes * unit.length,
        diagnostics=ElementDiagnostics(
            dofs=2 * d.N,
            triangles=int(d.mesh.layer.size),
            order=order,
            seconds=time.perf_counter() - started,
            history=(("final", load_radius, float(2 * np.pi * d.contact_load(p).sum()) * unit.load),),
        ),
        states=(state,),
        estimates=found,
        units=unit,
        singular_radii=p.singular_radii,
    )
    return frictionless.with_friction(friction)


def _size(quality: str, size: float | None, bodies: Sequence[Sequence[tuple[float, ...]]]) -> float:
    """The size asked for; ``bodies`` : the layers of each, (E, ...) from the surface down."""
    check_choice("quality", quality, tuple(chosen.QUALITY))
    if size is None:
        steps = [upper[0] / lower[0] for layers in bodies for upper, lower in pairwise(layers)]
        largest = max(steps, default=1.0)
        sizes = [chosen.QUALITY, *(finer for least, finer in chosen.CONTRASTS.items() if largest > least)]
        return min(one[quality] for one in sizes)
    check_positive(size=size)
    if not chosen.SMALLEST_SIZE <= size <= chosen.LARGEST_SIZE:
        raise ValueError(
            f"size = {size:g}; choose it between {chosen.SMALLEST_SIZE} (a minute, gigabytes) and "
            f"{chosen.LARGEST_SIZE} (coarse)"
        )
    return size


def _surface_nodes(d: Discretisation) -> np.ndarray:
    """Radii of the surface unknowns out to 3 contact radii, mirrored to both signs of x."""
    r = d.locations[0, d.surface]
    r = r[r < 3 * d.mesh.contact_radius]
    return np.concatenate([-r[:0:-1], r])
