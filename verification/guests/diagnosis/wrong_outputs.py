"""Slips of the output: what each makes of right values, by quantity and line."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import permutations

import numpy as np

from verification.problem.array_types import Array
from verification.problem.quantity import DISPLACEMENTS, PEAKS, STRESSES, unit_of

Key = tuple[str, str]  # quantity, line
Values = Mapping[Key, Array]  # NaN where a slip changes a value unpredictably
Places = Mapping[str, tuple[Array, Array]]  # x and y of the points of each line

UNITS = {
    "Pa": {
        1e6: "MPa taken for Pa",
        1e-6: "MPa in place of Pa",
        1e9: "GPa taken for Pa",
        1e-9: "GPa in place of Pa",
    },
    "m": {1e3: "mm in place of m", 1e-3: "mm taken for m", 1e6: "um in place of m", 1e-6: "um taken for m"},
}
SCOPES = {
    "Pa": (
        (*STRESSES, PEAKS[0], "pressure", "peak_pressure"),
        (*STRESSES, PEAKS[0]),
        ("pressure", "peak_pressure"),
        ("pressure",),
    ),
    "m": (("contact_radius", "approach", PEAKS[1], *DISPLACEMENTS), DISPLACEMENTS),
}
NUMBERS = {  # of one number: quantity, factor
    "the diameter 2 a in place of a": ("contact_radius", 2.0),
    "the mean pressure in place of the largest": ("peak_pressure", 2 / 3),
    "3/2 of the largest pressure": ("peak_pressure", 1.5),
    "twice the approach": ("approach", 2.0),
    "a^2/(2 R), the depth of the contact edge, in place of a^2/R": ("approach", 0.5),
    "the approach of the opposite sign": ("approach", -1.0),
}
SHEAR = ("sigma_yz", "sigma_xz", "sigma_xy")
OPPOSITE = ("sigma_xz", "sigma_yz", "u_z")


@dataclass(frozen=True)
class WrongOutput:
    """A slip by ``name`` that makes ``change`` of right values; ``message`` asks for it."""

    name: str
    change: Callable[[Values], Values]
    message: str = ""


def wrong_outputs(exact: Values, given: Values, places: Places) -> Iterator[WrongOutput]:
    """In the order in which they act: components and sides, signs, units, single numbers."""
    lines = {line for _, line in given}
    stressed = any(q in STRESSES for q, _ in given)
    yield WrongOutput("x and y", _transposed, "x and y transposed?")
    if any("side" in line for line in lines):
        yield WrongOutput(
            "other side",
            _sides(lambda mine, other: other),
            "values of the other layer, from the other side of the interface?",
        )
        yield WrongOutput(
            "mean of both sides",
            _sides(lambda mine, other: (mine + other) / 2),
            "the mean of both sides of an interface: nodal values averaged across the layers?",
        )
        for one, side in (("upper", "below"), ("lower", "above")):
            yield WrongOutput(
                f"{one} side alone",
                _sides(lambda mine, other: other, only=one),
                f"one value for both sides of an interface, that {side} it: layer ignored?",
            )
    if stressed:
        yield WrongOutput(
            "not rotated",
            lambda values: _cylindrical(values, places),
            "radial and hoop stress in place of sigma_xx and sigma_yy: not rotated to x, y?",
        )
        for order in permutations(SHEAR):
            if order != SHEAR:
                text = f"shear stresses in another (Voigt) order: {', '.join(order)} for {', '.join(SHEAR)}?"
                yield WrongOutput(f"order {' '.join(order)}", _reordered(SHEAR, order), text)
        pair = "sigma_yy", "sigma_zz"
        yield WrongOutput(
            "yy and zz", _reordered(pair, pair[::-1]), "order rr, zz, tt in place of rr, tt, zz?"
        )
        doubled = _scaled(SHEAR, 2.0)
        yield WrongOutput("shear doubled", doubled, "twice the shear stress: engineering shear strain?")
        yield WrongOutput(
            "in-plane constant",
            lambda values: _offset(values, given),
            "the same constant on sigma_xx and sigma_yy everywhere: periodic images, or their mean left out?",
        )
    yield WrongOutput("z upwards", _scaled(OPPOSITE, -1.0), "z upwards? Here z points into the solid.")
    text = "of the opposite sign: compression positive? Here tension is positive."
    yield WrongOutput("compression positive", _scaled(STRESSES, -1.0, PEAKS), text)
    text = "pressure of the opposite sign: it is positive in compression here."
    yield WrongOutput("negative pressure", _scaled(("pressure", "peak_pressure"), -1.0), text)
    for q in sorted({q for q, _ in given}):
        if not any(given[k].any() for k in given if k[0] == q) and any(
            exact[k].any() for k in exact if k[0] == q
        ):
            text = f"{q} is zero everywhere: not computed? Leave it out to have it counted as unsupported."
            yield WrongOutput(f"no {q}", _scaled((q,), 0.0), text)
    for unit, scopes in SCOPES.items():
        sizes = [
            float(np.abs(g).max() / np.abs(exact[k]).max())
            for k, g in given.items()
            if unit_of(k[0]) == unit and np.abs(exact[k]).max() > 0
        ]
        for factor, name in UNITS[unit].items():
            if any(0.1 < size / factor < 10 for size in sizes):
                text = f"{factor:.4g} times the exact value: {name}?"
                yield from (WrongOutput(name, _scaled(scope, factor), text) for scope in scopes)
    for name, (quantity, factor) in NUMBERS.items():
        yield WrongOutput(name, _scaled((quantity,), factor))


def _scaled(
    quantities: tuple[str, ...] | Mapping[str, object], factor: float, unknown: tuple[str, ...] = ()
) -> Callable[[Values], Values]:
    """``factor`` on some quantities; ``unknown`` are those that follow from them in a way of their own."""

    def change(values: Values) -> Values:
        by = {k: factor if k[0] in quantities else np.nan if k[0] in unknown else 1.0 for k in values}
        return {k: by[k] * v for k, v in values.items()}

    return change


def _reordered(names: tuple[str, ...], order: tuple[str, ...]) -> Callable[[Values], Values]:
    """Each of ``names`` with the values of its place in ``order``; zero where a line does not list it."""
    other = dict(zip(names, order, strict=True))

    def change(values: Values) -> Values:
        return {(q, line): values.get((other.get(q, q), line), 0 * v) for (q, line), v in values.items()}

    return change


def _transposed(values: Values) -> Values:
    swap = str.maketrans("xy", "yx")
    names = [q for q in (*STRESSES, *DISPLACEMENTS) if q.translate(swap) != q]
    order = [
        f"sigma_{''.join(sorted(q[6:].translate(swap)))}" if q in STRESSES else q.translate(swap)
        for q in names
    ]
    found = _reordered(tuple(names), tuple(order))(values)
    return _scaled((), 1.0, PEAKS)(found)


def _sides(of: Callable[[Array, Array], Array], only: str = "") -> Callable[[Values], Values]:
    """Values of this and of the other side of an interface combined, on the ``only`` side alone if given."""

    def change(values: Values) -> Values:
        found = dict(values)
        for q, line in values:
            other = line.replace("upper", "~").replace("lower", "upper").replace("~", "lower")
            mine = values[q, line]
            if other != line and only in line and values.get((q, other), mine[:0]).size == mine.size:
                found[q, line] = of(mine, values[q, other])
        return found

    return change


def _cylindrical(values: Values, places: Places) -> Values:
    """Stresses in the directions of r, theta, z of each point, named as those of x, y, z."""
    found = dict(values)
    for line in {line for q, line in values if q == "sigma_xx"}:
        x, y = places[line]
        r = np.where(np.hypot(x, y) > 0, np.hypot(x, y), 1.0)
        c, s = np.where(np.hypot(x, y) > 0, x / r, 1.0), y / r

        def of(name: str, line: str = line, x: Array = x) -> Array:
            return values.get((name, line), np.zeros_like(x))

        xx, yy, xy, xz, yz = (of(f"sigma_{n}") for n in ("xx", "yy", "xy", "xz", "yz"))
        turned = {
            "sigma_xx": c**2 * xx + 2 * c * s * xy + s**2 * yy,
            "sigma_yy": s**2 * xx - 2 * c * s * xy + c**2 * yy,
            "sigma_xy": (c**2 - s**2) * xy + c * s * (yy - xx),
            "sigma_xz": c * xz + s * yz,
            "sigma_yz": c * yz - s * xz,
        }
        found |= {(q, line): v for q, v in turned.items() if (q, line) in values}
    return found


def _offset(values: Values, given: Values) -> Values:
    """The mean difference of sigma_xx and sigma_yy from ``given``, one for all lines, added to both."""
    keys = [k for k in given if k[0] in ("sigma_xx", "sigma_yy") and k in values]
    rest = np.concatenate([given[k] - values[k] for k in keys]) if keys else np.zeros(1)
    constant = float(np.median(rest[np.isfinite(rest)])) if np.isfinite(rest).any() else 0.0
    return {k: v + constant if k[0] in ("sigma_xx", "sigma_yy") else v for k, v in values.items()}
