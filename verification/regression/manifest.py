"""Manifest of a case: what a run judged of it, so that no later run judges less unnoticed.

Taken from verdicts and invariants, not from the claims of a case file: the cap and the scale in force, the
number, the extent and the widest gap of the judged points. What is missing, wider or fewer than recorded is a
failure on every machine; what is new, narrower or more is reported.
"""

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from verification.judging.verdict import Judged, Outcome
from verification.regression.number_drift import FACTOR
from verification.running.case_result import CaseResult

# A scale follows the solved p0, a position the solved a: what changes them by less changes no coverage.
TOLERANCE = 1e-3


@dataclass(frozen=True)
class Comparisons:
    """The comparisons (quantity, source, source) on one line that were judged alike."""

    line: str
    judged: Judged
    pairs: tuple[tuple[str, str, str], ...]


@dataclass(frozen=True)
class Manifest:
    """All that was judged of one case.

    invariants : name, source, cap, number of residuals, largest bound.   sources : those with a result.
    cells : of a published case, the number of values that count.
    """

    comparisons: tuple[Comparisons, ...]
    invariants: tuple[tuple[str, str, float, int, float], ...]
    sources: tuple[str, ...]
    cells: dict[str, int]


@dataclass(frozen=True)
class ManifestDifference:
    """``message``: what was judged of ``case`` otherwise than recorded, ``less`` or more, ``count`` times."""

    case: str
    message: str
    count: int
    less: bool


def manifest_of(result: CaseResult) -> Manifest:
    """Manifest of the run that made ``result``; comparisons without a result are left out."""
    alike = defaultdict(list)
    for claim, verdict in result.verdicts:
        if verdict.judged is not None:
            alike[claim.line, verdict.judged].append((claim.quantity, *claim.between))
    comparisons = tuple(Comparisons(*key, tuple(pairs)) for key, pairs in alike.items())
    invariants = tuple(
        (one.name, one.source, one.cap, one.points, one.widest or 0.0) for one in result.invariants
    )
    sources = tuple(source.source for source in result.sources if source.failure is None)
    cells = {}
    if result.published:
        cells["counted values"] = sum(sum(column["counted"]) for column in result.published["columns"])
    return Manifest(comparisons, invariants, sources, cells)


def differences(result: CaseResult, then: Manifest) -> tuple[ManifestDifference, ...]:
    """Differences of the run that made ``result`` from ``then``, what is less first.

    A comparison or invariant without a result fails by itself and is not named a second time.
    """
    now = manifest_of(result)
    lost: set[tuple[str, ...]]
    lost = {(c.line, c.quantity, *c.between) for c, v in result.verdicts if v.judged is None}
    lost |= {(one.name, one.source) for one in result.invariants if one.outcome is Outcome.NO_RESULT}
    found = Counter(_differences(_entries(then), _entries(now), lost))
    rows = [ManifestDifference(result.name, message, n, less) for (message, less), n in found.items()]
    return tuple(sorted(rows, key=lambda row: not row.less))


def differing_tests(then: Mapping[str, int], now: Mapping[str, int]) -> tuple[ManifestDifference, ...]:
    """Differences of the self-tests, of which ``then`` and ``now`` state the number of known answers."""

    def entries(tests: Mapping[str, int]) -> _Entries:
        return {("self-test", name): {"known answers": n} for name, n in tests.items()}

    found = _differences(entries(then), entries(now), set())
    return tuple(ManifestDifference("", message, 1, less) for message, less in found)


def manifest_message(found: Sequence[ManifestDifference]) -> str:
    """One sentence on all ``found``; empty where there is nothing to report."""
    less = [row for row in found if row.less]
    rows = less or found
    if not rows:
        return ""
    first = ", ".join(filter(None, (rows[0].case, rows[0].message)))
    end = f"{sum(row.count for row in rows)} differences, first {first}"
    if less:
        return f"less is judged than the manifest records; {end}"
    return f"more is judged than recorded: coatcheck baseline update; {end}"


_Entries = dict[tuple[str, ...], dict[str, float]]
_COUNTS = ("points", "number", "known answers")


def _entries(manifest: Manifest) -> _Entries:
    """Properties by what they belong to; the first two words of a key name it in messages."""
    found: _Entries = {}
    for group in manifest.comparisons:
        judged = group.judged
        first, last = judged.extent
        properties = {
            "cap": judged.cap,
            "scale": judged.scale,
            "points": judged.points,
            "first point": first,
            "last point": last,
            "widest gap": judged.gap,
        }
        found |= {(group.line, *pair): properties for pair in group.pairs}
    for name, source, cap, points, bound in manifest.invariants:
        found[name, source] = {"cap": cap, "points": points, "largest bound": bound}
    found |= {("source", source): {} for source in manifest.sources}
    found |= {("published", name): {"number": count} for name, count in manifest.cells.items()}
    return found


def _differences(then: _Entries, now: _Entries, lost: set[tuple[str, ...]]) -> Iterator[tuple[str, bool]]:
    for key, before in then.items():
        if key in lost:
            continue
        if key not in now:
            yield f"{', '.join(key[:2])}: not judged", True
            continue
        length = before.get("last point", 0.0) - before.get("first point", 0.0)
        for name, old in before.items():
            new = now[key][name]
            # In the direction of less: a smaller number of points, a larger cap.
            growth = old - new if name in (*_COUNTS, "last point") else new - old
            room = TOLERANCE * (length if name in ("first point", "last point") else abs(old))
            room = 0 if name in _COUNTS else (FACTOR - 1) * old if name == "largest bound" else room
            if not abs(growth) <= room:
                what = key[0] if len(key) > 2 else ", ".join(key)
                yield f"{what}: {name} {new:.6g} in place of {old:.6g}", not growth < 0
    for key in (key for key in now if key not in then):
        yield f"{', '.join(key[:2])}: not recorded", False
