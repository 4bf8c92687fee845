"""A profile: one quantity along one line.

Methods, closed forms and published tables are all compared as profiles, so that a comparison does not depend
on the kind of its sources.
"""

import re
from dataclasses import dataclass, replace

from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact
from verification.problem.point_answers import BALL, FLAT

EDGE_LINE = "surface near the edge"  # of a contact that is no disc
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
    """A straight line through ``origin`` [m] along ``direction``, a unit vector: a position is the distance.

    layer : of all its points in ``body``; None by the depth of each, on an interface the upper one.
    depth [m] : of a line along x in the plane y = 0, None of any other.
    """

    name: str
    depth: float | None
    layer: int | None
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    direction: tuple[float, float, float] = (1.0, 0.0, 0.0)
    body: str = FLAT

    @property
    def place(self) -> str:
        """The name without that of the body."""
        return self.name.removeprefix(ON_BALL)

    @property
    def coordinate(self) -> str:
        """The coordinate that runs along the line, s where none does."""
        return coordinate_of(self.name)

    def points(self, position: Array) -> tuple[Array, Array, Array]:
        """x, y, z [m] at ``position`` [m]."""
        x, y, z = (o + d * position for o, d in zip(self.origin, self.direction, strict=True))
        return x, y, z


def coordinate_of(line: str) -> str:
    """The coordinate that runs along the line of this name, s where none does."""
    along = {"axis": "z", "off plane": "s", "oblique": "s", "oblique surface": "s"}
    return along.get(line.removeprefix(ON_BALL), "x")


def line_of(name: str, problem: CoatedContact) -> Line:
    """The line called ``name``: "surface", "axis", or "interface k, upper|lower side" with k from 1.

    Before that "ball, " for a line of an elastic ball. The upper side is the one nearer to the contact.
    Besides the plane y = 0 "off plane", "oblique", "oblique surface", see ``oblique_lines``.
    Raises ValueError where the problem has no such line.
    """
    if name.startswith(ON_BALL) and problem.ball is not None:
        there = line_of(name.removeprefix(ON_BALL), problem.seen_from(BALL))
        return replace(there, name=name, body=BALL)
    if name == "surface" or (name == EDGE_LINE and problem.indenter is not None):
        return Line(name, 0.0, 0)
    if name == "axis":
        return Line(name, None, None, direction=(0.0, 0.0, 1.0))
    for line in oblique_lines(problem):
        if line.name == name:
            return line
    match = _INTERFACE.fullmatch(name)
    count = len(problem.coatings)
    if match is None or int(match[1]) > count:
        raise ValueError(
            f"line = {name!r}; this problem has surface, axis"
            + "".join(f", interface {k}, upper side | lower side" for k in range(1, count + 1))
            + "".join(f", {line.name}" for line in oblique_lines(problem))
        )
    k = int(match[1])
    depth = problem.interfaces[k - 1]
    return Line(name, depth, k - 1 if match[2] == "upper" else k, (0.0, 0.0, depth))


def lines_of(problem: CoatedContact) -> tuple[Line, ...]:
    """Lines of y = 0: surface, axis, both sides of each interface of the flat, then of an elastic ball."""
    names = []
    for body in problem.bodies:
        before = ON_BALL if body == BALL else ""
        names += [f"{before}surface", f"{before}axis"]
        names += [f"{before}{EDGE_LINE}"] if problem.indenter is not None else []
        for k in range(1, len(problem.seen_from(body).coatings) + 1):
            names += [f"{before}interface {k}, upper side", f"{before}interface {k}, lower side"]
    return tuple(line_of(name, problem) for name in names)


def all_lines(problem: CoatedContact) -> tuple[Line, ...]:
    """The lines on which sources are compared: those of the plane y = 0, then the others."""
    return lines_of(problem) + oblique_lines(problem)


def oblique_lines(problem: CoatedContact) -> tuple[Line, ...]:
    """Lines off the plane y = 0, which have all six stresses and all three displacements; of each body.

    off plane : through the axis along (2, 1), on which patches have their centres; 0.6 a_h deep, or 0.7 a_h
                where an interface is close to that.
    oblique : from (-0.9, -0.2, 0) a_h down below the contact, through the layers.
    oblique surface : on the surface through the origin, at 30 degrees from x.
    """
    a = problem.a_h
    found: list[Line] = []
    for body in problem.bodies:
        before = ON_BALL if body == BALL else ""
        close = any(abs(z - 0.6 * a) < 0.05 * a for z in problem.seen_from(body).interfaces)
        depth = (0.7 if close else 0.6) * a
        found += [
            Line(f"{before}off plane", None, None, (0.0, 0.0, depth), (0.8**0.5, 0.2**0.5, 0.0), body),
            Line(f"{before}oblique", None, None, (-0.9 * a, -0.2 * a, 0.0), (0.48, 0.36, 0.8), body),
            Line(f"{before}oblique surface", None, 0, direction=(0.75**0.5, 0.5, 0.0), body=body),
        ]
    return tuple(found)
