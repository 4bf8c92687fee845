"""Numbers with a unit in files of users: "210 GPa", "3 um", "20 N" beside bare SI numbers.

A text is a decimal number and a unit; pint knows the units. The conversion is exact in decimal digits: "3 um"
is the same number as 3e-6.
"""

import re
from collections.abc import Callable
from decimal import Decimal
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field, ValidationError, WrapValidator

if TYPE_CHECKING:
    from pint import UnitRegistry

__all__ = ["AnyPascals", "InSI", "Metres", "Newtons", "Pascals", "Seconds", "in_si", "of_file"]

LONGEST = 60  # characters of a text
_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,4})?)(.*)", re.ASCII | re.DOTALL)
# Pint evaluates expressions; from an untrusted file it only gets names with small exponents.
_NAME = r"[A-Za-zµμÅ]+(?:(?:\^|\*\*)[1-9]|[²³])?"
_UNIT = re.compile(rf"{_NAME}(?:(?: ?[*/] ?| ){_NAME}){{0,4}}")
_KINDS = {"m": "length", "Pa": "stress", "N": "force", "s": "duration"}
_EXAMPLES = {"m": "3 um", "Pa": "210 GPa", "N": "20 N", "s": "120 s"}
_USUAL = {
    "m": ("m", "mm", "um", "nm", "inch"),
    "Pa": ("Pa", "kPa", "MPa", "GPa", "TPa", "N/mm^2", "ksi"),
    "N": ("N", "mN", "uN", "kN", "kgf", "lbf"),
    "s": ("s", "min", "h"),
}


class InSI(float):
    """A number given with a unit: it is in SI, whatever the unit of bare numbers in its file."""


def in_si(text: str, unit: str) -> InSI:
    """The number in ``unit`` (m, Pa, N, s) that ``text`` gives with a unit of the same kind.

    Raises ValueError with a message that names the unit and goes before ", not 'text'".
    """
    needs = f'must be a number or a {_KINDS[unit]} such as "{_EXAMPLES[unit]}"'
    parts = _NUMBER.fullmatch(text.strip()) if len(text) <= LONGEST else None
    if parts is None:
        raise ValueError(needs)
    name = parts[2].strip()
    if not name:
        raise ValueError(f"{needs}; without a unit leave out the quotation marks")
    if name.startswith((",", "_")):
        raise ValueError(f"{needs}, with a decimal point")
    try:
        if not _UNIT.fullmatch(name):
            raise ValueError(name)
        found = _registry().parse_units(name)
        alike = found.is_compatible_with(unit)
    except Exception:  # pint raises errors of many kinds for a text that is no unit
        near = [usual for usual in _USUAL[unit] if usual.casefold() == name.casefold()]
        raise ValueError(
            f"{needs}; the unit {name!r} is unknown" + (f", did you mean {near[0]}?" if near else "")
        ) from None
    if not alike:
        raise ValueError(f"{needs}; {name!r} is no unit of {_KINDS[unit]}")
    return InSI(_registry().Quantity(Decimal(parts[1]), found).to(unit).magnitude)


def of_file(value: float, unit: float) -> float:
    """``value`` in SI: as it is where it was given with a unit, otherwise times the ``unit`` of its file."""
    return float(value) if isinstance(value, InSI) else value * unit


@cache
def _registry() -> "UnitRegistry[Decimal]":
    # Half a second, which a file of bare numbers does not need.
    from pint import UnitRegistry

    return UnitRegistry(non_int_type=Decimal)


def _with_unit(unit: str) -> WrapValidator:
    def validated(given: Any, checked: Callable[[Any], float]) -> float:
        if not isinstance(given, str):
            return checked(given)
        value = in_si(given, unit)
        try:
            return InSI(checked(float(value)))
        except ValidationError as error:
            raise ValueError(error.errors(include_url=False)[0]["msg"]) from None

    return WrapValidator(validated)


Metres = Annotated[float, Field(gt=0), _with_unit("m")]
Pascals = Annotated[float, Field(gt=0), _with_unit("Pa")]
AnyPascals = Annotated[float, _with_unit("Pa")]  # of either sign
Newtons = Annotated[float, Field(gt=0), _with_unit("N")]
Seconds = Annotated[float, Field(gt=0), _with_unit("s")]
