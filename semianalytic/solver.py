"""Public entry of the semi-analytical method.

Physical keywords in, ``Solution`` out. Only this file knows all the others: it builds the influence
coefficients of the coated solid, presses the indenter on a sequence of ever finer grids, and keeps
the coarser results, because they are the ladders that its uncertainty is read from.

Assumed: small strains, perfect bond, the sphere's parabola, Coulomb friction q = f p that leaves p unchanged.
"""

import time
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from semianalytic import contact, convolution, edge, frf, halfspace, influence, subsurface
from semianalytic.contact import NotConverged
from semianalytic.grid import Grid, carry_over, odd
from semianalytic.solution import Diagnostics, Solution, Uncertainty

__all__ = ["Diagnostics", "NotConverged", "Solution", "Uncertainty", "solve"]

Array = NDArray[np.floating]
Coatings = tuple[tuple[float, float, float], ...]
Substrate = tuple[float, float]

COARSEST = 33  # patches a side of the grid that finds the contact
WIDER = 1.25  # the box of the domain ladder over the box in use


@dataclass(frozen=True)
class Numerics:
    """The knobs; each has a ladder of its own."""

    tolerance: float
    max_iterations: int
    conversion: str
    hankel_points: int  # of conversion "split"
    enlarge: int  # of the other two
    fill: float  # half-width of the box over the contact radius
    threads: int


@dataclass(frozen=True)
class Body:
    """The coated half-space and the friction on it."""

    coatings: Coatings
    substrate: Substrate
    friction: float

    @property
    def softest(self) -> float:
        """Smallest E* = E/(1 - nu^2) of all the materials [Pa]."""
        return min(E / (1 - nu**2) for E, nu, *_ in (*self.coatings, self.substrate))

    def layer_of(self, z: ArrayLike, layer: int | None) -> NDArray[np.intp]:
        """Index of the layer at each depth; on an interface the one named, or the upper one."""
        z = np.asarray(z, dtype=float)
        if not np.all(z >= 0):
            raise ValueError(f"z = {np.min(z):g} m is above the surface; depth counts down from 0")
        interfaces = np.cumsum([h for _, _, h in self.coatings])
        # points given within rounding of an interface are meant to lie on it
        slack = 1e-9 * interfaces
        above = np.searchsorted(interfaces + slack, z)
        if layer is None:
            return above
        below = np.searchsorted(interfaces - slack, z, side="right")
        if not 0 <= layer <= len(self.coatings):
            raise ValueError(f"layer = {layer}; layers count from 0 to {len(self.coatings)}, the substrate")
        strange = (layer < above) | (layer > below)
        if np.any(strange):
            where = float(np.asarray(z)[strange].flat[0])
            raise ValueError(
                f"layer = {layer} does not hold z = {where:g} m; the interfaces lie at "
                f"{', '.join(f'{i:g}' for i in interfaces) or 'no depth'} m"
            )
        return np.full(z.shape, layer)


@dataclass(frozen=True)
class Level:
    """A contact on one grid."""

    grid: Grid
    found: contact.Contact

    @property
    def radius(self) -> float:
        return edge.radius_of(self.found.pressure, self.grid.radius, self.grid.d)

    @property
    def scalars(self) -> dict[str, float]:
        return {
            "contact_radius": self.radius,
            "approach": self.found.approach,
            "peak_pressure": float(self.found.pressure.max()),
        }


def solve(
    *,
    radius: float,
    load: float,
    coatings: Coatings,
    substrate: Substrate,
    friction: float = 0.0,
    patches: int = 257,
    tolerance: float = 1e-8,
    max_iterations: int = 200,
    conversion: str = "split",
    hankel_points: int = 4096,
    enlarge: int = 4,
    fill: float = 1.12,
    estimate_uncertainty: bool = True,
    threads: int = 1,
) -> Solution:
    """Press a rigid sphere of ``radius`` [m] with ``load`` [N] on a coated half-space.

    coatings ((E, nu, thickness), ...) from the surface down; substrate (E, nu); friction f in q = f p.
    patches : per side of the finest grid, odd.  tolerance : gap and penetration over the approach.
    conversion : "split", "split-fft" or "plain" (module ``influence``), with hankel_points of the first
    and enlarge, the domain over the grid, of the others.  fill : half-width of the grid over the radius.

    Raises ValueError for input without meaning, NotConverged when the iteration stops short.
    """
    began = time.perf_counter()
    _check_positive(radius=radius, load=load)
    body = _body(coatings, substrate, friction)
    numerics = _numerics(
        tolerance, max_iterations, conversion, hankel_points, enlarge, fill, threads, patches
    )
    ladder = _ladder(patches, radius, load, body, numerics)
    solution = None
    for level in ladder:
        solution = _as_solution(level, solution, body)
    assert solution is not None
    if estimate_uncertainty:
        solution = replace(solution, uncertainty=_uncertainty(ladder, radius, load, body, numerics))
    else:
        solution = replace(solution, coarser=None)
    seconds = time.perf_counter() - began
    return replace(solution, diagnostics=replace(solution.diagnostics, seconds=seconds))


