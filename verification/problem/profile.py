"""A profile: one quantity along one line of the plane y = 0.

Methods, closed forms and published tables are all compared as profiles, so that a comparison does not depend
on the kind of its sources.
"""

import re
from dataclasses import dataclass, replace

from verification.problem.arrays import Array
from verification.problem.contact import BALL, FLAT, CoatedContact

ON_BALL = f"{BALL}, "  # before the name of a line of the ball
_INTERFACE = re.compile(r"interface ([1-9]\d*), (upper|lower) side")


@dataclass(frozen=True, eq=False)
class Profile:
    """``value`` of ``quantity`` at ``position`` [m] along ``line``, in SI units.

    uncertainty : absolute, shape of ``value``; None where it is not stated, 0 of an exact value.
    ``line`` "contact" holds the numbers of the contact as a whole, at position 0.
    """

    quantity: str
    line: str
    position: Array
    value: Array
    source: str
    uncertainty: Array | None = None


@dataclass(frozen=True)
class Line:
    """A line of ``body`` in y = 0: along x at ``depth`` [m] in ``layer``, or the axis (depth None)."""

    name: str
    depth: float | None
    layer: int | None
    body: str = FLAT

    @property
    def place(self) -> str:
        """The name without that of the body."""
        return self.name.removeprefix(ON_BALL)

    @property
    def coordinate(self) -> str:
        """The coordinate that runs along the line."""
        return "z" if self.depth is None else "x"


def line_of(name: str, problem: CoatedContact) -> Line:
    """The line called ``name``: "surface", "axis", or "interface k, upper|lower side" with k from 1.

    Before that "ball, " for a line of an elastic ball. The upper side is the one nearer to the contact.
    Raises ValueError where the problem has no such line.
    """
    if name.startswith(ON_BALL) and problem.ball is not None:
        there = line_of(name.removeprefix(ON_BALL), problem.seen_from(BALL))
        return replace(there, name=name, body=BALL)
    if name == "surface":
        return Line(name, 0.0, 0)
    if name == "axis":
        return Line(name, None, None)
    match = _INTERFACE.fullmatch(name)
    count = len(problem.coatings)
    if match is None or int(match[1]) > count:
        raise ValueError(
            f"line = {name!r}; this problem has surface, axis"
            + "".join(f", interface {k}, upper side | lower side" for k in range(1, count + 1))
        )
    k = int(match[1])
    return Line(name, problem.interfaces[k - 1], k - 1 if match[2] == "upper" else k)


def lines_of(problem: CoatedContact) -> tuple[Line, ...]:
    """Surface, axis, then both sides of each interface of the flat; the same of an elastic ball."""
    names = []
    for body in problem.bodies:
        before = ON_BALL if body == BALL else ""
        names += [f"{before}surface", f"{before}axis"]
        for k in range(1, len(problem.seen_from(body).coatings) + 1):
            names += [f"{before}interface {k}, upper side", f"{before}interface {k}, lower side"]
    return tuple(line_of(name, problem) for name in names)
