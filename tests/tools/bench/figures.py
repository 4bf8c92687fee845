"""Figures of the benchmark: which work is measured over which, with the ratio that is asked.

Works over another commit, on one thread, are compared by processor time; the contact of a sphere beside its
peers, on one and more threads, by wall time.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import zip_longest
from pathlib import Path
from statistics import median
from typing import Literal

from bench.judge import LIMIT
from bench.turns import HERE, Work, in_turn

__all__ = [
    "ASKED_SIZES",
    "PEERS",
    "REFERENCE",
    "ROOMS",
    "Figure",
    "Group",
    "Other",
    "Part",
    "groups",
    "measure",
]

REFERENCE = "dfc1d79"  # the commit over which ratios are asked
ROOMS = "cf67b33"  # that of the default run: its rooms are today's, its methods those of REFERENCE
Part = Literal["solve", "stress", "elements", "contact", "default-run"]
PEERS = ("tamaas", "aspher")
CONTACT = "contact"  # of the semi-analytical method
ASKED_SIZES = (512, 1024, 2048)
_PEERS_ASKED = {"tamaas": 0.008, "aspher": 0.15}
_CONVOLUTIONS_ASKED = dict(zip(ASKED_SIZES, (8.0, 4.0, 4.0), strict=True))  # on two threads


@dataclass(frozen=True)
class Figure:
    """Ratio of ``name`` to ``over``, turn by turn.

    asked : the largest median, None where nothing is asked.   may_be_equal : of works of which chance decides
    the median, so that it is missed only where every turn is above it.
    """

    name: str
    over: str
    asked: float | None
    ratios: tuple[float, ...]
    may_be_equal: bool = False

    @property
    def median(self) -> float:
        """Median of the turns."""
        return median(self.ratios)

    @property
    def missed(self) -> bool:
        """Whether the median, of works that may be equal every turn, is above what is asked."""
        found = min(self.ratios) if self.may_be_equal else self.median
        return self.asked is not None and found > self.asked


@dataclass(frozen=True)
class Ratio:
    """A figure to measure: ``work`` over ``to``, two keys of a group, None of a ratio it measures itself."""

    work: str
    to: str | None
    over: str
    asked: float | None = None


@dataclass(frozen=True)
class Group:
    """Works done in turn with the ratios between them; ``processor`` : of their processor time."""

    works: Mapping[str, Work]
    ratios: tuple[Ratio, ...]
    processor: bool = True


@dataclass(frozen=True)
class Other:
    """The other commit: its short name, its folder, the interpreter that has what it needs."""

    name: str
    root: Path
    python: str


def groups(
    parts: Sequence[Part],
    *,
    other: Other | None,
    sizes: Sequence[int] = (),
    threads: Sequence[int] = (1, 2),
    peers: Sequence[str] = (),
    fast: bool = False,
) -> list[Group]:
    """What is measured of ``parts``, those over another commit only with ``other``.

    sizes : of the contact, ASKED_SIZES unless given.   threads, peers : of the contact.   fast : the extra
    "fast" is installed, of the finite elements.
    """
    found: list[Group] = []
    if other is not None:
        if "solve" in parts:
            found += [
                _over(other, {"solve with uncertainty": Work("solve", (True,))}, 0.3),
                _over(other, {"solve without uncertainty": Work("solve", (False,))}, 0.45),
            ]
        if "stress" in parts:
            found.append(_over(other, {"200 stresses across depths": Work("stress")}, 0.3))
        if "elements" in parts:
            for kind, friction, asked in (("frictionless", 0.0, (0.6, 0.4)), ("sliding", 0.3, (0.5, 0.3))):
                works = {f"elements, {kind}": Work("elements", (friction, False))}
                if fast:
                    works[f"elements, {kind}, fast"] = Work("elements", (friction, True))
                found.append(_over(other, works, *asked))
    if "contact" in parts:
        found += [_contact(patches, threads, peers) for patches in sizes or ASKED_SIZES]
    if other is not None and "default-run" in parts:
        work = Work("default_run", _shared_cases(other.root))
        found.append(_over(other, {"default run": work}, 0.6, asked_over=ROOMS))
    return found


def _shared_cases(root: Path) -> tuple[str, ...]:
    """Names of the shipped contacts that this commit and the one at ``root`` both have."""
    ours, theirs = (
        {path.stem for path in (one / "verification" / "cases").rglob("[0-9][0-9]_*.toml")}
        for one in (HERE, root)
    )
    return tuple(sorted(ours & theirs))


def _over(other: Other, works: dict[str, Work], *asked: float, asked_over: str = REFERENCE) -> Group:
    """The ``works`` over the first of them as the other commit does it.

    asked : of each, over the commit ``asked_over`` alone.
    """
    first = next(iter(works.values()))
    limits = asked if other.name == asked_over else ()
    ratios = tuple(
        Ratio(name, other.name, other.name, limit) for name, limit in zip_longest(works, limits[: len(works)])
    )
    before = replace(first, root=other.root, python=other.python)
    return Group(works | {other.name: before}, ratios)


def _contact(patches: int, threads: Sequence[int], peers: Sequence[str]) -> Group:
    """The sphere on N x N patches over its peers, over one convolution, over fewer threads."""
    names = {count: f"N = {patches}, {count} thread{'s' * (count > 1)}" for count in threads}
    works = {
        f"{solver}, {names[count]}": Work("sphere", (solver, patches, count), threads=count)
        for count in threads
        for solver in (CONTACT, *peers, "convolution")
    }
    ratios = []
    for count in threads:
        ours = f"{CONTACT}, {names[count]}"
        for peer in peers:
            asked = _PEERS_ASKED[peer] if patches in ASKED_SIZES and count in (1, 2) else None
            ratios.append(Ratio(ours, f"{peer}, {names[count]}", peer, asked))
        asked = _CONVOLUTIONS_ASKED.get(patches) if count == 2 else None
        ratios.append(Ratio(ours, f"convolution, {names[count]}", "convolution", asked))
        if count != threads[0]:
            itself = f"{names[count]}, in one process"
            works[itself] = Work("more_threads", (patches, threads[0], count), threads=max(threads))
            asked = 1.0 if (threads[0], count) == (1, 2) else None
            fewer = names[threads[0]].partition(", ")[2]
            ratios.append(Ratio(itself, None, fewer, asked))
    return Group(works, tuple(ratios), processor=False)


def measure(group: Group, rounds: int, progress: Callable[[str], None] = lambda name: None) -> list[Figure]:
    """The figures of a group, in turn over ``rounds``; with the peak memory of the contact.

    A solver that misses the judge is a figure of its own, its residual over the limit. Raises RuntimeError
    where a work fails.
    """
    times = in_turn(group.works, rounds, progress=progress)
    found = []
    for ratio in group.ratios:
        values = times[ratio.work].ratios
        if ratio.to is not None:
            seconds = (times[name].of(group.processor) for name in (ratio.work, ratio.to))
            values = tuple(one / other for one, other in zip(*seconds, strict=True))
        found.append(Figure(ratio.work, ratio.over, ratio.asked, values, may_be_equal=ratio.to is None))
    for name, taken in times.items():
        work = group.works[name]
        if name.startswith(CONTACT) and taken.growth:
            doubles = 8.0 * float(work.arguments[1]) ** 2
            found.append(Figure(f"peak memory, {name}", "N x N doubles", None, (taken.growth / doubles,)))
        if not taken.residual <= LIMIT:
            found.append(Figure(f"residual, {name}", "judge", 1.0, (taken.residual / LIMIT,)))
    return found