def _ladder(patches: int, radius: float, load: float, body: Body, numerics: Numerics) -> list[Level]:
    """Contacts on .., N/4, N/2 and N patches a side, each started from the one before."""
    level = _find_contact(radius, load, body, numerics)
    sizes = [patches]
    while sizes[0] > 2 * COARSEST or len(sizes) < 3:
        sizes.insert(0, odd(sizes[0] / 2))
    half_width = numerics.fill * level.radius
    ladder = []
    for n in sizes:
        level = _press(Grid(n, 2 * half_width / n), level, radius, load, body, numerics)
        ladder.append(level)
    return ladder


def _find_contact(radius: float, load: float, body: Body, numerics: Numerics) -> Level:
    """Contact on a coarse grid that fits it, from the Hertz radius of the most compliant material."""
    half_width = numerics.fill * (0.75 * load * radius / body.softest) ** (1 / 3)
    rough = replace(numerics, tolerance=max(1e-4, numerics.tolerance))
    for _ in range(12):
        grid = Grid(COARSEST, 2 * half_width / COARSEST)
        level = _press(grid, None, radius, load, body, rough)
        a = level.radius
        if 0.75 * half_width < numerics.fill * a < 1.05 * half_width:
            return level
        # a contact that runs into the rim hides its size
        rim = _touches_rim(level.found.pressure)
        half_width = 1.5 * half_width if rim else numerics.fill * max(a, 1.5 * grid.d)
    raise NotConverged(
        f"no grid was found that fits the contact, last half-width {half_width:.3g} m; "
        "the moduli of the layers may lie too far apart"
    )


def _touches_rim(pressure: Array) -> bool:
    rim = (pressure[0], pressure[-1], pressure[:, 0], pressure[:, -1])
    return any(bool(np.any(side > 0)) for side in rim)


