"""Public entry of the semi-analytical method: physical keywords in, ``Solution`` out.

Assumed: small strains, perfect bond, the sphere's parabola, both bodies half-spaces near the contact, Coulomb
friction q = f p that leaves p unchanged.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from semianalytic import numbers, uncertainty
from semianalytic.coefficients import influence
from semianalytic.inputs import (
    Body,
    Numerics,
    check_control,
    check_finite,
    check_odd,
    check_positive,
    check_truth_value,
)
from semianalytic.patches import contact, convolution, nested, prescribed
from semianalytic.patches.contact import NotConverged
from semianalytic.patches.grid import Grid, odd, touches_rim
from semianalytic.patches.indenter_profile import Shape, profile_of
from semianalytic.patches.level import Indenter, Level
from semianalytic.patches.neighbours import Neighbours, Sphere, hertz_radius
from semianalytic.solution import Solution
from semianalytic.uncertainty import Uncertainty

Array = NDArray[np.floating]
Coatings = tuple[tuple[float, float, float], ...]
Substrate = tuple[float, float]
Ball = tuple[float, float, Coatings]


def solve(
    *,
    radius: float,
    load: float | None,
    coatings: Coatings,
    substrate: Substrate,
    friction: float = 0.0,
    ball: Ball | None = None,
    approach: float | None = None,
    patches: int = 257,
    tolerance: float = 1e-9,
    max_iterations: int = 600,
    conversion: str = "split",
    edge_correction: bool = True,
    estimate_uncertainty: bool = True,
    threads: int = 1,
    gap: str = "parabola",
    accuracy: float | None = 1e-5,
    indenter: Shape | None = None,
) -> Solution:
    """Press a sphere of ``radius`` [m] with ``load`` [N] on a coated half-space.

    coatings ((E, nu, thickness), ...) from the surface down; substrate (E, nu); friction f in q = f p, the
    traction on the flat in +x and on the ball in -x.
    ball : None is rigid; (E, nu, coatings) of an elastic one, its coatings from its surface inwards.
    approach : delta [m], of distant points of both bodies, instead of the load, which then is None.
    patches : per side of the finest grid, odd. The other numerics: ``inputs.Numerics``; the conversions:
    ``influence``.
    edge_correction : for the square root of the pressure at the edge (``edge_correction``). False : constant
    patches alone, whose edge is a staircase.
    accuracy : relative uncertainty of contact radius, approach and peak pressure, for which the patches are
    refined beyond ``patches`` to at most 2801 a side, 1401 where that stops helping, and until the
    pressure, at the same x/a, changes by no more than as much of its peak; the solution states what it
    reached. None : no refinement.
    gap : "parabola" r^2/2R or "sphere" R - sqrt(R^2 - r^2).
    indenter : another shape than a sphere, (name, numbers [m]) as in ``indenter_profile``, pressed as by
    ``indent`` over a square that is found; refined to at most 513 patches a side, where
    the contact is more than 8 times as long as wide in proportion more, of which few are used, up to 2801.

    Raises ValueError for input without meaning and for a contact as wide as the sphere, NotConverged when the
    iteration stops short.
    """
    began = time.perf_counter()
    check_control(load, approach)
    check_positive(radius=radius)
    body = _body(coatings, substrate, friction, ball)
    numerics = Numerics(patches, tolerance, max_iterations, conversion, threads, accuracy)
    check_truth_value(edge_correction=edge_correction)
    if edge_correction:
        check_odd(patches)
    if indenter is not None:
        if gap != "parabola":
            raise ValueError(f"gap = {gap!r} is of a sphere, and indenter = {indenter!r}; give one")
        pressed = _of_profile(profile_of(indenter, radius), load, approach, edge_correction)
        half_width = numbers.FILL * numbers.WIDER_SHAPE * hertz_radius(radius, load, approach, body)
        numerics = replace(numerics, tolerance=max(tolerance, 1e-8))
        return _shaped(pressed, half_width, body, numerics, estimate_uncertainty)
    sphere = Sphere(radius, gap)
    pressed = sphere.indenter(load, approach, edge_correction)
    half_width = numbers.FILL * _contact_radius(radius, pressed, body, numerics)
    levels, estimate = _refined(pressed, half_width, body, numerics, estimate_uncertainty)
    solution = Solution.of_levels(levels[-3:], body, estimate, began)
    if levels[-1].shape is None:
        return solution
    beside = [one for one in levels[-2::-1] if one.shape and one.grid.n <= numbers.BESIDE_GRID]
    error = estimate.approach if estimate else None
    of = beside or levels[-1:], levels[-1].load, solution.approach, error
    return replace(solution, neighbours=Neighbours(sphere, *of, body, numerics))


def _refined(
    indenter: Indenter,
    half_width: float,
    body: Body,
    numerics: Numerics,
    estimate_uncertainty: bool,
    most: int = numbers.BESIDE_GRID,
) -> tuple[list[Level], Uncertainty | None]:
    """Levels of a refinement study, further ones until the uncertainty meets the accuracy, and that of the
    last.

    most : patches a side of the last grid of a contact that is no disc.
    """
    levels = nested.levels(half_width, indenter, body, numerics, estimate_uncertainty)
    if touches_rim(levels[-1].found.pressure, levels[-1].grid.quarter):
        raise _at_rim(half_width)
    if not estimate_uncertainty:
        return levels, None
    estimate = uncertainty.of_contact(levels, indenter, body, numerics)
    # patches alone under another shape than a sphere converge too slowly for it
    smooth = indenter.edge_correction and (indenter.round or levels[-1].shape is not None)
    accuracy = numerics.accuracy if smooth else None
    reached: list[float] = []
    while accuracy and not uncertainty.is_met(accuracy, estimate, levels):
        last = levels[-1].grid
        n = odd(numbers.FINER * last.n)
        reached.append(estimate.relative_to(levels[-1].scalars))
        stalled = uncertainty.is_stalled(accuracy, reached, levels)
        largest = numbers.LARGEST_GRID // 2 + 1 if stalled else numbers.LARGEST_GRID
        if n > (largest if indenter.round else most):
            break
        grid = replace(last, n=n, d=2 * last.half_width / n)
        try:
            levels.append(nested.solve_on(grid, levels[-1], indenter, body, numerics))
        except NotConverged:  # the last solution states what it reached
            break
        estimate = uncertainty.of_contact(levels, indenter, body, numerics)
    return levels, estimate


def _at_rim(half_width: float) -> NotConverged:
    return NotConverged(
        f"the contact reaches the rim of the square, half_width = {half_width:g} m; widen it, level a tilted "
        "profile(x, y), turn over one that is upside down (it rises away from the flat), or check the moduli"
    )


def _shaped(
    indenter: Indenter, half_width: float, body: Body, numerics: Numerics, estimate_uncertainty: bool
) -> Solution:
    """Press an indenter over a square ``FILL`` times as wide as its contact, which coarse grids find.

    A contact that is more than ``LONG`` times as long as wide has as many times more patches a side; only
    those of the window around it are used.
    """
    rough, coarse = (
        replace(indenter, edge_correction=False),
        replace(numerics, patches=numbers.ROUGH, tolerance=1e-4),
    )
    for _ in range(20):
        try:
            found = _pressed(rough, half_width, body, coarse, estimate_uncertainty=False)
        except NotConverged:
            half_width *= 1.5
            continue
        loaded = np.argwhere(found.patch_pressure > 0)
        sides = np.ptp(loaded, axis=0) + 1
        extent = float(np.abs(found.nodes[loaded]).max()) + found.diagnostics.patch_size
        if extent <= half_width / 3:
            half_width = numbers.ROOMY * extent
        elif sides.min() < numbers.PATCHES_A_WIDTH and coarse.patches < numbers.LARGEST_GRID / numbers.FINER:
            coarse = replace(coarse, patches=odd(2 * coarse.patches))
        else:
            ratio = sides.max() / sides.min()
            more = max(1.0, ratio / numbers.LONG)
            finer = replace(numerics, patches=min(odd(more * numerics.patches), numbers.LARGEST_GRID))
            most = min(int(more * numbers.BESIDE_GRID), numbers.LARGEST_GRID)
            pressed = _pressed(indenter, numbers.FILL * extent, body, finer, estimate_uncertainty, most)
            across = int(np.ptp(np.argwhere(pressed.patch_pressure > 0), axis=0).min()) + 1
            if across < numbers.RESOLVED_WIDTH:
                raise NotConverged(
                    f"the contact is {ratio:.0f} times as long as wide: {across} patches across, at least "
                    f"{numbers.RESOLVED_WIDTH} are needed; raise patches, to {numbers.LARGEST_GRID} at most, "
                    "or take radii that differ less"
                )
            return pressed
    raise NotConverged(f"no contact within {half_width:g} m carries the load; check the indenter")


def _contact_radius(radius: float, sphere: Indenter, body: Body, numerics: Numerics) -> float:
    """Contact radius [m] to a few per cent, on a coarse grid of patches alone."""
    a = hertz_radius(radius, sphere.load, sphere.approach, body)
    coarse = replace(numerics, tolerance=max(1e-3, numerics.tolerance))
    pressed = replace(sphere, edge_correction=False)
    for _ in range(20):
        grid = Grid(numbers.ROUGH, 2 * numbers.ROOMY * a / numbers.ROUGH)
        level = nested.solve_on(grid, None, pressed, body, coarse)
        found = level.radius
        if found > numbers.LARGEST * radius:
            raise ValueError(
                f"contact radius a = {found:g} m is {found / radius:.2g} of the sphere's radius; "
                f"the parabolic gap and small strains hold below {numbers.LARGEST:g}, and well below 0.1"
            )
        if touches_rim(level.found.pressure, level.grid.quarter):
            a = 2 * a
        elif found < 0.5 * a:
            a = found
        else:
            return found
    raise NotConverged(f"no contact radius near {a:g} m carries the load; check the moduli")


def indent(
    *,
    profile: Callable[[Array, Array], Array],
    half_width: float,
    load: float | None,
    coatings: Coatings,
    substrate: Substrate,
    friction: float = 0.0,
    ball: Ball | None = None,
    approach: float | None = None,
    patches: int = 257,
    tolerance: float = 1e-8,
    max_iterations: int = 600,
    conversion: str = "split",
    edge_correction: bool = True,
    estimate_uncertainty: bool = True,
    threads: int = 1,
) -> Solution:
    """Press an indenter of any shape into a coated half-space, over a fixed square.

    profile : height of the indenter's surface above its lowest point [m], as z(x, y) of arrays x, y [m].
    half_width : half the side of the square [m]; no contact beyond it.  load [N] or approach [m], the
    other None; the approach counts from the first touch.  ball : of an elastic indenter, a half-space near
    the contact.  The others as in ``solve``.

    An ellipsoid x^2/2A + y^2/2B, a cone, a punch with a round edge are profiles; contact_radius
    is that of the disc with the contact's area.
    edge_correction : for the square root of the pressure at a smooth edge (``edge_correction``), wherever
    the pressure shows one: ellipses of axes up to 5 : 1 on 257 patches within 4e-6 in peak pressure. Where
    it shows none, under a rough surface, at a corner, or with False: patches alone, of first order at the
    edge.

    Heights that are even in x and in y to the last digit are solved on a quarter of the square.

    Raises ValueError for input without meaning, NotConverged when the iteration stops short.
    """
    check_control(load, approach)
    check_positive(half_width=half_width)
    check_truth_value(edge_correction=edge_correction)
    body = _body(coatings, substrate, friction, ball)
    numerics = Numerics(patches, tolerance, max_iterations, conversion, threads)
    indenter = _of_profile(profile, load, approach, edge_correction)
    heights = indenter.gap(Grid(numerics.patches, 2 * half_width / numerics.patches))
    if heights.min() < heights[1:-1, 1:-1].min():
        raise _at_rim(half_width)
    return _pressed(indenter, half_width, body, numerics, estimate_uncertainty)


def _of_profile(
    profile: Callable[[Array, Array], Array],
    load: float | None,
    approach: float | None,
    edge_correction: bool,
) -> Indenter:
    def on_mesh(x: Array, y: Array) -> Array:
        return np.asarray(profile(x[:, None], y[None, :]), dtype=np.float64)

    def gap(grid: Grid) -> Array:
        z = np.broadcast_to(on_mesh(grid.x, grid.x), (grid.n, grid.n))
        if not np.isfinite([z.min(), z.max()]).all():
            raise ValueError("profile(x, y) must return finite heights [m] all over the square")
        return z

    return Indenter(gap, load, approach, round=False, edge_correction=edge_correction, between=on_mesh)


def _pressed(
    indenter: Indenter,
    half_width: float,
    body: Body,
    numerics: Numerics,
    estimate_uncertainty: bool,
    most: int = numbers.BESIDE_GRID,
) -> Solution:
    began = time.perf_counter()
    levels, estimate = _refined(indenter, half_width, body, numerics, estimate_uncertainty, most)
    return Solution.of_levels(levels[-3:], body, estimate, began)


def solve_prescribed(
    *,
    pressure: float | Callable[[Array], Array],
    load_radius: float,
    coatings: Coatings,
    substrate: Substrate,
    friction: float = 0.0,
    patches: int = 257,
    conversion: str = "split",
    estimate_uncertainty: bool = True,
) -> Solution:
    """Load a disc of ``load_radius`` [m] with a known pressure: no contact, the same fields.

    pressure : a uniform one [Pa], or p(r) [Pa] of an array r <= load_radius [m].  The others as in ``solve``.
    The solution's contact_radius is load_radius, its approach the displacement u_z at the origin.

    Raises ValueError for input without meaning.
    """
    began = time.perf_counter()
    check_positive(load_radius=load_radius)
    body = _body(coatings, substrate, friction)
    numerics = Numerics(patches, conversion=conversion)
    check_odd(patches)
    if not callable(pressure):
        check_finite(pressure=pressure)
        pressure = partial(np.full_like, fill_value=float(pressure))
    shape = prescribed.Prescribed(load_radius, pressure)
    shape.refuse_inner_jump()

    def level(n: int, wider: float, numerics: Numerics) -> Level:
        return _loaded(Grid(odd(wider * n), 2.04 * load_radius / n), shape, body, numerics)

    if not estimate_uncertainty:
        return Solution.of_levels([level(patches, 1, numerics)], body, None, began)
    sizes = [odd(patches / 4), odd(patches / 2), patches]
    levels = [level(n, 1, numerics) for n in sizes]
    half = levels[1].scalars
    variations = {
        name: {scalar: abs(varied.scalars[scalar] - value) for scalar, value in half.items()}
        for name, varied in (
            ("conversion", level(sizes[1], 1, uncertainty.other_conversion(numerics))),
            ("domain", level(sizes[1], numbers.FINER, numerics)),
        )
    }
    estimate = Uncertainty.from_levels(levels[::-1], variations)
    return Solution.of_levels(levels, body, estimate, began)


def _loaded(grid: Grid, shape: prescribed.Prescribed, body: Body, numerics: Numerics) -> Level:
    """Deflection under a prescribed pressure, as a contact without iteration."""
    kernel = influence.surface_coefficients(grid.n, grid.d, body, numerics)
    deflection = convolution.even_convolution(kernel, threads=numerics.threads)
    found = contact.Contact.of_load(shape.pressure(grid.radius))
    level = Level(grid, found, shape.load, 1, given=shape)
    u = deflection(prescribed.deconvolve(level.mean))
    centre = float(u[grid.n // 2, grid.n // 2])
    return replace(level, found=replace(found, gap=u - centre, approach=centre))


def _body(coatings: Coatings, substrate: Substrate, friction: float, ball: Ball | None = None) -> Body:
    Body(coatings, substrate, friction)  # refuses what is no number before it is made one
    opposite = None if ball is None else _ball(ball, friction)
    layers = tuple((float(E), float(nu), float(h)) for E, nu, h in coatings)
    E, nu = substrate
    return Body(layers, (float(E), float(nu)), float(friction), opposite)


def _ball(ball: Ball, friction: float) -> Body:
    given = Body.of_ball(ball, friction)
    return _body(given.coatings, given.substrate, given.friction)
