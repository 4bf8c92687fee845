"""Protocol of the questions to a guest with its answers: a line of JSON each.

The package holds its JSON schema as ``protocol.schema.json``; both sides are checked against it. A line of an
answer begins with ``TOKEN``; all other lines are the guest's own, and ignored.
"""

import json
from typing import Annotated, Any, Literal

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    TypeAdapter,
    ValidationError,
    model_validator,
)

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


class GuestBall(_Strict):
    """The material of an elastic ball, its coatings from its surface inwards."""

    E: float
    nu: float
    coatings: list[Layer]


class SphereProblem(_Strict):
    """A parabolic sphere on a coated half-space, rigid without ``ball``; coatings from the surface down."""

    radius: float
    load: float
    friction: float
    coatings: list[Layer]
    substrate: Layer
    ball: GuestBall | None = None


class EllipsoidProblem(_Strict):
    """A rigid ellipsoid; ``radius_x``, ``radius_y`` : its radii of curvature."""

    radius_x: float
    radius_y: float
    load: float
    friction: float
    coatings: list[Layer]
    substrate: Layer


class DiscProblem(_Strict):
    """A uniform pressure on a disc around the origin; coatings from the surface down."""

    load_radius: float
    pressure: float
    coatings: list[Layer]
    substrate: Layer


class SquareProblem(_Strict):
    """A uniform pressure on a square of ``side`` around the origin; coatings from the surface down."""

    side: float
    pressure: float
    coatings: list[Layer]
    substrate: Layer


