"""Limits of each layer: its strain, how near it is to yielding, the load at which it begins to yield.

Yielding is judged by the largest von Mises stress of the layer, its residual stress included. Under a rising
load that stress never falls: it is the maximum of a convex function of the contact stress, least at no load.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import exp, log
from typing import Any

from verification.cases.case_file import Case
from verification.cases.plausibility import as_stress, beyond_limits, strain_warning
from verification.desk.answer_stresses import Extreme
from verification.desk.contact_answer import ContactAnswer, answer, summary, with_name
from verification.desk.stack_text import body_label
from verification.problem.coated_contact import CoatedContact
from verification.problem.point_answers import BALL, FLAT

NEAR = 2e-3  # of the strength: a load as near as this is found, and interpolated from there
MOST_SOLVES, FARTHEST = 8, 1e4  # of one layer; factor of the load between two of them

Strengths = Mapping[tuple[str, str], float]  # yield strength [Pa] by body and layer


@dataclass(frozen=True)
class LayerLimit:
    """One layer: ``strain``, the largest principal one in magnitude, and ``von_mises`` [Pa] of an answer.

    body, where : as of ``Extreme``.   yield_strength [Pa] : None where none is given.
    yields_from : the load [N] at which the layer begins to yield, 0 where its residual stress alone is
    enough, None where it is not known.
    """

    body: str
    where: str
    strain: float
    von_mises: float
    yield_strength: float | None = None
    yields_from: float | None = None

    @property
    def utilisation(self) -> float | None:
        """The von Mises stress over the yield strength."""
        return None if self.yield_strength is None else self.von_mises / self.yield_strength

    def warnings(self, name: str) -> tuple[str, ...]:
        """A line for a layer, called ``name``, that yields; another for one whose strain is not small."""
        found = strain_warning(name, self.strain)
        if self.yield_strength is not None and self.von_mises > self.yield_strength:
            text = f"{name} yields: its von Mises stress {as_stress(self.von_mises)} is "
            text += f"{self.utilisation:.3g} times its yield strength {as_stress(self.yield_strength)}"
            return (f"{text}; {self.begins}", *found)
        return found

    @property
    def begins(self) -> str:
        """The load at which it begins to yield, in words."""
        if self.yields_from is None:
            return "the load at which it begins to yield was not found"
        if self.yields_from == 0:
            return "its residual stress alone makes it yield"
        return f"it begins to yield at {self.yields_from:.3g} N"


@dataclass(frozen=True)
class Designed:
    """Largest stresses of a case with what it states beside its problem: residual stresses, limits of layers.

    summary : in words.   warnings : a line for each limit that is exceeded.
    """

    summary: str
    extremes: tuple[Extreme, ...] = ()
    limits: tuple[LayerLimit, ...] = ()
    warnings: tuple[str, ...] = ()


def designed(case: Case, source: str) -> Designed | None:
    """The largest stresses of ``case`` by ``source``; None where it states no residual stress and no limit.

    Raises what the source raises.
    """
    if not (case.residual or case.limits):
        return None
    if case.problem.indenter is not None:
        return Designed("Largest stresses with residual stress, and yielding, are found under balls alone.")
    state: dict[str, Any] = {"residual": case.residual, "layers": case.layers}
    first = answer(case.problem, source, case.numerics.get(source), **state)
    strengths = yield_strengths(case.limits)
    limits = layer_limits(case.problem, first, strengths, case.numerics.get(source), **state)
    told = [line for one in limits for line in one.warnings(layer_name(case, one)) if " yields: " in line]
    told += beyond_limits(first.numbers["peak_pressure"][0], case.limits)
    return Designed(summary(case.problem, first, case.names), first.extremes, limits, tuple(told))


def layer_name(case: Case, layer: LayerLimit) -> str:
    """The name of a layer with that of its body and its own."""
    return body_label(case.problem, layer.body, with_name(layer.body, layer.where, case.names))


def yield_strengths(limits: Mapping[str, float]) -> Strengths:
    """Yield strengths [Pa] by body and layer; ``limits`` by the keys of a case file, see ``Case``."""
    found = {}
    for key, value in limits.items():
        *path, name = key.split(".")
        if name == "yield_strength":
            layer = f"coating {int(path[-1]) + 1}" if "coatings" in path else "substrate"
            found[BALL if BALL in path else FLAT, layer] = value
    return found


def layer_limits(
    problem: CoatedContact,
    first: ContactAnswer,
    strengths: Strengths,
    numerics: Mapping[str, Any] | None = None,
    residual: Mapping[str, tuple[float, ...]] | None = None,
    layers: Mapping[str, tuple[int, ...]] | None = None,
) -> tuple[LayerLimit, ...]:
    """The limits of every layer of ``first``, the answer to ``problem``, in the order of its layers.

    numerics, residual, layers : as of ``answer``, which solves other loads where there are ``strengths``.
    """
    fast = {**(numerics or {}), "estimate_uncertainty": False}
    known = {problem.load: _von_mises(first)}

    def at(load: float) -> Mapping[tuple[str, str], float]:
        if load not in known:
            there = replace(problem, load=load)
            known[load] = _von_mises(answer(there, first.source, fast, residual, layers))
        return known[load]

    stressed = _residual_by_layer(residual or {}, layers or {})
    found = []
    for one in first.strains:
        place = one.body, one.where
        strength, begins = strengths.get(place), None
        if strength is not None:
            begins = _yields_from(
                lambda load, place=place, strength=strength: at(load)[place] / strength,  # type: ignore[misc]
                problem.load,
                stressed.get(place, 0.0) / strength,
            )
        found.append(LayerLimit(*place, one.value, known[problem.load][place], strength, begins))
    return tuple(found)


def _von_mises(found: ContactAnswer) -> dict[tuple[str, str], float]:
    return {(at.body, at.where): at.value for at in found.extremes if at.quantity == "von_mises"}


def _residual_by_layer(
    residual: Mapping[str, tuple[float, ...]], layers: Mapping[str, tuple[int, ...]]
) -> dict[tuple[str, str], float]:
    """The largest magnitude of the residual stress of each coating [Pa], its von Mises stress at no load."""
    found = {}
    for body, stresses in residual.items():
        begin = 0
        for i, n in enumerate(layers.get(body) or (1,) * len(stresses), start=1):
            found[body, f"coating {i}"] = max(map(abs, stresses[begin : begin + n]))
            begin += n
    return found


def _yields_from(use: Callable[[float], float], load: float, at_rest: float) -> float | None:
    """The load at which ``use``, the stress over its strength, is 1: by secants of its logarithm.

    load : where the search begins.   at_rest : the same at no load.
    None where it is not found, as where no contact of such a load is solved.
    """
    if at_rest >= 1:
        return 0.0
    try:
        points = [(load, use(load))]
        # The contact stress of Hertz grows as the cubic root of the load.
        above = max(points[0][1] - at_rest, 1e-3 * (1 - at_rest))
        step = 3 * log((1 - at_rest) / above)
        for _ in range(MOST_SOLVES):
            if abs(points[-1][1] - 1) < NEAR:
                return points[-1][0] * exp(step)
            following = points[-1][0] * exp(max(min(step, log(FARTHEST)), -log(FARTHEST)))
            points.append((following, use(following)))
            step = _secant(points)
    except (ValueError, ArithmeticError):
        pass
    return None


def _secant(points: Sequence[tuple[float, float]]) -> float:
    """The next step of the logarithm of the load."""
    (before, first), (load, second) = points[-2:]
    slope = log(second / first) / log(load / before) if load != before else 0.0
    # Where the residual stress outweighs that of the contact the load has no part yet.
    return -log(second) / slope if slope > 1e-3 else (log(8) if second < 1 else -log(8))
