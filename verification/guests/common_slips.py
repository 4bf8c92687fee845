"""Slips that change a whole answer: axis, sign, unit, component, shift, an input of Hertz's formulas.

Each slip turns the exact values into the wrong answers that it would give. Among the sets of up to four
slips, the one with the smallest misfit to the answers is chosen, with a price for every slip. What a slip
changes but cannot predict (a mirrored value on an oblique line) counts little, and is explained by that slip.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from math import isclose, log

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import Akima1DInterpolator
from scipy.optimize import minimize_scalar

from verification.guests.exam_subjects import exact_radius, reference_of
from verification.problem.array_types import Array
from verification.problem.line_profile import ON_BALL
from verification.problem.quantity import DISPLACEMENTS, PEAKS, STRESSES, unit_of
from verification.running.case_result import CaseResult

EDGE = 0.08  # half-width of the zone around the contact edge where no shift is fitted, of a
PRICE = 2.0  # of a slip, in the sum of log misfits
FLOOR, VAGUE = 1e-4, 0.1  # smallest misfit of a known value, of one that a slip changes unpredictably
MOST, BEAM = 4, 8  # slips in a set, sets that are extended
EXPLAINED = 0.1  # of the misfit may remain
UNITS = {
    "Pa": {
        1e6: "MPa taken for Pa",
        1e-6: "MPa in place of Pa",
        1e9: "GPa taken for Pa",
        1e-9: "GPa in place of Pa",
    },
    "m": {1e3: "mm in place of m", 1e-3: "mm taken for m", 1e6: "um in place of m", 1e-6: "um taken for m"},
}
THOUSANDS = {10.0**k: "a factor of units" for k in (-9, -6, -3, 3, 6, 9)}
SCOPES = {
    "Pa": ((*STRESSES, *PEAKS[:1], "pressure", "peak_pressure"), (*STRESSES, *PEAKS[:1])),
    "m": (("contact_radius", "approach", *PEAKS[1:], *DISPLACEMENTS), DISPLACEMENTS),
}

Key = tuple[str, str]  # quantity, line
Values = dict[Key, tuple[Array, bool]]  # with whether they are known


@dataclass(frozen=True)
class CommonSlip:
    """A slip with its short ``name``, the ``message`` that asks for it, what it makes of exact values."""

    name: str
    message: str
    change: Callable[[Values], Values]


@dataclass(frozen=True)
class Explanation:
    """The slips of an answer with the wrong places that each explains; the ``values`` that they predict."""

    slips: tuple[tuple[CommonSlip, tuple[Key, ...]], ...]
    values: Mapping[Key, tuple[Array, bool]]


def explanation(result: CaseResult, guest: str, wrong: list[Key]) -> Explanation:
    """The smallest set of slips that explains the answers of ``guest`` at the ``wrong`` places."""
    exact = {
        (p.quantity, p.line): (p.value, True)
        for p in result.profiles
        if p.source == reference_of(result.problem)
    }
    given = {(p.quantity, p.line): p.value for p in result.profiles if p.source == guest}
    given = {key: g for key, g in given.items() if key in exact and np.isfinite(g).all()}
    wrong = [key for key in wrong if key in given]
    if not wrong:
        return Explanation((), exact)
    near = _near_edge(result)
    slips = list(_slips(result, exact, given, wrong))

    @cache
    def changed(chosen: tuple[int, ...]) -> Values:
        return slips[chosen[-1]].change(changed(chosen[:-1])) if chosen else exact

    def misfits(chosen: tuple[int, ...]) -> dict[Key, float]:
        values = changed(chosen)
        return {key: _misfit(g, *values[key], near.get(key[1])) for key, g in given.items()}

    def cost(chosen: tuple[int, ...]) -> float:
        return PRICE * len(chosen) + sum(log(max(m, FLOOR)) for m in misfits(chosen).values())

    beam: dict[tuple[int, ...], float] = {(): cost(())}
    best: tuple[int, ...] = ()
    for _ in range(MOST):
        longer = {tuple(sorted({*one, n})) for one in beam for n in range(len(slips)) if n not in one}
        costs = {one: cost(one) for one in longer}
        kept = sorted(costs, key=lambda one: costs[one])[:BEAM]
        if not kept or costs[kept[0]] >= beam[best]:
            break
        beam, best = {one: costs[one] for one in kept}, kept[0]
    after = misfits(best)
    found = []
    for number in best:
        without = misfits(tuple(n for n in best if n != number))
        alone = changed((number,))
        vague = {key for key in wrong if not alone[key][1]}
        places = [key for key in wrong if after[key] <= EXPLAINED * without[key] or key in vague]
        if any(key not in vague for key in places):
            found.append((slips[number], tuple(places)))
    return Explanation(tuple(found), changed(best) if found else exact)


def _misfit(g: Array, p: Array, known: bool, near: NDArray[np.bool_] | None) -> float:
    """|g - p| over the larger of both; of unknown values the difference of their sizes."""
    keep = np.isfinite(p) if near is None else np.isfinite(p) & ~near
    if not keep.any():
        return VAGUE
    size = max(float(np.linalg.norm(g[keep])), float(np.linalg.norm(p[keep])))
    if size == 0:
        return 0.0
    misfit = float(np.linalg.norm((g - p)[keep])) / size
    if known and 2 * keep.sum() >= keep.size:
        return misfit
    sizes = abs(float(np.linalg.norm(g[keep])) - float(np.linalg.norm(p[keep]))) / size
    return max(min(misfit, VAGUE), sizes)


def _near_edge(result: CaseResult) -> dict[str, NDArray[np.bool_]]:
    """Points of the lines on the surface that lie beside the contact edge, where no slip is tested."""
    a = exact_radius(result)
    lines = {p.line: p.position for p in result.profiles if p.line in ("surface", "oblique surface")}
    return {line: np.asarray(np.abs(np.abs(x) - a) < EDGE * a) for line, x in lines.items()}


def _slips(
    result: CaseResult, exact: Values, given: dict[Key, Array], wrong: list[Key]
) -> Iterator[CommonSlip]:
    """In the order in which they act: of the input, of the physics, of the output."""
    places = {p.line: p.position for p in result.profiles}
    if any(q in ("contact_radius", "approach", "peak_pressure") for q, _ in wrong):
        yield from _inputs(result, exact, given, places)
    mirrored = _moved(
        places, lambda x: -x, dict.fromkeys(("sigma_xz", "sigma_xy", "u_x", "tension_place"), -1.0)
    )
    if result.problem["friction"]:
        yield CommonSlip(
            "sliding along -x",
            "mirrored in x: is sliding, and the friction q on the solid, along +x?",
            mirrored,
        )
    yield CommonSlip("x and y", "x and y transposed?", _transposed)
    if any("side" in line for line in places):
        yield CommonSlip(
            "other side", "values of the other layer, from the other side of the interface?", _sides
        )
    yield CommonSlip(
        "z upwards", "z upwards? Here z points into the solid.", _signed("sigma_xz", "sigma_yz", "u_z")
    )
    yield CommonSlip(
        "compression positive",
        "of the opposite sign: compression positive? Here tension is positive.",
        _blurred(_signed(*STRESSES), PEAKS),
    )
    a, key = exact_radius(result), ("pressure", "surface")
    if key in given and (shift := fitted_shift(places["surface"], exact[key][0], given[key], a)):
        yield CommonSlip("shift", shift_message(shift, a), _moved(places, lambda x: x - shift, {}))
    for unit, scopes in SCOPES.items():
        for factor, text in UNITS[unit].items():
            sizes = [
                np.abs(g).max() / np.abs(exact[k][0]).max() for k, g in given.items() if _has(unit, k, exact)
            ]
            if any(0.1 < size / factor < 10 for size in sizes):
                for scope in scopes:
                    yield CommonSlip(
                        text, f"{factor:.4g} times the exact value: {text}?", _scaled(scope, factor)
                    )


def _has(unit: str, key: Key, exact: Values) -> bool:
    return unit_of(key[0]) == unit and bool(np.abs(exact[key][0]).max() > 0)


def _inputs(
    result: CaseResult, exact: Values, given: dict[Key, Array], places: dict[str, Array]
) -> Iterator[CommonSlip]:
    """A wrong input of an uncoated contact: the fields of Hertz scale with a and p0.

    a = (3 W R / 4 E*)^(1/3),  p0 = 3 W / (2 pi a^2),  delta = a^2 / R      Johnson (4.22) to (4.24)
    """
    if result.problem["coatings"] or result.problem.get("ball"):
        return
    radius = "contact_radius", "contact"
    size = float(given[radius][0] / exact[radius][0][0]) if radius in given else 1.0
    for name, factors in input_factors(float(result.problem["substrate"][1])).items():
        for factor, cause in (factors | THOUSANDS).items():
            R, W, E = (factor if name == one else 1.0 for one in ("R", "W", "E*"))
            a = (W * R / E) ** (1 / 3)
            if factor in THOUSANDS and not isclose(a, size, rel_tol=EDGE):
                continue
            p0 = W / a**2
            numbers = {"contact_radius": a, "approach": a**2 / R, "peak_pressure": p0, "largest_tension": p0}
            numbers |= {"tension_place": a, "stiffness": a * E}
            text = f"the answers are those of Hertz with {name} times {factor:.4g}: {cause}?"

            def change(
                values: Values, a: float = a, p0: float = p0, numbers: dict[str, float] = numbers
            ) -> Values:
                found: Values = {}
                for (q, line), (v, known) in values.items():
                    if line == "contact":
                        found[q, line] = numbers.get(q, 1.0) * v, known and q in numbers
                    elif line in ("surface", "axis") and q not in DISPLACEMENTS:
                        x = places[line]
                        found[q, line] = p0 * _at(x / a, x, v), known
                    else:
                        found[q, line] = v, False
                return found

            yield CommonSlip(cause, text, change)


def input_factors(nu: float) -> dict[str, dict[float, str]]:
    """Factors of E*, R and W that common slips give, for Poisson's ratio ``nu``, with the slip."""
    plane = 1 - nu**2
    return {
        "E*": {
            plane: "E in place of E* = E/(1 - nu^2)",
            0.5: "E*/2, as if the sphere were of the same elastic material; it is rigid",
            plane / 2: "E/2 in place of E* = E/(1 - nu^2)",
            2.0: "2 E* in place of E*",
            1 / (1 + nu): "E/((1 - nu^2)(1 + nu)) in place of E/(1 - nu^2)",
            plane / (2 * (1 + nu)): "the shear modulus G = E/(2(1 + nu)) in place of E*",
            plane**2: "E (1 - nu^2) in place of E/(1 - nu^2)",
        },
        "R": {2.0: "the diameter in place of the radius", 0.5: "R/2 in place of R"},
        "W": {2.0: "twice the load", 0.5: "half of the load", 0.25: "the load of a quarter model"},
    }