Problem = SphereProblem | EllipsoidProblem | DiscProblem | SquareProblem


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
    edge : exact contact radius, around which a largest tension is to be searched.
    units : of length, stress and force of all numbers, in the question and in its answer.
    """

    protocol: Literal["coatcheck-guest/1"] = VERSION
    id: str
    problem: Problem
    parameter: dict[str, float | int] = Field(default_factory=dict)
    contact: list[str]
    lines: list[LineOfPoints]
    edge: float | None = None
    units: dict[str, str] | None = None


def _number(value: Any) -> Any:
    """NaN and infinity, which JSON does not have, as text; null as NaN."""
    integer = isinstance(value, int) and not isinstance(value, bool)
    if value is None:
        return float("nan")
    return float(value) if integer or (isinstance(value, str) and value in _NOT_FINITE) else value


Number = Annotated[float, BeforeValidator(_number)]
# By line, or "contact", then by quantity: one number of the contact, as many as points of a line.
Numbers = dict[str, dict[str, Number | list[Number]]]
Reasons = dict[str, dict[str, Annotated[str, Field(max_length=2000)]]]
_VALUE: TypeAdapter[Any] = TypeAdapter(Number | list[Number], config=ConfigDict(strict=True))


class GuestAnswer(_Strict):
    """The answer to the question ``id``: one of ``values``, ``unsupported`` with the reason, ``error``.

    uncertainty : absolute, of the same shape as the values, where the guest states one.
    missing, failed : why single quantities are not computed, or could not be, by line and quantity.
    units : of the values, which have to be those of guest.toml.   warnings : of coatcheck, about the answer.
    """

    protocol: Literal["coatcheck-guest/1"]
    id: str
    values: Numbers | None = None
    uncertainty: Numbers = Field(default_factory=dict)
    missing: Reasons = Field(default_factory=dict)
    failed: Reasons = Field(default_factory=dict)
    unsupported: Annotated[str, Field(max_length=2000)] | None = None
    error: Annotated[str, Field(max_length=2000)] | None = None
    units: dict[str, str] | None = None
    warnings: list[str] = Field(default_factory=list)

    @model_validator(mode="after")
    def _one_of_three(self) -> "GuestAnswer":
        given = [n for n in ("values", "unsupported", "error") if getattr(self, n) is not None]
        if len(given) != 1:
            raise ValueError(f"needs exactly one of values, unsupported, error, not {given or 'none'}")
        return self


def parse_answer(line: bytes | str, question: Question) -> GuestAnswer:
    """The answer in ``line``, without its token, to ``question``; what is wrong in it costs that quantity.

    Raises ProtocolError where it is no answer to this question at all.
    """
    try:
        content = json.loads(line)
    except (ValueError, RecursionError) as error:
        text = line.decode(errors="replace") if isinstance(line, bytes) else line
        raise ProtocolError(f"its answer is not JSON ({error}): {text[:60]!r}") from None
    if not isinstance(content, dict):
        raise ProtocolError(
            f"its answer is {type(content).__name__}, not an object with protocol, id, values"
        )
    if content.get("protocol") not in (None, VERSION):
        raise ProtocolError(f"it answers in protocol {str(content['protocol'])[:60]!r}; this is {VERSION}")
    if content.get("id") != question.id:
        raise ProtocolError(
            f"it answers the question {str(content.get('id'))[:60]!r}; {question.id!r} was asked"
        )
    if question.units is not None and content.get("units") not in (None, question.units):
        raise ProtocolError(f"its answer is in {content['units']}; units in guest.toml are {question.units}")
    warnings = [
        f"unknown key {key[:60]!r} is ignored" for key in content if key not in GuestAnswer.model_fields
    ]
    given = {key: value for key, value in content.items() if key in GuestAnswer.model_fields}
    if isinstance(given.get("values"), dict):
        given |= checked(given["values"], given.get("uncertainty"), question, warnings)
    try:
        answer = GuestAnswer.model_validate(given | {"warnings": warnings[:20]})
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(map(str, first["loc"]))[:80] or "answer"
        raise ProtocolError(f"its answer is not of the protocol: {where}: {first['msg'][:200]}") from None
    reasons = {kind: _merged(given.get(kind), content.get(kind)) for kind in ("missing", "failed")}
    return answer.model_copy(update=reasons)


def _merged(own: Any, stated: Any) -> Reasons:
    """Reasons of coatcheck and of the guest, of which what is no text is dropped."""
    found: Reasons = {line: dict(by) for line, by in (own or {}).items()}
    for line, by in stated.items() if isinstance(stated, dict) else ():
        for quantity, why in by.items() if isinstance(by, dict) else ():
            found.setdefault(str(line), {}).setdefault(quantity, str(why)[:500])
    return found


def checked(values: Any, uncertainty: Any, question: Question, warnings: list[str]) -> dict[str, Any]:
    """The values with their uncertainties that are of the protocol; why the others are missing or failed."""
    sizes = {line.line: len(line.x) for line in question.lines}
    wanted = {line.line: set(line.quantities) for line in question.lines} | {"contact": set(question.contact)}
    found: dict[str, dict[str, dict[str, Any]]] = {
        n: {} for n in ("values", "uncertainty", "missing", "failed")
    }
    for kind, numbers in (("values", values), ("uncertainty", uncertainty)):
        for line, by in numbers.items() if isinstance(numbers, dict) else ():
            if line not in wanted or not isinstance(by, dict):
                warnings.append(
                    f"{kind}: line {line[:60]!r} was not asked, or has no quantities; it is ignored"
                )
                continue
            for quantity, value in by.items():
                if quantity not in wanted[line]:
                    warnings.append(f"{kind} on {line}: {quantity[:60]!r} was not asked; it is ignored")
                elif kind == "uncertainty" and quantity not in found["values"].get(line, {}):
                    if value is not None and quantity not in found["failed"].get(line, {}):
                        warnings.append(f"uncertainty of {quantity} on {line}, of which no values are given")
                elif _empty(value):
                    if kind == "values":
                        found["missing"].setdefault(line, {})[quantity] = "given as null"
                else:
                    number, reason = _checked(value, sizes.get(line))
                    if reason is None:
                        found[kind].setdefault(line, {})[quantity] = number
                    else:
                        found["failed"].setdefault(line, {})[quantity] = (
                            f"{kind}: {quantity} on {line} {reason}"
                        )
                        found["values"].get(line, {}).pop(quantity, None)
    return found


def _empty(value: Any) -> bool:
    return value is None or (isinstance(value, list) and bool(value) and all(v is None for v in value))


def _checked(value: Any, size: int | None) -> tuple[Any, str | None]:
    """The number, or list of ``size`` numbers where that is given, or why ``value`` is none."""
    try:
        number = _VALUE.validate_python(value)
    except ValidationError as error:
        first = error.errors(include_url=False)[-1]
        return None, f"is {str(first['input'])[:40]!r}, not a number"
    count = len(number) if isinstance(number, list) else None
    if count != size:
        shown = "one number" if count is None else f"{count} values"
        return None, f"has {shown}; {'one number is' if size is None else f'{size} values are'} needed"
    return number, None
