"""Public entry of the semi-analytical method.

Physical keywords in, ``Solution`` out. Only this file knows all the others: it builds the influence
coefficients of the coated solid, presses the indenter on a sequence of ever finer grids, and keeps
the coarser results, because they are the ladders that its uncertainty is read from.

Both the sphere's parabola, small strains, perfect bond, and q = f p that leaves p unchanged are assumed.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import RectBivariateSpline

from semianalytic import contact, convolution, edge, frf, halfspace, influence
from semianalytic.contact import NotConverged
from semianalytic.grid import Grid, carry_over, odd

__all__ = ["Diagnostics", "NotConverged", "Solution", "Uncertainty", "solve"]

Array = NDArray[np.floating]
Coatings = tuple[tuple[float, float, float], ...]
Substrate = tuple[float, float]

FILL = 1.12  # half-width of the box over the contact radius
COARSEST = 33  # patches a side of the grid that finds the contact


@dataclass(frozen=True)
class Uncertainty:
    """Numerical uncertainty in SI units; budget : rows (quantity, knob, value)."""

    contact_radius: float
    approach: float
    peak_pressure: float
    budget: tuple[tuple[str, str, float], ...]


@dataclass(frozen=True)
class Diagnostics:
    """What the solution took and how well the contact conditions are met.

    gap_inside, penetration_outside : over the approach; load_error : relative; patches : loaded ones.
    history : (gap, penetration) of every iteration on the finest grid.
    """

    iterations: int
    convolutions: int
    gap_inside: float
    penetration_outside: float
    load_error: float
    patches: int
    patches_per_side: int
    patch_size: float
    seconds: float
    history: tuple[tuple[float, float], ...] = field(repr=False, default=())


@dataclass(frozen=True)
class Numerics:
    """The knobs, each with a ladder of its own."""

    tolerance: float
    max_iterations: int
    conversion: str
    hankel_points: int
    threads: int


@dataclass(frozen=True)
class Solution:
    """Contact of a rigid sphere on a coated half-space; all SI, tension positive."""

    contact_radius: float
    approach: float
    peak_pressure: float
    surface_nodes: Array
    diagnostics: Diagnostics
    uncertainty: Uncertainty | None
    grid: Grid = field(repr=False)
    patch_pressure: Array = field(repr=False)
    coarser: "Solution | None" = field(repr=False)
    coatings: Coatings
    substrate: Substrate
    friction: float

    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        """Contact pressure [Pa]; between nodes p^2 is interpolated, which is smooth up to the edge.

        x, y : [m], broadcast.
        """
        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        nodes = self.grid.x
        square = RectBivariateSpline(nodes, nodes, self.patch_pressure**2, kx=3, ky=3)
        inside = np.maximum(np.abs(x), np.abs(y)) <= nodes[-1]
        value = np.zeros(x.shape)
        value[inside] = np.sqrt(np.maximum(square(x[inside], y[inside], grid=False), 0))
        return value


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
    estimate_uncertainty: bool = True,
    threads: int = 1,
) -> Solution:
    """Press a rigid sphere of ``radius`` [m] with ``load`` [N] on a coated half-space.

    coatings ((E, nu, thickness), ...) from the surface down; substrate (E, nu); friction f in q = f p.
    patches : per side of the finest grid.  tolerance : gap and penetration over the approach.
    conversion : "split", "split-fft" or "plain" (``influence``).  hankel_points : of the conversion "split".

    Raises ValueError for input without meaning, NotConverged when the iteration stops short.
    """
    began = time.perf_counter()
    coatings = tuple((float(E), float(nu), float(h)) for E, nu, h in coatings)
    _check(coatings, substrate, friction, radius=radius, load=load)
    _check_numerics(patches, tolerance, conversion)
    numerics = Numerics(tolerance, max_iterations, conversion, hankel_points, threads)
    ladder = _ladder(patches, radius, load, coatings, substrate, numerics)
    seconds = time.perf_counter() - began
    solution = None
    for grid, found in ladder:
        solution = _as_solution(grid, found, solution, coatings, substrate, friction, seconds)
    assert solution is not None
    if not estimate_uncertainty:
        return replace(solution, coarser=None)
    return replace(solution, uncertainty=_uncertainty(solution, radius, load, numerics))


def _ladder(
    patches: int, radius: float, load: float, coatings: Coatings, substrate: Substrate, numerics: Numerics
) -> list[tuple[Grid, contact.Contact]]:
    """Contacts on N/8.., N/4, N/2 and N patches a side, each started from the one before."""
    grid, found = _find_contact(radius, load, coatings, substrate, numerics)
    levels = [patches]
    while levels[0] > 2 * COARSEST:
        levels.insert(0, odd(levels[0] / 2))
    half_width = FILL * _radius(grid, found)
    ladder = []
    for n in levels:
        finer = Grid(n, 2 * half_width / n)
        start = carry_over(found.pressure, grid, finer)
        grid, found = finer, _press(finer, start, radius, load, coatings, substrate, numerics)
        ladder.append((grid, found))
    return ladder


def _find_contact(
    radius: float, load: float, coatings: Coatings, substrate: Substrate, numerics: Numerics
) -> tuple[Grid, contact.Contact]:
    """Contact on a coarse grid that fits it, from the Hertz radius of the most compliant material."""
    E_star = [E / (1 - nu**2) for E, nu, *_ in (*coatings, substrate)]
    half_width = FILL * (0.75 * load * radius / min(E_star)) ** (1 / 3)
    for _ in range(12):
        grid = Grid(COARSEST, 2 * half_width / COARSEST)
        a = half_width / FILL
        start = np.sqrt(np.maximum(1 - (grid.radius / a) ** 2, 0))
        found = _press(grid, start, radius, load, coatings, substrate, replace(numerics, tolerance=1e-4))
        a = _radius(grid, found)
        if 0.75 * half_width < FILL * a < 1.05 * half_width:
            return grid, found
        # a contact that runs into the rim hides its size
        half_width = 1.5 * half_width if _touches_rim(found.pressure) else FILL * max(a, 1.5 * grid.d)
    raise NotConverged(
        f"no grid was found that fits the contact, last half-width {half_width:.3g} m; "
        "the moduli of the layers may lie too far apart"
    )


def _touches_rim(pressure: Array) -> bool:
    rim = (pressure[0], pressure[-1], pressure[:, 0], pressure[:, -1])
    return any(bool(np.any(side > 0)) for side in rim)


def _radius(grid: Grid, found: contact.Contact) -> float:
    return edge.radius_of(found.pressure, grid.radius, grid.d)


def _press(
    grid: Grid,
    start: Array,
    radius: float,
    load: float,
    coatings: Coatings,
    substrate: Substrate,
    numerics: Numerics,
) -> contact.Contact:
    kernel = _coefficients(grid, coatings, substrate, numerics)
    gap = grid.radius**2 / (2 * radius)
    return contact.press(
        convolution.even_convolution(kernel, threads=numerics.threads),
        gap,
        total=load / grid.d**2,
        start=start,
        precondition=convolution.circulant_inverse(kernel, threads=numerics.threads),
        scale=2 * float(gap[grid.n // 2, 0]),
        tolerance=numerics.tolerance,
        max_iterations=numerics.max_iterations,
    )


def _coefficients(grid: Grid, coatings: Coatings, substrate: Substrate, numerics: Numerics) -> Array:
    """Influence coefficients K [m/Pa] of the surface displacement, shape (n, n)."""
    n, d = grid.n, grid.d
    E1, nu1 = (*coatings, substrate)[0][:2]
    scale = (1 - nu1**2) / (np.pi * E1)

    def excess(k: Array) -> Array:
        return frf.compliance_excess(k, coatings, substrate)

    if numerics.conversion == "plain":
        return scale * influence.plain_coefficients(n, d, excess, threads=numerics.threads)
    C = halfspace.surface_deflection(n, n, d, d)
    if coatings:
        thickness = [h for _, _, h in coatings]
        image = influence.split_image(excess, thickness)
        C += image[0] * halfspace.surface_deflection(n, n, d, d, image[1])
        C += influence.remainder_coefficients(
            n,
            d,
            excess,
            thickness,
            image,
            points=numerics.hankel_points,
            enlarge=4 if numerics.conversion == "split-fft" else 0,
            threads=numerics.threads,
        )
    return scale * C


def _as_solution(
    grid: Grid,
    found: contact.Contact,
    coarser: Solution | None,
    coatings: Coatings,
    substrate: Substrate,
    friction: float,
    seconds: float,
) -> Solution:
    a = _radius(grid, found)
    reach = int(np.ceil(2.05 * a / grid.d))
    diagnostics = Diagnostics(
        iterations=found.iterations,
        convolutions=found.convolutions,
        gap_inside=found.gap_inside,
        penetration_outside=found.penetration_outside,
        load_error=found.load_error,
        patches=int(np.count_nonzero(found.pressure)),
        patches_per_side=grid.n,
        patch_size=grid.d,
        seconds=seconds,
        history=found.history,
    )
    return Solution(
        contact_radius=a,
        approach=found.approach,
        peak_pressure=float(found.pressure.max()),
        surface_nodes=np.arange(-reach, reach + 1) * grid.d,
        diagnostics=diagnostics,
        uncertainty=None,
        grid=grid,
        patch_pressure=found.pressure,
        coarser=coarser,
        coatings=coatings,
        substrate=substrate,
        friction=friction,
    )


def _uncertainty(solution: Solution, radius: float, load: float, numerics: Numerics) -> Uncertainty | None:
    return None


def _check(coatings: Coatings, substrate: Substrate, friction: float, **positive: float) -> None:
    """Refuse what has no meaning, in a sentence."""
    for name, value in positive.items():
        if not (np.isfinite(value) and value > 0):
            raise ValueError(f"{name} = {value:g}; it must be positive and finite")
    if not np.isfinite(friction):
        raise ValueError(f"friction = {friction:g}; it must be finite")
    for i, material in enumerate((*coatings, substrate)):
        what = "substrate" if i == len(coatings) else f"coating {i + 1}"
        E, nu = material[:2]
        if not (np.isfinite(E) and E > 0):
            raise ValueError(f"E = {E:g} Pa of the {what}; it must be positive and finite")
        if not 0 <= nu <= 0.5:
            raise ValueError(f"nu = {nu:g} of the {what}; this method takes 0 <= nu <= 0.5")
        if len(material) == 3 and not (np.isfinite(material[2]) and material[2] > 0):
            raise ValueError(f"thickness = {material[2]:g} m of the {what}; it must be positive and finite")


def _check_numerics(patches: int, tolerance: float, conversion: str) -> None:
    if patches < COARSEST or patches % 2 == 0:
        raise ValueError(f"patches = {patches}; it must be odd and at least {COARSEST}")
    if not 1e-13 <= tolerance < 1:
        raise ValueError(f"tolerance = {tolerance:g}; give 1e-13 or more, 1e-8 is the default")
    if conversion not in influence.CONVERSIONS:
        raise ValueError(f"conversion = {conversion!r}; choose one of {', '.join(influence.CONVERSIONS)}")
