"""Problems that a code may have solved in place of the one that it was given, by the slip behind each."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from itertools import accumulate
from math import pi

from verification.problem.array_types import Coatings
from verification.problem.coated_contact import CoatedContact

Material = tuple[float, float]  # E, nu
MODULI: dict[str, Callable[[float, float], float]] = {
    "E in place of E* = E/(1 - nu^2)": lambda E, nu: E * (1 - nu**2),
    "half of E*, as if the sphere were of the same elastic material; it is rigid": lambda E, nu: E / 2,
    "E/2 in place of E* = E/(1 - nu^2)": lambda E, nu: E * (1 - nu**2) / 2,
    "2 E* in place of E*": lambda E, nu: 2 * E,
    "E/((1 - nu^2)(1 + nu)) in place of E/(1 - nu^2)": lambda E, nu: E / (1 + nu),
    "the shear modulus G = E/(2(1 + nu)) in place of E*": lambda E, nu: E * (1 - nu) / 2,
    "E (1 - nu^2) in place of E/(1 - nu^2)": lambda E, nu: E * (1 - nu**2) ** 2,
}
RADII = {2.0: "the diameter in place of the radius", 0.5: "R/2 in place of R"}
LOADS = {
    2.0: "twice the load",
    0.5: "half of the load",
    0.25: "the load of a quarter model",
    1 / (2 * pi): "the load over 2 pi, that of one radian of an axisymmetric model",
    2 * pi: "2 pi times the load",
}
THOUSANDS = (1e-3, 1e3)
MILLIONS = (1e-9, 1e-6, 1e6, 1e9)  # of uncoated solids alone: a coating would be thinner than any


@dataclass(frozen=True)
class WrongInput:
    """Problem as a slip of the input makes it; ``name`` says which slip."""

    name: str
    problem: CoatedContact


def wrong_inputs(p: CoatedContact) -> Iterator[WrongInput]:
    """Every other problem that a common slip makes of ``p``, each once."""
    seen = {p}
    for name, change in _changes(p).items():
        try:
            other = change(p)
        except ValueError:  # a Poisson's ratio that no solid has
            continue
        if other not in seen:
            seen.add(other)
            yield WrongInput(name, other)


Change = Callable[[CoatedContact], CoatedContact]


def _changes(p: CoatedContact) -> dict[str, Change]:
    found: dict[str, Change] = {name: _materials(_modulus(of)) for name, of in MODULI.items()}
    found |= {name: _radius(f) for f, name in RADII.items()}
    found |= {name: _load(f) for f, name in LOADS.items()}
    found["plane stress: lambda replaced by 2 lambda mu/(lambda + 2 mu)"] = _materials(_plane_stress)
    found["nu = 0 in place of Poisson's ratio"] = _materials(lambda E, nu: (E, 0.0))
    if p.coatings:
        last = (*p.substrate, 0.0)
        layers = (*p.coatings, last)
        upward = [layer[:2] for layer in reversed(layers)]
        depths = list(accumulate(h for _, _, h in p.coatings))
        rest = tuple((*m, h) for m, (_, _, h) in zip(upward, p.coatings, strict=False))
        found |= {
            "the coatings in reverse order": _coatings(p.coatings[::-1]),
            "the materials of coating and substrate exchanged": _coatings(rest, upward[-1]),
            "the depths of the interfaces taken for thicknesses": _coatings(
                tuple((E, nu, z) for (E, nu, _), z in zip(p.coatings, depths, strict=True))
            ),
            "no coatings: the substrate alone": _coatings(()),
            "the first coating as a half-space": _coatings((), p.coatings[0][:2]),
            "thickness halved": _coatings(tuple((E, nu, h / 2) for E, nu, h in p.coatings)),
            "thickness doubled": _coatings(tuple((E, nu, 2 * h) for E, nu, h in p.coatings)),
        }
    if p.ball is not None:
        found["a rigid ball in place of the elastic one"] = lambda p: replace(p, ball=None)
    if p.friction:
        found["no friction"] = lambda p: replace(p, friction=0.0)
    for factor in THOUSANDS if p.coatings else (*THOUSANDS, *MILLIONS):
        by = f"times {factor:g}: a factor of units"
        found[f"E {by}"] = _materials(partial(_times, factor))
        found[f"R {by}"] = _radius(factor)
        found[f"W {by}"] = _load(factor)
    return found


def _modulus(of: Callable[[float, float], float]) -> Callable[[float, float], Material]:
    return lambda E, nu: (of(E, nu), nu)


def _times(factor: float, E: float, nu: float) -> Material:
    return factor * E, nu


def _plane_stress(E: float, nu: float) -> Material:
    mu, lame = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))
    lame = 2 * lame * mu / (lame + 2 * mu)
    nu = lame / (2 * (lame + mu))
    return 2 * mu * (1 + nu), nu


def _materials(of: Callable[[float, float], Material]) -> Change:
    """Another material in each layer of both bodies."""

    def layers(coatings: Coatings) -> Coatings:
        return tuple((*of(E, nu), h) for E, nu, h in coatings)

    def change(p: CoatedContact) -> CoatedContact:
        ball = p.ball and (*of(*p.ball[:2]), layers(p.ball[2]))
        return replace(p, coatings=layers(p.coatings), substrate=of(*p.substrate), ball=ball)

    return change


def _coatings(coatings: Coatings, substrate: Material | None = None) -> Change:
    return lambda p: replace(p, coatings=coatings, substrate=substrate or p.substrate)


def _load(factor: float) -> Change:
    return lambda p: replace(p, load=factor * p.load)


def _radius(factor: float) -> Change:
    def change(p: CoatedContact) -> CoatedContact:
        shape = p.indenter and (p.indenter[0], tuple(factor * r for r in p.indenter[1]))
        return replace(p, radius=factor * p.radius, indenter=shape)

    return change
