"""Public entry of the semi-analytical method.

Physical keywords in, ``Solution`` out. Only this file knows all the others: it builds the influence
coefficients of the coated solid, presses the indenter on a sequence of ever finer grids, and keeps
the coarser results, because they are the ladders that its uncertainty is read from.

Assumed: small strains, perfect bond, the sphere's parabola, Coulomb friction q = f p that leaves p unchanged.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from semianalytic import contact, convolution, disc, frf, halfspace, influence, subsurface
from semianalytic import profile as edge_profile
from semianalytic.contact import NotConverged
from semianalytic.grid import Grid, Window, carry_over, odd, refine, sharpen, touches_rim, window_around
from semianalytic.inputs import COARSEST, Body, Numerics, check_control, check_positive
from semianalytic.solution import Diagnostics, Solution, Uncertainty

__all__ = ["Diagnostics", "NotConverged", "Solution", "Uncertainty", "indent", "solve", "solve_prescribed"]

Array = NDArray[np.floating]
Coatings = tuple[tuple[float, float, float], ...]
Substrate = tuple[float, float]
Press = Callable[
    [Array | float, float, "Level | None", float], "Level"
]  # (defect, missing, start, tolerance)

USUAL, MOST = 257, 513  # patches a side
PER_COATING = 12  # patches that the pressure needs to follow a coating at the contact edge
WIDER = 1.25  # the box of the domain ladder over the box in use
SKIPS = (2.5, 1.5, 1.0)  # patches inside the edge that the profile is not fitted to, round by round
FINE = 8  # patches; stresses nearer to the surface are found from patches of half the side


@dataclass(frozen=True)
class Indenter:
    """Undeformed gap on a grid, and either the load [N] or the approach [m].

    round : axisymmetric with a smooth edge, which can be corrected; table : what that takes under a coating,
    coarse_table : a poorer one, where the coating is too thin for the better one to be perfect.
    """

    gap: Callable[[Grid], Array]
    load: float | None
    approach: float | None
    round: bool
    table: disc.LayerTable | None = None
    coarse_table: disc.LayerTable | None = None


@dataclass(frozen=True)
class Level:
    """A contact on one grid; the profile is what its edge was corrected with."""

    grid: Grid
    found: contact.Contact
    shape: edge_profile.Profile | edge_profile.Prescribed | None
    load: float
    convolutions: int

    @property
    def radius(self) -> float:
        if self.shape is not None:
            return self.shape.radius
        return float(np.sqrt(np.count_nonzero(self.found.pressure) / np.pi) * self.grid.d)

    @property
    def scalars(self) -> dict[str, float]:
        return {
            "contact_radius": self.radius,
            "approach": self.found.approach,
            "peak_pressure": float(self.found.pressure.max()),
        }

    @cached_property
    def mean(self) -> Array:
        """Pressure averaged over the patches [Pa], those the edge cuts included: the whole load."""
        return self._mean_on(self.grid)

    @cached_property
    def finer(self) -> tuple[Grid, Array]:
        """A grid of half the patch size, and the pressure averaged over its patches."""
        grid = Grid(2 * self.grid.n - 1, self.grid.d / 2)
        return grid, self._mean_on(grid)

    def _mean_on(self, grid: Grid) -> Array:
        p, f = self.found.pressure, self.shape
        if f is None:
            return p
        rest = p - f.pressure(self.grid.radius)
        if grid.n != self.grid.n:
            rest = np.where(grid.radius < f.radius, refine(rest, self.grid, grid), 0.0)
        return rest + edge_profile.patch_mean(f, grid.x, grid.d)


def solve(
    *,
    radius: float,
    load: float | None,
    coatings: Coatings,
    substrate: Substrate,
    friction: float = 0.0,
    approach: float | None = None,
    patches: int | None = None,
    tolerance: float = 1e-8,
    max_iterations: int = 600,
    conversion: str = "split",
    hankel_points: int = 4096,
    enlarge: int = 4,
    fill: float = 1.12,
    edge_rounds: int = 3,
    estimate_uncertainty: bool = True,
    threads: int = 1,
) -> Solution:
    """Press a rigid sphere of ``radius`` [m] with ``load`` [N] on a coated half-space.

    coatings ((E, nu, thickness), ...) from the surface down; substrate (E, nu); friction f in q = f p.
    approach : delta [m] instead of the load, which then is None.
    patches : per side of the finest grid, odd; None takes 257, or up to 513 where a first coating is thin
    enough to need them. The other numerics: ``inputs.Numerics``; the conversions: ``influence``. The
    correction of the edge (edge_rounds > 0) takes the error of a poor conversion away with its own.

    Raises ValueError for input without meaning, NotConverged when the iteration stops short.
    """
    began = time.perf_counter()
    check_control(load, approach)
    check_positive(radius=radius)
    body = _body(coatings, substrate, friction)
    numerics = Numerics(
        patches=patches or USUAL,
        tolerance=tolerance,
        max_iterations=max_iterations,
        conversion=conversion,
        hankel_points=hankel_points,
        enlarge=enlarge,
        fill=fill,
        edge_rounds=edge_rounds,
        threads=threads,
    )
    sphere = Indenter(lambda grid: grid.radius**2 / (2 * radius), load, approach, round=True)
    if load is not None:
        largest = (0.75 * load * radius / min(body.moduli)) ** (1 / 3)  # Hertz on the softest material
    else:
        assert approach is not None
        largest = (2 * radius * approach) ** 0.5  # the sphere's section at the surface
    first = _find_contact(fill * largest, sphere, body, numerics)
    half_width = fill * first.radius
    if coatings and edge_rounds:
        reach = 1.01 * 2**0.5 * WIDER * half_width
        geometry = (_excess(body), body.thickness[0], first.radius, reach)
        table = coarse = disc.layer_table(*geometry)
        if estimate_uncertainty and table.k[-1] * first.radius > disc.CYCLES / 2:
            coarse = disc.layer_table(*geometry, cycles=disc.CYCLES / 2)
        sphere = replace(sphere, table=table, coarse_table=coarse)
    if patches is None and coatings:
        resolved = odd(PER_COATING * 2 * half_width / body.thickness[0])
        numerics = replace(numerics, patches=min(max(USUAL, resolved), MOST))
    return _refine(half_width, first, sphere, body, numerics, estimate_uncertainty, began)


def indent(
    *,
    profile: Callable[[Array, Array], Array] | Array,
    half_width: float,
    load: float | None,
    coatings: Coatings,
    substrate: Substrate,
    friction: float = 0.0,
    approach: float | None = None,
    patches: int = 257,
    tolerance: float = 1e-8,
    max_iterations: int = 600,
    conversion: str = "split",
    hankel_points: int = 4096,
    enlarge: int = 4,
    estimate_uncertainty: bool = True,
    threads: int = 1,
) -> Solution:
    """Press a rigid indenter of any shape into a coated half-space, over a fixed square.

    profile : height of the indenter's surface above its lowest point [m], as z(x, y) of arrays x, y [m], or
    as an (n, n) array at the centres of n x n patches that fill the square, in place of ``patches``.
    half_width : half the side of the square [m]; no contact beyond it.  load [N] or approach [m], the
    other None; the approach counts from the first touch.  The others as in ``solve``.

    An ellipsoid x^2/2A + y^2/2B, a cone, a punch with a round edge, a measured surface are profiles. Unlike
    the sphere's, the edge of their contact stays a staircase, where the pressure is of first order in the
    patch size; contact_radius is that of the disc with the contact's area.

    Raises ValueError for input without meaning, NotConverged when the iteration stops short.
    """
    began = time.perf_counter()
    check_control(load, approach)
    check_positive(half_width=half_width)
    body = _body(coatings, substrate, friction)
    heights = None if callable(profile) else np.asarray(profile, dtype=float)
    if heights is not None:
        patches = heights.shape[0]
        if heights.shape != (patches, patches) or not np.all(np.isfinite(heights)):
            raise ValueError(f"profile of shape {heights.shape}; give finite heights on n x n patches")
    numerics = Numerics(
        patches=patches,
        tolerance=tolerance,
        max_iterations=max_iterations,
        conversion=conversion,
        hankel_points=hankel_points,
        enlarge=enlarge,
        edge_rounds=0,
        threads=threads,
    )

    def gap(grid: Grid) -> Array:
        if heights is not None:
            z = grid.sample(heights, half_width)
        else:
            assert callable(profile)
            z = np.asarray(profile(grid.x[:, None], grid.x[None, :]), dtype=float)
            z = np.broadcast_to(z, (grid.n, grid.n))
            if not np.isfinite(z.min()) or not np.isfinite(z.max()):
                raise ValueError("profile(x, y) must return finite heights [m] all over the square")
        return z - z.min()

    indenter = Indenter(gap, load, approach, round=False)
    solution = _refine(half_width, None, indenter, body, numerics, estimate_uncertainty, began)
    if heights is None and touches_rim(solution.patch_pressure):
        raise NotConverged(
            f"the contact reaches the rim of the square, half_width = {half_width:g} m; widen it, or give "
            "the profile as an array if it has no surface beyond"
        )
    return solution


def solve_prescribed(
    *,
    pressure: float | Callable[[Array], Array],
    load_radius: float,
    coatings: Coatings,
    substrate: Substrate,
    friction: float = 0.0,
    patches: int = 257,
    conversion: str = "split",
    hankel_points: int = 4096,
    enlarge: int = 4,
    estimate_uncertainty: bool = True,
    threads: int = 1,
) -> Solution:
    """Load a disc of ``load_radius`` [m] with a known pressure: no contact, the same fields.

    pressure : a uniform one [Pa], or p(r) [Pa] of an array r <= load_radius [m].  The others as in ``solve``.
    The solution's contact_radius is load_radius, its approach the displacement u_z at the origin.

    Raises ValueError for input without meaning.
    """
    began = time.perf_counter()
    check_positive(load_radius=load_radius)
    body = _body(coatings, substrate, friction)
    numerics = Numerics(
        patches=patches, conversion=conversion, hankel_points=hankel_points, enlarge=enlarge, threads=threads
    )
    if not callable(pressure):
        if not np.isfinite(pressure):
            raise ValueError(f"pressure = {pressure:g}; give a finite one [Pa], or a function of r")
        pressure = partial(_uniform, float(pressure))
    shape = edge_profile.Prescribed(load_radius, pressure)

    def level(n: int, wider: float, numerics: Numerics) -> Level:
        return _loaded(Grid(odd(wider * n), 2.04 * load_radius / n), shape, body, numerics)

    sizes = [odd(patches / 4), odd(patches / 2), patches] if estimate_uncertainty else [patches]
    ladder = [level(n, 1, numerics) for n in sizes]
    solution = None
    for one in ladder:
        solution = _as_solution(one, solution, body)
    assert solution is not None
    if estimate_uncertainty:
        coarser = _other_conversion(numerics)
        knobs = {
            "conversion": level(sizes[1], 1, coarser).scalars,
            "domain": level(sizes[1], WIDER, numerics).scalars,
        }
        fine, half, quarter = (one.scalars for one in ladder[::-1])
        stated = Uncertainty.from_ladders(fine, half, quarter, knobs, base=half, ratio=2.0)
        solution = replace(solution, uncertainty=stated)
    seconds = time.perf_counter() - began
    return replace(solution, diagnostics=replace(solution.diagnostics, seconds=seconds))


def _uniform(value: float, r: Array) -> Array:
    return np.full(np.shape(r), value)


def _loaded(grid: Grid, shape: edge_profile.Prescribed, body: Body, numerics: Numerics) -> Level:
    """Deflection under a prescribed pressure, as a contact that took no iteration."""
    deflection = convolution.even_convolution(_coefficients(grid, body, numerics), threads=numerics.threads)
    found = contact.Contact.of_load(shape.pressure(grid.radius))
    level = Level(grid, found, shape, shape.load, 1)
    u = deflection(sharpen(level.mean))
    centre = float(u[grid.n // 2, grid.n // 2])
    return replace(level, found=replace(found, gap=u - centre, approach=centre))


def _refine(
    half_width: float,
    first: Level | None,
    indenter: Indenter,
    body: Body,
    numerics: Numerics,
    estimate_uncertainty: bool,
    began: float,
) -> Solution:
    """Contacts on .., N/4, N/2 and N patches a side, each started from the one before.

    Where the edge is corrected the error falls fast: half the patches would say little of it, N/sqrt(2)
    patches, with fewer terms of the edge profile in proportion, are held against N.
    """
    sizes = [numerics.patches]
    while sizes[0] > 2 * COARSEST or len(sizes) < 3:
        sizes.insert(0, odd(sizes[0] / 2))
    if estimate_uncertainty and numerics.edge_rounds:
        sizes.insert(-1, odd(sizes[-1] / 2**0.5))
    ladder = []
    level = first
    kept = 3 if estimate_uncertainty else 1
    starter = replace(numerics, tolerance=max(1e-5, numerics.tolerance), edge_rounds=0)
    for k, n in enumerate(sizes):
        used = replace(numerics, edge_terms=n / numerics.patches) if k >= len(sizes) - kept else starter
        level = _press(Grid(n, 2 * half_width / n), level, indenter, body, used)
        ladder.append(level)
    solution = None
    for level in ladder[-3:] if estimate_uncertainty else ladder[-1:]:
        solution = _as_solution(level, solution, body)
    assert solution is not None
    if estimate_uncertainty:
        solution = replace(solution, uncertainty=_uncertainty(ladder, indenter, body, numerics))
    seconds = time.perf_counter() - began
    return replace(solution, diagnostics=replace(solution.diagnostics, seconds=seconds))


def _find_contact(half_width: float, indenter: Indenter, body: Body, numerics: Numerics) -> Level:
    """Contact on a coarse grid that fits it, found by following it from a grid that may not."""
    rough = replace(numerics, tolerance=max(1e-4, numerics.tolerance), edge_rounds=0)
    for _ in range(12):
        grid = Grid(COARSEST, 2 * half_width / COARSEST)
        level = _press(grid, None, indenter, body, rough)
        a = level.radius
        if touches_rim(level.found.pressure):
            half_width *= 1.5  # a contact that runs into the rim hides its size
        elif numerics.fill * a > 0.75 * half_width:
            return level
        else:
            half_width = numerics.fill * max(a, 1.5 * grid.d)
    raise NotConverged(
        f"no grid was found that fits the contact, last half-width {half_width:.3g} m; "
        "the moduli of the layers may lie too far apart"
    )


def _press(grid: Grid, before: Level | None, indenter: Indenter, body: Body, numerics: Numerics) -> Level:
    """Contact on a grid: of a sphere its edge corrected, of another indenter on the window it needs."""
    whole = Window(0, grid.n, 0, grid.n)
    gap = indenter.gap(grid)
    if indenter.round:
        return _press_round(grid, gap, before, indenter, body, numerics)
    depth = float(np.ptp(gap))
    if before is not None:
        window = window_around(before.found.pressure, before.grid, grid)
        if window.shape != whole.shape:
            lowest, gap = _lowest_of_four(gap), gap[window.slices].copy()
            press = _press_in(grid, gap, depth, window, before, indenter, body, numerics)[0]
            level = press(0.0, 0.0, None, numerics.tolerance)
            del press  # the memory of its transforms is needed again
            level = replace(level, found=level.found.embedded(window.slices, grid.n, depth))
            if _is_alone(level, lowest, window, body, numerics):
                return level
            gap = indenter.gap(grid)
    press = _press_in(grid, gap, depth, whole, before, indenter, body, numerics)[0]
    return press(0.0, 0.0, None, numerics.tolerance)


def _press_round(
    grid: Grid, gap: Array, before: Level | None, indenter: Indenter, body: Body, numerics: Numerics
) -> Level:
    """Contact with its edge corrected.

    What constant patches make of the square root at the edge is measured on the fitted profile, whose exact
    deflection is known, and added to the gap; the profile is fitted anew to the pressure that results.
    """
    whole, depth = Window(0, grid.n, 0, grid.n), float(np.ptp(gap))
    press, deflection = _press_in(grid, gap, depth, whole, before, indenter, body, numerics)
    rounds = numerics.edge_rounds
    level = press(0.0, 0.0, None, max(numerics.tolerance, 1e-5) if rounds else numerics.tolerance)
    thickness = body.thickness[0] if body.coatings else None
    share = numerics.edge_terms
    fit = partial(edge_profile.of_contact, r=grid.radius, d=grid.d, thickness=thickness, share=share)
    shape = None
    for k in range(rounds):
        shape = fit(level.found.pressure, skip=SKIPS[min(k, len(SKIPS) - 1)])
        if shape is None:
            return press(0.0, 0.0, level, numerics.tolerance)
        on_patches = shape.pressure(grid.radius)
        missing = shape.load - float(on_patches.sum() * grid.d**2)
        exact = disc.deflection(shape.radius, shape.coefficients, body.moduli[0], indenter.table, grid.radius)
        tolerance = numerics.tolerance if k == rounds - 1 else max(numerics.tolerance, 1e-6)
        level = press(exact - deflection(on_patches), missing, level, tolerance)
    if shape is not None:
        shape = fit(level.found.pressure, skip=SKIPS[-1])
    return replace(level, shape=shape)


def _press_in(
    grid: Grid,
    gap: Array,
    depth: float,
    window: Window,
    before: Level | None,
    indenter: Indenter,
    body: Body,
    numerics: Numerics,
) -> tuple[Press, Callable[[Array], Array]]:
    """Function that presses the indenter on a window of the grid, and the deflection u = A p there.

    gap [m] : on the window.  depth [m] : the largest gap on the grid.
    defect [m] : added to the gap.  missing [N] : load that the patches do not carry.  start : level on the
    same window, None to start from ``before``.
    """
    n = max(window.shape)
    kernel = _coefficients(Grid(n, grid.d), body, numerics)[: window.shape[0], : window.shape[1]]
    deflection = convolution.even_convolution(kernel, threads=numerics.threads)
    precondition = convolution.circulant_inverse(kernel, threads=numerics.threads)
    del kernel

    def press(defect: Array | float, missing: float, level: Level | None, tolerance: float) -> Level:
        spent = 0
        if level is not None:
            start, spent = level.found.pressure, level.convolutions + 1
        elif before is not None:
            start = carry_over(
                before.found.pressure, before.found.gap, before.grid, grid, window, body.moduli[0]
            )
        else:
            start = precondition(np.maximum(gap.min() + (indenter.approach or 0.25 * depth) - gap, 0))
        found = contact.press(
            deflection,
            gap + defect,
            total=None if indenter.load is None else (indenter.load - missing) / grid.d**2,
            approach=indenter.approach,
            start=start,
            precondition=precondition,
            scale=indenter.approach or (before.found.approach if before else depth),
            tolerance=tolerance,
            max_iterations=numerics.max_iterations,
            reach=_reach(body, grid.d),
        )
        load = float(found.pressure.sum() * grid.d**2) + missing
        return Level(grid, found, None, load, spent + found.convolutions)

    return press, deflection


def _reach(body: Body, d: float) -> float:
    """Patches over which the residual is continued: fewer where a stiff coating is a few patches thick.

    Measured: a third of it takes four iterations in place of five where E1/E2 = 10, h = 3 d.
    """
    if not body.coatings or body.moduli[0] <= body.moduli[1]:
        return contact.REACH
    return min(contact.REACH, max(1.0, 0.3 * body.thickness[0] / d))


def _lowest_of_four(gap: Array) -> Array:
    """Smallest gap on patches of twice the side."""
    if len(gap) % 2:
        gap = np.pad(gap, (0, 1), mode="edge")
    rows = np.minimum(gap[::2], gap[1::2])
    return np.minimum(rows[:, ::2], rows[:, 1::2])


def _is_alone(level: Level, lowest: Array, window: Window, body: Body, numerics: Numerics) -> bool:
    """Whether nothing but the window is in contact: its rim is free, and the gap beyond it open.

    The deflection beyond is found from patches of twice the side, which at the distance of the window's
    margin is good to 1e-3 of what they add; the smallest gap of the four, ``lowest``, stands for them.
    """
    p = level.found.pressure
    if touches_rim(p[window.slices]):
        return False
    if level.grid.n % 2:
        p = np.pad(p, (0, 1))
    rows = p[::2] + p[1::2]
    merged = (rows[:, ::2] + rows[:, 1::2]) / 4
    del rows
    kernel = _coefficients(Grid(len(lowest), 2 * level.grid.d), body, numerics)
    g = lowest + convolution.even_convolution(kernel, threads=numerics.threads)(merged) - level.found.approach
    g[window.i0 // 2 : -(-window.i1 // 2), window.j0 // 2 : -(-window.j1 // 2)] = np.inf
    return bool(g.min() > 0)


def _excess(body: Body) -> Callable[[Array], Array]:
    return lambda k: frf.compliance_excess(k, body.coatings, body.substrate)


def _coefficients(grid: Grid, body: Body, numerics: Numerics) -> Array:
    """Influence coefficients K [m/Pa] of the surface displacement, shape (n, n)."""
    n, d = grid.n, grid.d
    scale = 1 / (np.pi * body.moduli[0])
    excess = _excess(body)
    options = {"threads": numerics.threads}
    if numerics.conversion == "plain":
        return scale * influence.plain_coefficients(n, d, excess, enlarge=numerics.enlarge, **options)
    C = halfspace.surface_deflection(n, n, d, d)
    if body.coatings:
        image = influence.split_image(excess, body.thickness)
        C += image[0] * halfspace.surface_deflection(n, n, d, d, image[1])
        enlarge = numerics.enlarge if numerics.conversion == "split-fft" else 0
        C += influence.remainder_coefficients(
            n, d, excess, body.thickness, image, points=numerics.hankel_points, enlarge=enlarge, **options
        )
    return scale * C


def _as_solution(level: Level, coarser: Solution | None, body: Body) -> Solution:
    grid, found = level.grid, level.found
    beyond = max(int(np.ceil((2.05 * level.radius - grid.x[-1]) / grid.d)), 0)
    common: dict[str, Any] = {
        "friction": body.friction,
        "coatings": body.coatings,
        "substrate": body.substrate,
    }

    elastic: dict[str, Any] = {
        "rectangle": (halfspace.normal_stress, halfspace.tangential_stress),
        "stress_frf": frf.stress_frf,
    }

    motion: dict[str, Any] = {
        "rectangle": (halfspace.normal_displacement, halfspace.tangential_displacement),
        "displacement_frf": frf.displacement_frf,
    }

    def stress(x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None) -> Array:
        evaluate: Callable[..., Array] = partial(subsurface.stress, **elastic, **common)
        x, y, z, where = np.broadcast_arrays(x, y, z, body.layer_of(z, layer))
        result = np.empty((3, 3, *z.shape))
        near = (z < FINE * grid.d) & (level.shape is not None)
        for part, fine in ((near, True), (~near, False)):
            if part.any():
                patches, p = level.finer if fine else (grid, level.mean)
                result[..., part] = evaluate(
                    x[part], y[part], z[part], where[part], grid_x=patches.x, grid_y=patches.x, pressure=p
                )
        return result

    def plane(z: float, layer: int | None) -> Array:
        at_depth = subsurface.stress_plane(
            z, int(body.layer_of(z, layer)), grid_x=grid.x, grid_y=grid.x, **elastic, **common
        )
        xx, yy, zz, xy, xz, yz = at_depth(level.mean)
        return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])

    def displacement_plane(z: float) -> Array:
        return subsurface.displacement_plane(
            z, int(body.layer_of(z, None)), grid_x=grid.x, grid_y=grid.x, **motion, **common
        )(level.mean)

    def displacement(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        return subsurface.displacement(
            x,
            y,
            z,
            body.layer_of(z, None),
            grid_x=grid.x,
            grid_y=grid.x,
            pressure=level.mean,
            **motion,
            **common,
        )

    return Solution(
        **level.scalars,
        surface_nodes=grid.x[0] + grid.d * np.arange(-beyond, grid.n + beyond),
        diagnostics=Diagnostics(
            iterations=found.iterations,
            convolutions=level.convolutions,
            gap_inside=found.gap_inside,
            penetration_outside=found.penetration_outside,
            load_error=found.load_error,
            load=level.load,
            patches=int(np.count_nonzero(found.pressure)),
            patches_per_side=grid.n,
            patch_size=grid.d,
            seconds=0.0,
            history=found.history,
        ),
        uncertainty=None,
        nodes=grid.x,
        patch_pressure=found.pressure,
        coarser=coarser,
        _profile=None if level.shape is None else level.shape.pressure,
        _stress=stress,
        _plane=plane,
        _displacement_plane=displacement_plane,
        _displacement=displacement,
    )


def _uncertainty(ladder: list[Level], indenter: Indenter, body: Body, numerics: Numerics) -> Uncertainty:
    """One ladder per knob; all but the patch size on the coarsest grid of its ladder, from the same start."""
    fine, middle, coarse = (level.scalars for level in ladder[:-4:-1])
    grid, start = ladder[-3].grid, ladder[-4] if len(ladder) > 3 else None
    numerics = replace(numerics, edge_terms=grid.n / numerics.patches)
    looser = replace(numerics, tolerance=min(100 * numerics.tolerance, 1e-2))
    wider = Grid(odd(WIDER * grid.n), grid.d)
    poorer = replace(indenter, table=indenter.coarse_table)
    knobs = {
        "conversion": _press(grid, start, poorer, body, _other_conversion(numerics)).scalars,
        "domain": _press(wider, start, indenter, body, numerics).scalars,
        "iteration": _press(grid, start, indenter, body, looser).scalars,
    }
    ratio = numerics.patches / ladder[-2].grid.n
    stated = Uncertainty.from_ladders(fine, middle, coarse, knobs, base=coarse, ratio=ratio)
    if indenter.round and body.coatings:
        # the layer that a coating thinner than the patches bends the pressure in is on no grid of the ladder
        h, d = body.thickness[0], ladder[-1].grid.d
        unseen = 0.3 * h / ladder[-1].radius * max(0.0, 1 - h / (4 * d))
        if unseen:
            powers = {"contact_radius": 1, "approach": 2, "peak_pressure": 2}
            rows = [(name, "coating", unseen**power * fine[name]) for name, power in powers.items()]
            stated = stated.extended(rows)
    return stated


def _other_conversion(numerics: Numerics) -> Numerics:
    """What a conversion is held against: on half its points, or the better one where there is one."""
    if numerics.conversion == "split":
        return replace(numerics, hankel_points=numerics.hankel_points // 2)
    return replace(numerics, conversion="split")


def _body(coatings: Coatings, substrate: Substrate, friction: float) -> Body:
    layers = tuple(tuple(float(v) for v in coating) for coating in coatings)
    return Body(layers, tuple(float(v) for v in substrate), float(friction))  # type: ignore[arg-type]
