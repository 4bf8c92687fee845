"""Protocol of the questions to a guest with its answers: a line of JSON each.

The package holds its JSON schema as ``protocol.schema.json``; both sides are checked against it. A line of an
answer begins with ``TOKEN``; all other lines are the guest's own, and ignored.
"""

import json
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, model_validator

VERSION: Literal["coatcheck-guest/1"] = "coatcheck-guest/1"
TOKEN = "COATCHECK"
_NOT_FINITE = ("NaN", "nan", "Infinity", "inf", "-Infinity", "-inf")


class ProtocolError(ValueError):
    """An answer that does not follow the protocol; the message says where."""


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, ser_json_inf_nan="strings")


class Layer(_Strict):
    """A material: Young's modulus, Poisson's ratio, of a coating its thickness."""

    E: float
    nu: float
    thickness: float | None = None


class ElasticBall(_Strict):
    """The material of an elastic ball, its coatings from its surface inwards."""

    E: float
    nu: float
    coatings: list[Layer]


class Sphere(_Strict):
    """A parabolic sphere on a coated half-space, rigid without ``ball``; coatings from the surface down."""

    radius: float
    load: float
    friction: float
    coatings: list[Layer]
    substrate: Layer
    ball: ElasticBall | None = None


class Ellipsoid(_Strict):
    """A rigid ellipsoid; ``radius_x``, ``radius_y`` : its radii of curvature."""

    radius_x: float
    radius_y: float
    load: float
    friction: float
    coatings: list[Layer]
    substrate: Layer


class Disc(_Strict):
    """A uniform pressure on a disc around the origin; coatings from the surface down."""

    load_radius: float
    pressure: float
    coatings: list[Layer]
    substrate: Layer


class Square(_Strict):
    """A uniform pressure on a square of ``side`` around the origin; coatings from the surface down."""

    side: float
    pressure: float
    coatings: list[Layer]
    substrate: Layer


Problem = Sphere | Ellipsoid | Disc | Square


class LineOfPoints(_Strict):
    """Points x, y, z with the layer of each, counted from 0 at the surface; the quantities wanted there.

    body : "flat" or "ball", in which z counts into the ball.
    """

    line: str
    body: str = "flat"
    quantities: list[str]
    x: list[float]
    y: list[float]
    z: list[float]
    layer: list[int]


class Question(_Strict):
    """One problem to solve, in the units of the guest.

    parameter : numerical parameters of this solve.   contact : numbers of the contact as a whole wanted.
    """

    protocol: Literal["coatcheck-guest/1"] = VERSION
    id: str
    problem: Problem
    parameter: dict[str, float | int] = Field(default_factory=dict)
    contact: list[str]
    lines: list[LineOfPoints]


def _number(value: Any) -> Any:
    """NaN and infinity, which JSON does not have, as text."""
    integer = isinstance(value, int) and not isinstance(value, bool)
    return float(value) if integer or (isinstance(value, str) and value in _NOT_FINITE) else value


Number = Annotated[float, BeforeValidator(_number)]
# By line, or "contact", then by quantity: one number of the contact, as many as points of a line.
Numbers = dict[str, dict[str, Number | list[Number]]]


class Answer(_Strict):
    """The answer to the question ``id``: one of ``values``, ``unsupported`` with the reason, ``error``.

    uncertainty : absolute, of the same shape as the values, where the guest states one.
    """

    protocol: Literal["coatcheck-guest/1"]
    id: str
    values: Numbers | None = None
    uncertainty: Numbers = Field(default_factory=dict)
    unsupported: Annotated[str, Field(max_length=2000)] | None = None
    error: Annotated[str, Field(max_length=2000)] | None = None

    @model_validator(mode="after")
    def _one_of_three(self) -> "Answer":
        given = [n for n in ("values", "unsupported", "error") if getattr(self, n) is not None]
        if len(given) != 1:
            raise ValueError(f"needs exactly one of values, unsupported, error, not {given or 'none'}")
        return self


def parse_answer(line: bytes | str, question: Question) -> Answer:
    """The answer in ``line``, without its token, to ``question``. Raises ProtocolError."""
    try:
        content = json.loads(line)
    except (ValueError, RecursionError) as error:
        text = line.decode(errors="replace") if isinstance(line, bytes) else line
        raise ProtocolError(f"its answer is not JSON ({error}): {text[:60]!r}") from None
    if isinstance(content, dict) and content.get("protocol") not in (None, VERSION):
        raise ProtocolError(f"it answers in protocol {str(content['protocol'])[:60]!r}; this is {VERSION}")
    try:
        answer = Answer.model_validate(content)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(map(str, first["loc"]))[:80] or "answer"
        raise ProtocolError(f"its answer is not of the protocol: {where}: {first['msg'][:200]}") from None
    check(answer, question)
    return answer


def check(answer: Answer, question: Question) -> None:
    """Raises ProtocolError where ``answer`` is of another question, or of another number of values."""
    if answer.id != question.id:
        raise ProtocolError(f"it answers the question {answer.id[:60]!r}; {question.id!r} was asked")
    sizes = {line.line: len(line.x) for line in question.lines}
    wanted = {line.line: set(line.quantities) for line in question.lines} | {"contact": set(question.contact)}
    for kind, numbers in (("values", answer.values or {}), ("uncertainty", answer.uncertainty)):
        for line, found in numbers.items():
            if line not in wanted:
                raise ProtocolError(f"{kind}: there is no line {line[:60]!r}; {', '.join(wanted)} were asked")
            for quantity, value in found.items():
                if quantity not in wanted[line]:
                    raise ProtocolError(f"{kind} on {line}: {quantity[:60]!r} was not asked")
                count = len(value) if isinstance(value, list) else None
                if count != sizes.get(line):
                    shown = "one number" if count is None else f"{count} values"
                    needed = "one number is" if line == "contact" else f"{sizes[line]} values are"
                    raise ProtocolError(f"{kind}: {quantity} on {line} has {shown}; {needed} needed")
                if kind == "uncertainty" and quantity not in (answer.values or {}).get(line, {}):
                    raise ProtocolError(f"uncertainty of {quantity} on {line}, of which no values are given")