def _signed(*quantities: str) -> Callable[[Values], Values]:
    return _scaled(quantities, -1.0)


def _scaled(quantities: tuple[str, ...], factor: float) -> Callable[[Values], Values]:
    def change(values: Values) -> Values:
        return {k: (factor * v if k[0] in quantities else v, known) for k, (v, known) in values.items()}

    return change


def _blurred(change: Callable[[Values], Values], quantities: tuple[str, ...]) -> Callable[[Values], Values]:
    """``change``, after which ``quantities`` are not known: a largest value follows from the wrong ones."""

    def blurred(values: Values) -> Values:
        return {k: (v, known and k[0] not in quantities) for k, (v, known) in change(values).items()}

    return blurred


def _moved(
    places: dict[str, Array], at: Callable[[Array], Array], signs: dict[str, float]
) -> Callable[[Values], Values]:
    """The values at other positions ``at(x)`` along x, some of the opposite sign."""
    still = bool(signs)  # mirrored: points with x = 0 stay

    def change(values: Values) -> Values:
        found: Values = {}
        for (q, line), (v, known) in values.items():
            sign = signs.get(q, 1.0)
            if line.removeprefix(ON_BALL).startswith(("surface", "interface")):
                x = places[line]
                v = _at(at(x), x, v)
            elif line != "contact" and not (still and line.endswith("axis")):
                known = False
            found[q, line] = sign * v, known
        return found

    return change


