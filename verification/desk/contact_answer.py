"""Answer to one problem: contact size, largest stresses, a sentence, differences from a second method."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import isnan
from typing import Any

import numpy as np

from verification.desk.answer_stresses import Extreme, StressCourse, stresses
from verification.desk.stack_text import units_of
from verification.problem.coated_contact import CoatedContact
from verification.problem.point_answers import FLAT
from verification.problem.quantity import QUANTITIES, SCALARS
from verification.running.slicing import sliced
from verification.sampling.along_axis import AlongAxis
from verification.sources.source_registry import METHODS, solvers

# Measured on one core of 2.5 GHz, an elastic ball with two thin films within 5 %.
BODY_SECONDS, FILM_SECONDS, THIN = 4.0, 8.0, 0.1
ELLIPSE_SECONDS = 27.0  # of each body in place of both, measured on the case 24_ellipse

# Of more layers the patches are not refined beyond those given: under 20 films of 1.4e-3 a the uncertainties
# do not fall with them, and the time is a third.
REFINED_LAYERS = 8

HALF_AXES = {"half_axis_x": "a_x", "half_axis_y": "a_y"}  # of an ellipse, by their symbols

Names = Mapping[str, tuple[str, ...]]  # of the coatings of each body, see ``Case``


@dataclass(frozen=True)
class ContactAnswer:
    """Answer of one ``source``: ``numbers`` as (value, uncertainty) by name, SI; extremes, courses.

    An uncertainty is None where the source states none.   strains : the largest strain of each layer.
    """

    source: str
    seconds: float
    numbers: dict[str, tuple[float, float | None]]
    extremes: tuple[Extreme, ...]
    courses: tuple[StressCourse, ...]
    strains: tuple[Extreme, ...] = ()

    @property
    def reach(self) -> float:
        """Distance [m] of the contact edge from the axis along x."""
        return self.numbers.get("half_axis_x", self.numbers["contact_radius"])[0]


@dataclass(frozen=True)
class AnswerDifference:
    """``value`` of a second answer less the first [SI], of ``key`` as of ``differences``.

    within : whether its magnitude is at most the sum of both uncertainties.
    """

    key: tuple[str, ...]
    value: float
    within: bool


def answer(
    problem: CoatedContact,
    source: str,
    numerics: Mapping[str, Any] | None = None,
    residual: Mapping[str, tuple[float, ...]] | None = None,
    layers: Mapping[str, tuple[int, ...]] | None = None,
) -> ContactAnswer:
    """Solve ``problem`` by ``source``, find its largest stresses; ``residual``, ``layers`` as there.

    Raises what the source raises.
    """
    begin = time.perf_counter()
    chosen = dict(numerics or {})
    if source == METHODS[0] and len(problem.coatings) > REFINED_LAYERS:
        chosen.setdefault("accuracy", None)
    solution = solvers()[source](problem, chosen)
    numbers = {name: tuple(solution.sample(None, name)) for name in SCALARS}
    if problem.elliptical:
        sides = (AlongAxis(solution, across=across) for across in (False, True))
        numbers |= {
            name: tuple(side.sample(None, "contact_radius"))
            for name, side in zip(HALF_AXES, sides, strict=True)
        }
    found, drawn = stresses(solution, problem, residual, layers)
    strains = tuple(at for at in found if at.quantity == "strain")
    extremes = tuple(at for at in found if at.quantity != "strain")
    return ContactAnswer(source, time.perf_counter() - begin, numbers, extremes, drawn, strains)


def differences(first: ContactAnswer, second: ContactAnswer) -> tuple[AnswerDifference, ...]:
    """Differences of two answers to one problem: keys (name,), or (body, quantity, where) of extremes."""
    pairs: dict[tuple[str, ...], list[tuple[float, float]]] = {}
    for one in (first, second):
        for name, (value, stated) in one.numbers.items():
            pairs.setdefault((name,), []).append((value, float("nan") if stated is None else stated))
        for at in one.extremes:
            pairs.setdefault((at.body, at.quantity, at.where), []).append((at.value, at.uncertainty))
    return tuple(
        AnswerDifference(key, b - a, abs(b - a) <= U_a + U_b) for key, ((a, U_a), (b, U_b)) in pairs.items()
    )


def symbol_and_unit(name: str) -> tuple[str, str]:
    """Symbol and SI unit of one of the ``numbers`` of an answer."""
    if name in HALF_AXES:
        return HALF_AXES[name], "m"
    return QUANTITIES[name].symbol, QUANTITIES[name].unit


def with_slicing(found: ContactAnswer, coarser: Sequence[ContactAnswer]) -> ContactAnswer:
    """An answer for graded coatings with the uncertainty of their slicing added to those of the numbers.

    coarser : with half and with a quarter of the sub-layers; () where no coating is graded.
    """
    changes = [differences(*pair) for pair in pairwise((found, *coarser))]
    by = {one.key: sliced(one.value, before.value, one.key) for one, before in zip(*changes, strict=True)}
    numbers = {
        name: (value, None if stated is None else stated + by.get((name,), 0.0))
        for name, (value, stated) in found.numbers.items()
    }
    extremes = tuple(
        replace(at, uncertainty=at.uncertainty + by.get((at.body, at.quantity, at.where), 0.0))
        for at in found.extremes
    )
    return replace(found, numbers=numbers, extremes=extremes)


def usual_seconds(problem: CoatedContact) -> float:
    """Usual processor time [s] of the answer by finite elements, with the mesh of each body and thin film."""
    if problem.elliptical:
        return ELLIPSE_SECONDS * len(problem.bodies)
    thin = [h < THIN * problem.a_h for body in problem.bodies for *_, h in problem.seen_from(body).coatings]
    return BODY_SECONDS * len(problem.bodies) + FILM_SECONDS * sum(thin)


ON_AXIS = 5e-3  # of a place from the axis, over a_h
DOUBTFUL = 0.05  # uncertainty over its stress that a sentence does not leave out


def summary(problem: CoatedContact, found: ContactAnswer, names: Names) -> str:
    """Largest tension, shear and von Mises stress of both bodies with their places, in three digits.

    The largest tension of a coating comes first, then that of all where it is elsewhere; then the largest
    sigma_xx at the base of a coating, which cracks from there too, and the interface that is sheared most.
    names : of the coatings, see ``Case``.
    """
    sliding, units = problem.friction > 0, units_of(problem)
    (largest, *_), coatings = _ranked(found, "sigma_1"), _ranked(found, "sigma_1", "coating")
    bases, interfaces = _ranked(found, "sigma_xx", "base of"), _ranked(found, "|sigma_xz|")

    def stress(at: Extreme) -> str:
        value, uncertainty = at.value / units.pascal, at.uncertainty / units.pascal
        doubt = f" ± {float(f'{uncertainty:.1g}'):g}" if uncertainty > DOUBTFUL * abs(value) else ""
        return f"{_three_digits(value)}{doubt} {units.stress}"

    def name(at: Extreme) -> str:
        where = "the substrate" if at.where == "substrate" else with_name(at.body, at.where, names)
        if at.body == FLAT:
            return where
        coated = bool(problem.seen_from(at.body).coatings)
        return f"{where} of the {at.body}" if coated else f"the {at.body}"

    pulled = [at for at in (*coatings[:1], largest) if at.value > 0]
    said = ["No tension."]
    if pulled:
        of = "Largest tension in the coatings" if coatings else "Largest tension"
        first = pulled[0]
        said = [f"{of}: {stress(first)}, in {name(first)} {place_of(first, problem, sliding)}."]
        if first is not largest:
            said.append(f"Largest anywhere: {stress(largest)}, in {name(largest)}.")
    said += [f"At the {name(at)}: {stress(at)} of tension." for at in bases[:1] if at.value > 0]
    said += [f"Largest shear of an interface: {stress(at)}, at {name(at)}." for at in interfaces[:1]]
    for quantity, of in (("von_mises", "von Mises stress"), ("tau_max", "shear stress")):
        if ranked := _ranked(found, quantity):
            at = ranked[0]
            where = f"in {name(at)} {place_of(at, problem, sliding)}"
            said.append(f"Largest {of}: {stress(at)}, {where}.")
    return " ".join(said)


def with_name(body: str, where: str, names: Names) -> str:
    """A place with the names of its coating, or of what an interface joins: "base of coating 1 (DLC)"."""
    own = names.get(body, ())
    kind, _, number = where.rpartition(" ")
    if kind.endswith("interface") and all(own[int(number) - 1 : int(number) + 1]) and own:
        return f"{where} ({' / '.join(own[int(number) - 1 : int(number) + 1])})"
    named = kind.endswith("coating") and int(number) < len(own) and own[int(number) - 1]
    return f"{where} ({named})" if named else where


def agreement(first: ContactAnswer, apart: tuple[AnswerDifference, ...]) -> str:
    """Whether both methods agree, and within what: shares of p0 and of each length; "" without a check."""
    if not apart:
        return ""
    outside = [one for one in apart if not one.within]
    p0 = first.numbers["peak_pressure"][0]
    scales = {name: value for name, (value, _) in first.numbers.items()}
    worst = max(abs(one.value) / scales.get(one.key[0], p0) for one in apart)
    within = f"within {100 * worst:.1g} % of p0, the contact radius or the approach"
    if not outside:
        return f"Both methods agree on all {len(apart)} numbers {within}, and within their uncertainties."
    names = "; ".join(" ".join(one.key) for one in outside[:3]) + ("; ..." if len(outside) > 3 else "")
    return (
        f"The methods differ by more than both uncertainties in {len(outside)} of {len(apart)} numbers "
        f"({names}); all are {within}."
    )


def _ranked(found: ContactAnswer, quantity: str, where: str = "") -> list[Extreme]:
    """The extremes of ``quantity`` at places that begin with ``where``, the largest first."""
    those = [at for at in found.extremes if at.quantity == quantity and at.where.startswith(where)]
    return sorted(those, key=lambda at: -at.value)


def _three_digits(value: float) -> str:
    return np.format_float_positional(value, precision=3, fractional=False, trim="-")


def place_of(at: Any, problem: CoatedContact, sliding: bool) -> str:
    """The place ``x``, ``z`` of a stress in words: "at its surface, 110 um behind the axis"."""
    units = units_of(problem)

    def length(value: float) -> str:
        return f"{_three_digits(value / units.metre)} {units.length}"

    depth = "at its surface" if at.z == 0 else f"at z = {length(at.z)}"
    across = getattr(at, "y", 0.0)
    if abs(across) >= ON_AXIS * problem.a_h:
        return f"{depth}, {length(abs(across))} across from the axis"
    if isnan(at.x) or abs(at.x) < ON_AXIS * problem.a_h:
        return f"{depth} on the axis"
    side = ("behind" if at.x < 0 else "ahead of") if sliding else "from"
    return f"{depth}, {length(abs(at.x))} {side} the axis"
