"""Interval of an answer over the ranges of its materials, by sensitivities of first order.

Each modulus that has a range goes to both of its ends while the others stay: the changes add up, those that
lower a number and those that raise it. Coatings and bodies of one name are one material and change together.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from verification.cases.case_file import Case, with_moduli
from verification.cases.materials import plain_name, read_materials
from verification.cases.plausibility import as_stress
from verification.desk.contact_answer import ContactAnswer, answer, differences
from verification.desk.layer_limits import MODES, LayerMode, place_name
from verification.problem.display_units import prefixed

Key = tuple[str, ...]  # of a number or of a largest stress, as of ``differences``


@dataclass(frozen=True)
class MaterialRange:
    """E of a material, ``low`` to ``high`` [Pa]; ``places`` : (body, number of the coating) that it fills."""

    name: str
    low: float
    high: float
    places: tuple[tuple[str, int], ...]

    @property
    def words(self) -> str:
        """The range in words: "E of DLC 100 GPa to 200 GPa"."""
        return f"E of {self.name} {prefixed(self.low, 'Pa')} to {prefixed(self.high, 'Pa')}"


@dataclass(frozen=True)
class Spread:
    """Lowest and highest value [SI] of each number over the ``ranges``.

    shares : how much the widest range alone moves each number, with the name of its material.
    """

    ranges: tuple[MaterialRange, ...]
    ends: Mapping[Key, tuple[float, float]]
    shares: Mapping[Key, tuple[str, float]]

    @property
    def as_json(self) -> dict[str, Any]:
        """Ranges with the ends [SI] of every number, by its key in words."""
        ends = {" ".join(key): list(pair) for key, pair in self.ends.items()}
        return {"ranges": [one.words for one in self.ranges], "ends": ends}

    def sentence(self, case: Case, modes: tuple[LayerMode, ...]) -> str:
        """Effect of the ranges on peak pressure, tension in the coatings, and verdict."""
        tensions = {key: ends for key, ends in self.ends.items() if key[1:2] == ("sigma_1",)}
        coated = {key: ends for key, ends in tensions.items() if key[2].startswith("coating")} or tensions
        largest = max(coated, key=lambda key: coated[key][1])
        parts = [f"p0 {_between(self.ends['peak_pressure',])}"]
        if coated[largest][1] > 0:
            of = "largest tension in the coatings" if "coating" in largest[2] else "largest tension"
            parts.append(f"{of} {_between(coated[largest])}")
        said = f"With {', '.join(one.words for one in self.ranges)}: {', '.join(parts)}."
        if len(self.ranges) > 1:
            said += f" {self.shares[largest][0]} counts most."
        if not modes:
            return said
        ends = {one: self.ends[one.body, one.quantity, one.where] for one in modes}
        worst = max(modes, key=lambda one: ends[one][1] / one.strength)
        low, high = (100 * end / worst.strength for end in ends[worst])
        which = f"{place_name(case, worst)} {MODES[worst.quantity][0]}"
        held = "holds" if high <= 100 else "fails" if low > 100 else "depends on these ranges"
        return f"{said} The verdict {held}: {which} at {low:.3g} to {high:.3g} % of the {worst.of}."


def _between(ends: tuple[float, float]) -> str:
    return " to ".join(as_stress(max(end, 0.0)) for end in ends)


def ranges_of(case: Case, materials: Path) -> tuple[MaterialRange, ...]:
    """The materials of a ``case`` that have their typical E from the file ``materials``, with a range."""
    known, found = read_materials(materials), dict[str, MaterialRange]()
    for body, names in case.names.items():
        seen, begin = case.problem.seen_from(body), 0
        counts = (*case.sublayers(body), 1)
        for i, (name, n) in enumerate(zip(names, counts, strict=True)):
            E = (*seen.coatings, seen.substrate)[begin][0]
            begin += n
            material = known.get(plain_name(name))
            if material is None or material.low is None or material.high is None or material.E != E or n > 1:
                continue
            before = found.get(material.name)
            places = (*(before.places if before else ()), (body, i))
            found[material.name] = MaterialRange(material.name, material.low, material.high, places)
    return tuple(found.values())


def spread(
    case: Case, first: ContactAnswer, ranges: tuple[MaterialRange, ...], numerics: Mapping[str, Any]
) -> Spread:
    """The interval of ``first``, the answer to ``case``, over ``ranges``. Raises what its source raises."""
    fast, lows, highs = {**numerics, "estimate_uncertainty": False}, dict[Key, float](), dict[Key, float]()
    shares: dict[Key, tuple[str, float]] = {}
    values: dict[Key, float] = {(name,): value for name, (value, _) in first.numbers.items()}
    values |= {(at.body, at.quantity, at.where): at.value for at in first.extremes}
    for one in ranges:
        ends = []
        for E in (one.low, one.high):
            moved = with_moduli(case, dict.fromkeys(one.places, E))
            other = answer(moved.problem, first.source, fast, moved.residual, moved.layers)
            ends.append({apart.key: apart.value for apart in differences(first, other)})
        for key in values:
            changes = (0.0, *(end[key] for end in ends))
            lows[key] = lows.get(key, values[key]) + min(changes)
            highs[key] = highs.get(key, values[key]) + max(changes)
            shares[key] = max(
                (one.name, max(changes) - min(changes)),
                shares.get(key, ("", 0.0)),
                key=lambda share: share[1],
            )
    return Spread(ranges, {key: (lows[key], highs[key]) for key in values}, shares)