def _at(positions: Array, x: Array, v: Array) -> Array:
    """Values between the points ``x``; nan beyond them and where a neighbour is not known."""
    known = np.isfinite(v)
    if known.sum() < 5:
        return np.full(x.shape, np.nan)
    found: Array = Akima1DInterpolator(x[known], v[known])(positions)
    return found


def _transposed(values: Values) -> Values:
    found: Values = {}
    for (q, line), (v, known) in values.items():
        stem, _, axes = q.partition("_")
        if q in STRESSES or q in DISPLACEMENTS:
            swapped = axes.translate(str.maketrans("xy", "yx"))
            other = f"{stem}_{swapped}" if q in DISPLACEMENTS else f"sigma_{''.join(sorted(swapped))}"
            # What the plane y = 0 does not list is zero there by symmetry.
            found[q, line] = values.get((other, line), (np.zeros_like(v), known))
        else:
            found[q, line] = v, known and q not in PEAKS
    return found


def _sides(values: Values) -> Values:
    found = dict(values)
    for q, line in values:
        other = line.replace("upper", "~").replace("lower", "upper").replace("~", "lower")
        if (q, other) in values and values[q, other][0].size == values[q, line][0].size:
            found[q, line] = values[q, other]
    return found


def fitted_shift(x: Array, e: Array, g: Array, a: float) -> float:
    """The shift along x [m] by which the form of the exact values ``e`` fits ``g``; 0 where none is clear.

    a : contact radius [m]; at its edge, where the slope of the pressure is infinite, nothing is compared.
    """
    inner = np.abs(x) < (1 - EDGE) * a
    if not e[inner].any() or not g[inner].any():
        return 0.0

    def rest(s: float) -> float:
        moved = np.interp(x[inner] - s, x, e)
        factor = float(g[inner] @ moved) / float(moved @ moved)
        return float(np.linalg.norm(g[inner] - factor * moved))

    found = minimize_scalar(rest, bounds=(-0.3 * a, 0.3 * a), method="bounded", options={"xatol": 1e-9 * a})
    clear = abs(found.x) > 1e-4 * a and rest(found.x) < EXPLAINED * rest(0.0)
    return float(found.x) if clear else 0.0


def shift_message(shift: float, a: float) -> str:
    """The message about values shifted by ``shift`` [m]."""
    return f"shifted by {shift:+.3g} m = {shift / a:+.3g} a in x: half a cell, a corner for a centre?"
