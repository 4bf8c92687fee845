"""Likely slips behind wrong answers: units, signs, axes, a for 2a, shifts, the contact edge.

Each slip predicts the wrong answer from the exact one. The slip that leaves the smallest rest is named, where
it explains nine tenths of the error at least.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import isclose, log
from typing import Any

import numpy as np

from verification.guests.case_exam import ALONG_SURFACE
from verification.guests.common_slips import (
    EDGE,
    EXPLAINED,
    THOUSANDS,
    UNITS,
    Explanation,
    explanation,
    fitted_shift,
    shift_message,
)
from verification.guests.exam_subjects import exact_profile, exact_radius, reference_of
from verification.judging.verdict import Outcome
from verification.problem.array_types import Array
from verification.problem.line_profile import Profile, coordinate_of
from verification.problem.quantity import STRESSES, unit_of
from verification.running.case_result import CaseResult

FINE = 2e-2  # relative: differences below may be those of a coarse grid
NEAR = 5e-3  # relative: two factors that differ by less are the same
SMALL = 1e-2  # of the largest value of a line: no error worth a message
MOST_GROUPS = 3
UNEXPLAINED = "no single slip explains it"
TWICE = {
    "contact_radius": {2.0: "the diameter 2 a in place of a"},
    "peak_pressure": {2 / 3: "the mean pressure in place of the largest", 1.5: "3/2 of the largest pressure"},
    "approach": {
        2.0: "twice the approach",
        0.5: "a^2/(2 R), the depth of the contact edge, in place of a^2/R",
    },
}


@dataclass(frozen=True)
class Slip:
    """A likely mistake: its ``message``, with the ``places`` (quantity, line) that it explains."""

    message: str
    places: tuple[tuple[str, str], ...]
    name: str = ""

    @property
    def explains(self) -> bool:
        """False where the message only says where the answers differ."""
        return not self.message.startswith(UNEXPLAINED)

    def __str__(self) -> str:
        lines: dict[str, list[str]] = {}
        for quantity, line in self.places:
            lines.setdefault(quantity, []).append(line)
        groups: dict[tuple[str, ...], list[str]] = {}
        for quantity, at in lines.items():
            groups.setdefault(tuple(at), []).append(quantity)
        shown = [
            ", ".join(quantities) + ("" if at == ("contact",) else f" on {'; '.join(at)}")
            for at, quantities in groups.items()
        ]
        if len(shown) > MOST_GROUPS:
            shown = [f"{', '.join(lines)} on {len({line for _, line in self.places})} lines"]
        return (
            f"{self.message} Explains {' and '.join(shown)}"
            if self.name
            else f"{' and '.join(shown)}: {self.message}"
        )


def slips(result: CaseResult, guest: str) -> list[Slip]:
    """The likely slips behind the answers of ``guest`` that do not agree, most places first.

    Those of the whole answer come first; what they explain is not named again.
    """
    wrong = [
        (claim.quantity, claim.line)
        for claim, verdict in result.verdicts
        if verdict.outcome in (Outcome.DISAGREES, Outcome.INCONCLUSIVE) and verdict.difference is not None
    ]
    if not wrong:
        return []
    zone = max(claim.edge for claim, _ in result.verdicts)
    result = _outside_zone(result, zone) if zone else result
    whole = explanation(result, guest, wrong)
    named = [Slip(slip.message, places, slip.name) for slip, places in whole.slips]
    explained = {place for slip in named for place in slip.places}
    expected = _expected(result, guest, whole)
    found: dict[str, list[tuple[str, str]]] = {}
    for quantity, line in wrong:
        # A number that a slip explains may be wrong for another reason too: p0 in MPa, and the mean.
        if (quantity, line) in explained and not (line == "contact" and whole.values[quantity, line][1]):
            continue
        messages = [_of_place(one, guest, quantity, line) for one in (expected, result)]
        message = next((m for m in messages if m and m.endswith("?")), messages[0])
        if message and not ((quantity, line) in explained and messages[0] is None):
            found.setdefault(message, []).append((quantity, line))
    rest = [Slip(message, tuple(places)) for message, places in found.items()]
    return [
        *sorted(named, key=lambda slip: -len(slip.places)),
        *sorted(rest, key=lambda slip: (not slip.explains, -len(slip.places))),
    ]


def _of_place(result: CaseResult, guest: str, quantity: str, line: str) -> str | None:
    """The message about one quantity on one line, or about one number."""
    mine, exact = result.profile_of.get((quantity, line, guest)), exact_profile(result, quantity, line)
    if mine is None or exact is None or not np.isfinite(mine.value).all():
        return None
    return _of_number(mine, exact) if line == "contact" else _of_line(mine, exact, result)


def _expected(result: CaseResult, guest: str, found: Explanation) -> CaseResult:
    """``result`` with what ``found`` predicts in place of the exact values, where it is closer."""
    profiles = []
    for p in result.profiles:
        mine = result.profile_of.get((p.quantity, p.line, guest))
        if p.source == reference_of(result.problem) and mine is not None:
            value, _ = found.values[p.quantity, p.line]
            value = np.where(np.isfinite(value), value, mine.value)
            if _norm(mine.value - value) < _norm(mine.value - p.value):
                p = replace(p, value=value)
        profiles.append(p)
    return replace(result, profiles=tuple(profiles))


def _outside_zone(result: CaseResult, zone: float) -> CaseResult:
    """``result`` without the points that its claims leave out around the contact edge."""
    a = exact_radius(result)
    profiles = []
    for p in result.profiles:
        keep = np.abs(np.abs(p.position) - a) >= zone * a
        uncertainty = None if p.uncertainty is None else p.uncertainty[keep]
        kept = replace(p, position=p.position[keep], value=p.value[keep], uncertainty=uncertainty)
        profiles.append(kept if p.line in ALONG_SURFACE else p)
    return replace(result, profiles=tuple(profiles))


def _of_number(mine: Profile, exact: Profile) -> str | None:
    value, true = float(mine.value[0]), float(exact.value[0])
    if true == 0 or isclose(value, true, rel_tol=NEAR):
        return None
    return _of_factor(value / true, mine.quantity)


def _of_factor(factor: float, quantity: str) -> str:
    """The message of a constant ``factor`` between an answer and the exact value."""
    sign = "of the opposite sign" if factor < 0 else ""
    size = abs(factor)
    if isclose(size, 1, rel_tol=NEAR):
        convention = _convention(quantity) if sign else ""
        return f"{sign}{convention}"
    named = THOUSANDS | UNITS.get(unit_of(quantity), {}) | TWICE.get(quantity, {})
    cause = _nearest(size, named)
    text = f"{size:.4g} times the exact value" + (f": {cause}?" if cause else "")
    return f"{sign}, {text}" if sign else text


def _convention(quantity: str) -> str:
    if quantity in ("tension_place", "sigma_xz"):
        return ": is x along sliding, and q the traction on the solid in +x?"
    if quantity == "pressure":
        return ": pressure is positive in compression"
    return ": compression positive? Stress is positive in tension here"


def _of_line(mine: Profile, exact: Profile, result: CaseResult) -> str | None:
    """The slip that leaves the smallest rest of the error along a line."""
    g, e, x = mine.value, exact.value, mine.position
    size = float(np.abs(e).max())
    error = _norm(g - e)
    if size == 0 or float(np.abs(g - e).max()) <= SMALL * size / 10:
        return None
    if not g.any():
        return "zero everywhere: not computed? Leave it out to have it counted as unsupported"
    best: tuple[float, str] | None = None
    for message, predicted, where in _candidates(mine, exact, result):
        keep = where if where is not None else np.ones(g.shape, dtype=bool)
        if keep.sum() < 5:
            continue
        rest = _norm((g - predicted)[keep])
        if rest <= max(EXPLAINED * _norm((g - e)[keep]), 1e-9 * size) and (
            best is None or rest < best[0] / 3
        ):
            best = (rest, message)
    if best is not None:
        return best[1]
    a = exact_radius(result)
    beside = np.abs(np.abs(x) - a) < EDGE * a
    if mine.line in ALONG_SURFACE and beside.any() and not beside.all():
        inside, outside = np.abs(g - e)[beside].max(), np.abs(g - e)[~beside].max()
        if outside < EXPLAINED * inside or (outside <= SMALL * size < inside):
            return (
                f"wrong at the contact edge alone, |r - a| < {EDGE:g} a: a patch or element across the edge? "
                "edge in guest.toml leaves a zone out"
            )
    worst = int(np.argmax(np.abs(g - e)))
    return (
        f"{UNEXPLAINED}: off by {np.abs(g - e)[worst] / size:.1e} of the largest value at "
        f"{coordinate_of(mine.line)} = {x[worst] / a:.3g} a, {error / _norm(e):.1e} on average"
    )


Candidate = tuple[str, Array, Any]


def _candidates(mine: Profile, exact: Profile, result: CaseResult) -> Iterator[Candidate]:
    """Message, predicted wrong answer, points where it is one (None for all), simplest first."""
    g, e, x = mine.value, exact.value, mine.position
    quantity, line = mine.quantity, mine.line
    yield _of_factor(-1.0, quantity), -e, None
    others = [name for name in STRESSES if name != quantity] if quantity in STRESSES else []
    for other in others:
        profile = exact_profile(result, other, line)
        if profile is not None and _norm(profile.value - e) > FINE * _norm(e):
            axes = set(quantity[-2:]) ^ set(other[-2:])
            cause = f": {' and '.join(sorted(axes))} transposed?" if len(axes) == 2 else ""
            yield f"equal to {other}{cause}", profile.value, None
            yield f"equal to -{other}{cause}", -profile.value, None
    for stretch, message in (
        (2.0, "as if every position were doubled: a for the diameter, or a radius for 2 r?"),
        (0.5, "as if every position were halved: the diameter 2 a in place of a?"),
        (1e3, "as if positions were taken in mm?"),
        (1e-3, "as if positions were taken in km: a factor of 1e3 in lengths?"),
    ):
        at = stretch * x
        inside = (at >= x.min()) & (at <= x.max())
        yield message, np.interp(at, x, e), inside
    factor = float(g @ e / (e @ e))
    if not isclose(factor, 1, rel_tol=NEAR):
        yield _of_factor(factor, quantity), factor * e, None
    a = exact_radius(result)
    if line != "axis" and (shift := fitted_shift(x, e, g, a)):
        inside = (np.abs(x) + abs(shift) < np.abs(x).max()) & (np.abs(np.abs(x) - a) > EDGE * a)
        yield shift_message(shift, a), np.interp(x - shift, x, e), inside
    offset = float(np.mean(g - e))
    yield f"off by the same {offset:.3g} {unit_of(quantity)} everywhere", e + offset, None


def _nearest(factor: float, names: dict[float, str]) -> str | None:
    near = [(abs(log(factor / known)), text) for known, text in names.items() if factor > 0]
    distance, text = min(near, default=(1.0, ""))
    return text if distance < 2 * NEAR else None


def _norm(values: Array) -> float:
    return float(np.sqrt(np.mean(np.square(values)))) if values.size else 0.0
