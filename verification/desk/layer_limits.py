"""Verdict on a contact: how near each layer and interface is to failing, and the load at which it begins to.

    yields      largest von Mises stress of a layer          against its yield strength
    cracks      largest first principal stress of a layer    against its strength
    shears off  largest |sigma_xz| of an interface           against its adhesion
    lifts off   largest tension sigma_zz of an interface     against its adhesion

Residual stress is included. The load at which a stress reaches its strength is found by solving at other
loads, each of which serves every mode.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import exp, log
from typing import Any

from verification.cases.case_file import Case
from verification.cases.plausibility import as_stress, beyond_limits, strain_warning
from verification.desk.answer_stresses import Extreme
from verification.desk.contact_answer import ContactAnswer, answer, place_of, summary, with_name
from verification.desk.stack_text import body_label
from verification.problem.coated_contact import CoatedContact
from verification.problem.point_answers import BALL, FLAT

NEAR = 2e-3  # of the strength: a load as near as this is found, and interpolated from there
MOST_SOLVES, FARTHEST = 8, 1e4  # of one mode; factor of the load between two of them
UNUSUAL = 0.03  # von Mises stress over the modulus that few materials bear; hardened steels yield below 0.015
# What each stress does, by which strength it is judged, and its own name.
MODES = {
    "von_mises": ("yields", "yield_strength", "von Mises stress"),
    "sigma_1": ("cracks", "strength", "first principal stress"),
    "|sigma_xz|": ("shears off", "adhesion", "shear stress"),
    "|sigma_yz|": ("shears off", "adhesion", "shear stress"),
    "sigma_zz": ("lifts off", "adhesion", "tension"),
}

Place = tuple[str, str, str]  # body, where, quantity, as of ``Extreme``


@dataclass(frozen=True)
class LayerMode:
    """One way to fail: the largest ``stress`` [Pa] of its quantity at a place, and the ``strength`` there.

    body, where, quantity : as of ``Extreme``.   load : at which they are equal [N], 0 where the residual
    stress alone is enough, None where it was not found.   x, y, z : place of the stress at about that load
    [m].
    """

    body: str
    where: str
    quantity: str
    stress: float
    strength: float
    load: float | None
    x: float
    z: float
    y: float = 0.0

    @property
    def utilisation(self) -> float:
        """The stress over its strength."""
        return self.stress / self.strength

    @property
    def safety(self) -> float:
        """The strength over the stress; infinite where there is none."""
        return self.strength / self.stress if self.stress > 0 else float("inf")

    @property
    def of(self) -> str:
        """The strength in words."""
        return MODES[self.quantity][1].replace("_", " ")

    @property
    def begins(self) -> str:
        """The load at which it begins to fail, in words."""
        if self.load is None:
            return "the load at which it begins was not found"
        return f"from {self.load:.3g} N" if self.load else "its residual stress alone is enough"

    def warnings(self, name: str) -> tuple[str, ...]:
        """A line where the place, called ``name``, fails."""
        if self.utilisation <= 1:
            return ()
        does, _, stress = MODES[self.quantity]
        return (
            f"{name} {does}: its {stress} {as_stress(self.stress)} is {self.utilisation:.3g} times its "
            f"{self.of} {as_stress(self.strength)}; {self.begins}",
        )


@dataclass(frozen=True)
class Designed:
    """Largest stresses of a case with what it states beside its problem: residual stresses, strengths.

    summary : in words.   warnings : a line for each limit that is exceeded.
    """

    summary: str
    extremes: tuple[Extreme, ...] = ()
    limits: tuple[LayerMode, ...] = ()
    warnings: tuple[str, ...] = ()


def designed(case: Case, source: str) -> Designed | None:
    """The largest stresses of ``case`` by ``source``; None where it states no residual stress and no limit.

    Raises what the source raises.
    """
    if not (case.residual or case.limits):
        return None
    if case.problem.indenter is not None and not case.problem.elliptical:
        return Designed(
            "Largest stresses with residual stress, and strengths, are for balls and ellipsoids alone."
        )
    first = answer(case.problem, source, case.numerics.get(source), case.residual, case.layers)
    modes = modes_of(case, first)
    told = limit_warnings(case, first, modes)
    said = " ".join(filter(None, (summary(case.problem, first, case.names), verdict(case, modes))))
    return Designed(said, first.extremes, modes, told)


def modes_of(case: Case, found: ContactAnswer) -> tuple[LayerMode, ...]:
    """Every mode of ``found``, the answer to ``case``, that has a strength, with the load it begins at."""
    numerics = case.numerics.get(found.source)
    return layer_modes(case.problem, found, strengths_of(case.limits), numerics, case.residual, case.layers)


def limit_warnings(case: Case, found: ContactAnswer, modes: tuple[LayerMode, ...]) -> tuple[str, ...]:
    """A line for each strength and limit of the pressure that ``found`` exceeds."""
    failing = (line for one in modes for line in one.warnings(place_name(case, one)))
    return (*failing, *beyond_limits(found.numbers["peak_pressure"][0], case.limits))


def place_name(case: Case, at: LayerMode | Extreme) -> str:
    """A layer or interface with the name of its body and its own."""
    return body_label(case.problem, at.body, with_name(at.body, at.where, case.names))


def strengths_of(limits: Mapping[str, float]) -> dict[Place, float]:
    """Strength [Pa] of each mode by its place; ``limits`` by the keys of a case file, see ``Case``."""
    found = {}
    for key, value in limits.items():
        *path, name = key.split(".")
        body = BALL if BALL in path else FLAT
        number = int(path[-1]) + 1 if "coatings" in path else 0
        layer = f"coating {number}" if number else "substrate"
        for quantity, (_, of, _) in MODES.items():
            if of == name:
                found[body, f"interface {number}" if of == "adhesion" else layer, quantity] = value
    return found


def verdict(case: Case, modes: tuple[LayerMode, ...]) -> str:
    """Whether everything holds, what is nearest to failing, the loads at which it begins; "" without any."""
    if not modes:
        return ""
    worst, sliding = max(modes, key=lambda one: one.utilisation), case.problem.friction > 0

    def which(one: LayerMode) -> str:
        return f"{place_name(case, one)} {MODES[one.quantity][0]}"

    share = f"{100 * worst.utilisation:.3g} % of the {worst.of}"
    margin = f"safety factor {worst.safety:.3g}" if worst.stress > 0 else "no stress at all"
    failing = [one for one in modes if one.utilisation > 1]
    said = [f"Verdict: {', '.join(map(which, failing[:3]))}{', ...' if len(failing) > 3 else ''}."]
    if not failing:
        said = ["Verdict: holds."]
    if worst.stress > 0:
        said.append(f"Nearest to its limit: {which(worst)} ({share}, {margin}).")
    for word, some in (("yield", [one for one in modes if one.quantity == "von_mises"]), ("failure", modes)):
        loads = [(one.load, one) for one in some if one.load is not None]
        if loads:
            load, first = min(loads, key=lambda pair: pair[0])
            at = f"at {load:.3g} N" if load else "without any load"
            place = f", {place_of(first, case.problem, sliding)}" if load else ""
            said.append(f"First {word} {at}: {which(first)}{place}.")
    return " ".join(said)


def unusual(case: Case, found: ContactAnswer) -> tuple[str, ...]:
    """A line for each layer without a yield strength whose von Mises stress hardly any material bears."""
    known, lines = strengths_of(case.limits), []
    for at in found.extremes:
        if at.quantity != "von_mises" or (at.body, at.where, at.quantity) in known:
            continue
        seen = case.problem.seen_from(at.body)
        layers = case.sublayers(at.body)
        number = int(at.where.split()[-1]) - 1 if at.where.startswith("coating") else len(layers)
        E = (*seen.coatings, seen.substrate)[sum(layers[:number])][0]
        if at.value > UNUSUAL * E:
            lines.append(
                f"the von Mises stress of {place_name(case, at)}, {as_stress(at.value)}, is "
                f"{100 * at.value / E:.2g} % of its modulus, which few materials bear (hardened steels yield "
                "below 1.5 %); give its yield strength for a verdict"
            )
    return tuple(lines)


def strain_warnings(case: Case, found: ContactAnswer) -> list[str]:
    """A line for each layer whose strain is not small."""
    return [line for at in found.strains for line in strain_warning(place_name(case, at), at.value)]


def layer_modes(
    problem: CoatedContact,
    first: ContactAnswer,
    strengths: Mapping[Place, float],
    numerics: Mapping[str, Any] | None = None,
    residual: Mapping[str, tuple[float, ...]] | None = None,
    layers: Mapping[str, tuple[int, ...]] | None = None,
    *,
    loads: bool = True,
) -> tuple[LayerMode, ...]:
    """Every mode of ``first``, the answer to ``problem``, that has one of ``strengths``.

    numerics, residual, layers : as of ``answer``, which solves other loads.   loads : whether it does.
    """
    fast = {**(numerics or {}), "estimate_uncertainty": False}
    known = {problem.load: _by_place(first)}

    def stress_at(load: float) -> dict[Place, Extreme]:
        if load not in known:
            there = replace(problem, load=load)
            known[load] = _by_place(answer(there, first.source, fast, residual, layers))
        return known[load]

    rest, found = _at_rest(residual or {}, layers or {}), []
    for place, at in known[problem.load].items():
        if (strength := strengths.get(place)) is None:
            continue

        def use(load: float, place: Place = place, strength: float = strength) -> float:
            return max(stress_at(load)[place].value / strength, 1e-6)

        load = _load_of(use, known, rest.get(place, 0.0) / strength) if loads else None
        nearest = min(known, key=lambda one: abs(log(one / (load or problem.load))))
        there = known[nearest][place]
        found.append(LayerMode(*place, at.value, strength, load, there.x, there.z, there.y))
    return tuple(found)


def _by_place(found: ContactAnswer) -> dict[Place, Extreme]:
    return {(at.body, at.where, at.quantity): at for at in found.extremes}


def _at_rest(
    residual: Mapping[str, tuple[float, ...]], layers: Mapping[str, tuple[int, ...]]
) -> dict[Place, float]:
    """The stresses of each coating at no load [Pa]: its residual stress, of the worst of its sub-layers."""
    found = {}
    for body, stresses in residual.items():
        begin = 0
        for i, n in enumerate(layers.get(body) or (1,) * len(stresses), start=1):
            own = stresses[begin : begin + n]
            found[body, f"coating {i}", "von_mises"] = max(map(abs, own))
            found[body, f"coating {i}", "sigma_1"] = max(0.0, *own)
            begin += n
    return found


def _load_of(use: Callable[[float], float], known: Mapping[float, Any], at_rest: float) -> float | None:
    """The load at which ``use``, the stress over its strength, is 1: by secants of its logarithm.

    known : loads that are solved, of which the nearest two are used first.   at_rest : the same at no load.
    None where it is not found, as where no contact of such a load is solved.
    """
    if at_rest >= 1:
        return 0.0
    try:
        for _ in range(MOST_SOLVES):
            (load, nearest), *others = sorted(
                ((one, use(one)) for one in known), key=lambda pair: abs(log(pair[1]))
            )
            # The contact stress of Hertz grows as the cubic root of the load.
            step = 3 * log((1 - at_rest) / max(nearest - at_rest, 1e-3 * (1 - at_rest)))
            if others:
                before, second = others[0]
                slope = log(nearest / second) / log(load / before)
                # Where the residual stress outweighs that of the contact the load has no part yet.
                step = -log(nearest) / slope if slope > 1e-3 else (log(8) if nearest < 1 else -log(8))
            if abs(nearest - 1) < NEAR:
                return float(load * exp(step))
            use(float(load * exp(max(min(step, log(FARTHEST)), -log(FARTHEST)))))
    except (ValueError, ArithmeticError):
        pass
    return None
