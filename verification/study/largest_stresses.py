"""The largest stresses of a coated contact with their positions.

Each is the maximum along a line, or in a layer, of the functions in ``planes``: found on 16 points for each
sample, then refined. The maximum of the von Mises stress inside a layer is located by interpolation between
depths, then evaluated by the solution itself.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize_scalar

from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, ContactSolution
from verification.problem.quantity import von_mises
from verification.study.friction_planes import (
    XX,
    XZ,
    YY,
    ZZ,
    DepthLine,
    Parts,
    both_sides,
    finer,
    inner_planes,
    outer_planes,
    stress_at,
)

Measure = Callable[[Array], Array]

# The stresses of a study [Pa] in the order of the columns.
Stress = Literal[
    "sigma_xx_surface",
    "sigma_xx_base",
    "sigma_xx_substrate",
    "sigma_xz_interface",
    "sigma_zz_interface",
    "von_mises_coating",
    "von_mises_substrate",
]
QUANTITIES: tuple[str, ...] = get_args(Stress)
FINE = 8  # between two samples of a layer, each way


@dataclass(frozen=True)
class Located:
    """``value`` with its absolute ``uncertainty`` at (x, 0, z); SI units."""

    value: float
    uncertainty: float
    x: float
    z: float


@dataclass(frozen=True)
class Unstated(Located):
    """The largest ``measure`` of a ``stress``, (4,), whose ``uncertainty`` lacks that of the source.

    layer : that holds it.   radii : at which the uncertainty is taken, the largest.   added : by
    interpolation [Pa], (4,).   edge : in place of that of the source at the contact edge, (2, 4).
    """

    layer: int
    measure: Measure
    stress: Array
    radii: Array
    added: Array | float = 0.0
    edge: Array | None = None


def stated(found: Sequence[Located], parts: Parts, friction: float) -> list[Located]:
    """``found`` with the uncertainties of the source, evaluated together in each layer."""
    out, of_layer = list(found), dict[int, dict[int, Unstated]]()
    for number, one in enumerate(found):
        if isinstance(one, Unstated):
            of_layer.setdefault(one.layer, {})[number] = one
    for layer, places in of_layer.items():
        sizes = [one.radii.size for one in places.values()]
        z = np.repeat([one.z for one in places.values()], sizes)
        bounds = parts(np.concatenate([one.radii for one in places.values()]), z, layer)[2]
        split = np.split(bounds, np.cumsum(sizes)[:-1], axis=2)
        for (number, one), bound in zip(places.items(), split, strict=True):
            if one.edge is not None:
                bound[:, :, one.radii == parts.solution.contact_radius] = one.edge[..., None]
            beside = bound.max(axis=2)
            U = parts.uncertainty(beside if one.x >= 0 else beside[::-1], friction) + one.added
            total = one.uncertainty + propagated(one.measure, one.stress, U)
            out[number] = Located(one.value, total, one.x, one.z)
    return out


def quantities(
    solution: ContactSolution,
    problem: CoatedContact,
    frictions: Sequence[float],
    residual: Sequence[float] = (0.0,),
    swept: int = 0,
) -> dict[tuple[float, float], dict[str, Located]]:
    """Every stress of ``QUANTITIES`` by residual stress and friction, from one ``solution``.

    solution : of ``problem``, which is coated, at friction 1, or at 0 where no other is asked for. Of several
    coatings and interfaces the largest counts.
    residual : equibiaxial stresses [Pa] of coating ``swept``, each added to sigma_xx, sigma_yy within it.
    Below an ellipse, whose tension across its long axis may be the larger one, sigma_yy counts as sigma_xx.
    A tensile stress that is nowhere positive has value 0 and position NaN. Without friction, where the field
    is symmetric in x, the position is on the trailing side.
    Raises ValueError where a friction is given and the solution has none, or what ``solution.stress`` raises.
    """
    if any(frictions) and not problem.friction:
        raise ValueError("the solution has no friction; solve with friction=1")
    parts = Parts(solution, problem.friction)
    z, n = problem.interfaces, len(problem.coatings)
    tops, bases = outer_planes(parts, z, z[0])
    inner = [inner_planes(parts, z, layer) for layer in range(n + 1)]
    layered = [[tops[k], *planes, *bases[k : k + 1]] for k, (planes, _) in enumerate(inner)]
    tension: Measure = (lambda s: s[: YY + 1].max(axis=0)) if problem.elliptical else lambda s: s[XX]
    lines: dict[str, tuple[list[DepthLine], Measure]] = {
        "sigma_xx_surface": (tops[:1], tension),
        "sigma_xx_base": (bases, tension),
        "sigma_xx_substrate": (tops[-1:], tension),
        "sigma_xz_interface": (bases, lambda s: np.abs(s[XZ])),
        "sigma_zz_interface": (bases, lambda s: s[ZZ]),
    }
    layers = {"von_mises_coating": range(n), "von_mises_substrate": range(n, n + 1)}
    found: dict[tuple[float, float], dict[str, Located]] = {}
    for f in frictions:
        grids = [
            LayerGrid.between(planes, knots, f) for planes, (_, knots) in zip(layered, inner, strict=True)
        ]
        asked = [(name, line, measure) for name, (many, measure) in lines.items() for line in many]
        at = stated([largest(line, measure, f) for _, line, measure in asked], parts, f)
        alone: dict[str, list[tuple[int, Located]]] = {}
        for (name, line, _), one in zip(asked, at, strict=True):
            alone.setdefault(name, []).append((line.layer, one))
        for stress in residual:
            here = {}
            for name, places in alone.items():
                added = stress if name in ("sigma_xx_surface", "sigma_xx_base") else 0.0
                total = [replace(at, value=at.value + added * (layer == swept)) for layer, at in places]
                here[name] = tensile(max(total, key=lambda place: place.value))
            for name, body in layers.items():
                if name == "von_mises_substrate" and (residual[0], f) in found:
                    here[name] = found[residual[0], f][name]
                    continue
                candidates = []
                for layer in body:
                    measure = with_residual(von_mises, stress if layer == swept else 0.0)
                    candidates += [largest(layered[layer][end], measure, f) for end in (0, -1)]
                    candidates += inside(parts, grids[layer], f, measure)
                here[name] = max(candidates, key=lambda place: place.value)
            found[stress, f] = dict(zip(here, stated(list(here.values()), parts, f), strict=True))
    return found


def with_residual(measure: Measure, residual: float) -> Measure:
    """``measure`` of a stress with an equibiaxial ``residual`` stress [Pa] added to sigma_xx, sigma_yy."""
    if not residual:
        return measure
    added = residual * np.array([1.0, 1.0, 0.0, 0.0])
    return lambda s: measure(s + added.reshape(4, *[1] * (s.ndim - 1)))


def largest(line: DepthLine, measure: Measure, friction: float) -> Unstated:
    """The largest ``measure`` of the stresses along a line."""
    x, stress = line.course(friction)
    value = measure(stress)
    i = int(np.argmax(value))
    at, best = float(x[i]), float(value[i])
    if 0 < i < x.size - 1:
        found = minimize_scalar(
            lambda place: -float(measure(line(np.array([place]), friction))[0]),
            bounds=(x[i - 1], x[i + 1]),
            method="bounded",
            options={"xatol": 1e-7 * line.knots[-1]},
        )
        if -found.fun > best:
            at, best = float(found.x), -float(found.fun)
    stress, added = line(np.array([at]), friction)[:, 0], line.interpolation(at, friction)
    return Unstated(best, 0.0, at, line.z, line.layer, measure, stress, line.beside(at), added, line.edge)


@dataclass(frozen=True, eq=False)
class LayerGrid:
    """``stress`` [Pa], (4, nz, nx), between the planes of a ``layer`` at x and z [m], by interpolation."""

    layer: int
    x: Array
    z: Array
    stress: Array

    @classmethod
    def between(cls, planes: Sequence[DepthLine], knots: Array, friction: float) -> "LayerGrid":
        """By splines through the ``planes``; x on both sides with ``FINE`` points between two ``knots``."""
        x, depth = both_sides(knots, FINE), np.array([p.z for p in planes])
        z = finer(depth, FINE)
        stress = CubicSpline(depth, np.stack([p(x, friction) for p in planes]), axis=0)
        return cls(planes[1].layer, x, z, np.moveaxis(stress(z), 1, 0))


def inside(parts: Parts, grid: LayerGrid, friction: float, measure: Measure) -> list[Unstated]:
    """The largest ``measure`` between the planes of a layer; none where it lies on an outer one."""
    x, z, layer, value = grid.x, grid.z, grid.layer, measure(grid.stress)
    i, j = np.unravel_index(int(np.argmax(value)), value.shape)
    if not (0 < i < z.size - 1 and 0 < j < x.size - 1):
        return []
    at_z = vertex(z[i - 1 : i + 2], value[i - 1 : i + 2, j])
    at_x = vertex(x[j - 1 : j + 2], value[i, j - 1 : j + 2])
    there = np.array([at_x])
    stress_there = stress_at(parts, there, np.array([at_z]), layer, friction)[:, 0]
    best = float(measure(stress_there))
    interpolation = abs(best - float(value[i, j]))  # which may have located another point than the maximum
    return [Unstated(best, interpolation, at_x, at_z, layer, measure, stress_there, np.abs(there))]


def propagated(measure: Measure, s: Array, bound: Array) -> float:
    """Uncertainty of a measure from those of the four stresses, added in magnitude."""
    value = float(measure(s))
    return float(sum(np.abs(measure(s + step) - value) for step in np.diag(bound)))


def tensile(found: Located) -> Located:
    """``found``, or 0 for compression, with the part of the uncertainty that exceeds 0."""
    if found.value > 0:
        return found
    excess = float(np.maximum(0.0, found.uncertainty + found.value))  # NaN where none is stated
    return Located(0.0, excess, float("nan"), float("nan"))


def vertex(x: Array, y: Array) -> float:
    """Position of the maximum of the parabola through three points, within their interval."""
    c = np.polyfit(x - x[1], y, 2)
    if c[0] >= 0:
        return float(x[1])
    return float(x[1] + np.clip(-c[1] / (2 * c[0]), x[0] - x[1], x[2] - x[1]))