def _press(
    grid: Grid, before: Level | None, radius: float, load: float, body: Body, numerics: Numerics
) -> Level:
    """Contact on a grid, started from another grid's or from Hertz's ellipsoid that fills the grid."""
    r = grid.radius
    if before is None:
        start = np.sqrt(np.maximum(1 - (numerics.fill * r / grid.half_width) ** 2, 0))
    else:
        start = carry_over(before.found.pressure, before.grid, grid)
    kernel = _coefficients(grid, body, numerics)
    gap = r**2 / (2 * radius)
    found = contact.press(
        convolution.even_convolution(kernel, threads=numerics.threads),
        gap,
        total=load / grid.d**2,
        start=start,
        precondition=convolution.circulant_inverse(kernel, threads=numerics.threads),
        scale=2 * float(gap[grid.n // 2, 0]),
        tolerance=numerics.tolerance,
        max_iterations=numerics.max_iterations,
    )
    return Level(grid, found)


def _coefficients(grid: Grid, body: Body, numerics: Numerics) -> Array:
    """Influence coefficients K [m/Pa] of the surface displacement, shape (n, n)."""
    n, d = grid.n, grid.d
    E1, nu1 = (*body.coatings, body.substrate)[0][:2]
    scale = (1 - nu1**2) / (np.pi * E1)

    def excess(k: Array) -> Array:
        return frf.compliance_excess(k, body.coatings, body.substrate)

    if numerics.conversion == "plain":
        return scale * influence.plain_coefficients(
            n, d, excess, enlarge=numerics.enlarge, threads=numerics.threads
        )
    C = halfspace.surface_deflection(n, n, d, d)
    if body.coatings:
        thickness = [h for _, _, h in body.coatings]
        image = influence.split_image(excess, thickness)
        C += image[0] * halfspace.surface_deflection(n, n, d, d, image[1])
        C += influence.remainder_coefficients(
            n,
            d,
            excess,
            thickness,
            image,
            points=numerics.hankel_points,
            enlarge=numerics.enlarge if numerics.conversion == "split-fft" else 0,
            threads=numerics.threads,
        )
    return scale * C


def _as_solution(level: Level, coarser: Solution | None, body: Body) -> Solution:
    grid, found = level.grid, level.found
    scalars = level.scalars
    reach = int(np.ceil(2.05 * scalars["contact_radius"] / grid.d))

    loaded: dict[str, Any] = {
        "grid_x": grid.x,
        "grid_y": grid.x,
        "pressure": found.pressure,
        "friction": body.friction,
        "coatings": body.coatings,
        "substrate": body.substrate,
    }

    def stress(x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None) -> Array:
        rectangle = (halfspace.normal_stress, halfspace.tangential_stress)
        where = body.layer_of(z, layer)
        return subsurface.stress(x, y, z, where, rectangle=rectangle, stress_frf=frf.stress_frf, **loaded)

    def displacement(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        rectangle = (halfspace.normal_displacement, halfspace.tangential_displacement)
        where = body.layer_of(z, None)
        return subsurface.displacement(
            x, y, z, where, rectangle=rectangle, displacement_frf=frf.displacement_frf, **loaded
        )

    return Solution(
        **scalars,
        surface_nodes=np.arange(-reach, reach + 1) * grid.d,
        diagnostics=Diagnostics(
            iterations=found.iterations,
            convolutions=found.convolutions,
            gap_inside=found.gap_inside,
            penetration_outside=found.penetration_outside,
            load_error=found.load_error,
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
        _stress=stress,
        _displacement=displacement,
    )


def _uncertainty(
    ladder: list[Level], radius: float, load: float, body: Body, numerics: Numerics
) -> Uncertainty:
    """One ladder per knob; all but the patch size on half the patches, where they act alike.

    Patch size: the change from N/2 to N, or a third of that from N/4 to N/2 where the first is small by
    chance; at order 1.5 and more the error left is below half of either.
    """
    fine, half = ladder[-1], ladder[-2]
    quarter = ladder[-3] if len(ladder) > 2 else half
    n, d = half.grid.n, half.grid.d
    coarser = replace(
        numerics, hankel_points=numerics.hankel_points // 2, enlarge=max(numerics.enlarge // 2, 1)
    )
    wider = Grid(odd(WIDER * n), d)
    looser = replace(numerics, tolerance=min(100 * numerics.tolerance, 1e-2))
    other = {
        "conversion": _press(half.grid, half, radius, load, body, coarser),
        "domain": _press(wider, half, radius, load, body, numerics),
        "iteration": _press(half.grid, ladder[-3] if len(ladder) > 2 else None, radius, load, body, looser),
    }
    rows = []
    for name, value in fine.scalars.items():
        halved, quartered = half.scalars[name], quarter.scalars[name]
        rows.append((name, "patch size", max(abs(value - halved), abs(halved - quartered) / 3)))
        rows += [(name, knob, abs(level.scalars[name] - halved)) for knob, level in other.items()]
    total = {name: sum(row[2] for row in rows if row[0] == name) for name in fine.scalars}
    return Uncertainty(**total, budget=tuple(rows))


def _body(coatings: Coatings, substrate: Substrate, friction: float) -> Body:
    """The half-space, refused in a sentence where it has no meaning."""
    if not np.isfinite(friction):
        raise ValueError(f"friction = {friction:g}; it must be finite")
    for i, material in enumerate((*coatings, substrate)):
        what = "substrate" if i == len(coatings) else f"coating {i + 1}"
        if len(material) != (2 if i == len(coatings) else 3):
            raise ValueError(f"{what} = {material!r}; a coating is (E, nu, thickness), a substrate (E, nu)")
        E, nu = material[:2]
        if not (np.isfinite(E) and E > 0):
            raise ValueError(f"E = {E:g} Pa of the {what}; it must be positive and finite")
        if not -1 < nu <= 0.5:
            raise ValueError(f"nu = {nu:g} of the {what}; an isotropic solid has -1 < nu <= 0.5")
        if len(material) == 3 and not (np.isfinite(material[2]) and material[2] > 0):
            raise ValueError(f"thickness = {material[2]:g} m of the {what}; it must be positive and finite")
    floats = tuple((float(E), float(nu), float(h)) for E, nu, h in coatings)
    return Body(floats, (float(substrate[0]), float(substrate[1])), float(friction))


def _numerics(
    tolerance: float,
    max_iterations: int,
    conversion: str,
    hankel_points: int,
    enlarge: int,
    fill: float,
    threads: int,
    patches: int,
) -> Numerics:
    if patches < COARSEST or patches % 2 == 0:
        raise ValueError(f"patches = {patches}; it must be odd and at least {COARSEST}")
    if not 1e-13 <= tolerance < 1:
        raise ValueError(f"tolerance = {tolerance:g}; give 1e-13 or more, 1e-8 is the default")
    if conversion not in influence.CONVERSIONS:
        raise ValueError(f"conversion = {conversion!r}; choose one of {', '.join(influence.CONVERSIONS)}")
    if not fill > 1.02:
        raise ValueError(f"fill = {fill:g}; the grid must exceed the contact, give 1.05 or more")
    return Numerics(tolerance, max_iterations, conversion, hankel_points, enlarge, fill, threads)


def _check_positive(**values: float) -> None:
    for name, value in values.items():
        if not (np.isfinite(value) and value > 0):
            raise ValueError(f"{name} = {value:g}; it must be positive and finite")
