"""Numbers with a unit in files of users: "210 GPa", "3 um", "20 N" beside bare SI numbers.

A text is a decimal number and a unit; pint knows the units. The conversion is exact in decimal digits: "3 um"
is the same number as 3e-6.
"""

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import BaseModel, Field, ValidationError, WrapValidator

if TYPE_CHECKING:
    from pint import UnitRegistry

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
# Powers of ten of the units of most files, for which pint, half a second, need not be imported.
METRIC = {
    "m": {"m": 0, "mm": -3, "um": -6, "µm": -6, "nm": -9},
    "Pa": {"Pa": 0, "kPa": 3, "MPa": 6, "GPa": 9, "TPa": 12},
    "N": {"N": 0, "mN": -3, "uN": -6, "kN": 3},
    "s": {"s": 0},
}


class InSI(float):
    """A number given with a ``unit``: it is in SI, whatever the unit of bare numbers in its file."""

    unit = ""

    @classmethod
    def given_in(cls, value: float, unit: str) -> "InSI":
        found = cls(value)
        found.unit = unit
        return found


@dataclass(frozen=True)
class Units:
    """Units in which results are shown: names with the SI value of 1."""

    length: str = "µm"
    metre: float = 1e-6
    stress: str = "MPa"
    pascal: float = 1e6

    def shown_stress(self, value: float) -> str:
        """A given stress [Pa] with its unit."""
        return f"{value / self.pascal:.4g} {self.stress}"

    def shown_length(self, value: float) -> str:
        """A given length [m] with its unit."""
        return f"{value / self.metre:.4g} {self.length}"


# Keys whose units are those of results. Moduli are in GPa in any file, without a wish for stresses in GPa.
_LENGTHS = ("thickness",)
_STRESSES = ("strength", "residual_stress", "hardness", "yield_strength")


def units_of(file: BaseModel) -> Units:
    """Units of the results shown: of the first coating thickness, of the first strength or residual stress.

    µm and MPa for those that have no unit in the file.
    """
    given = list(_with_units(file, ""))
    length = next((one.unit for key, one in given if key in _LENGTHS), "um")
    stress = next((one.unit for key, one in given if key in _STRESSES), "MPa")
    metre, pascal = float(in_si(f"1 {length}", "m")), float(in_si(f"1 {stress}", "Pa"))
    return Units(length.replace("um", "µm"), metre, stress, pascal)


def _with_units(part: Any, key: str) -> Iterator[tuple[str, InSI]]:
    """Numbers given with a unit under the key, of those above, that holds them, in the order of the file."""
    if isinstance(part, InSI):
        yield key, part
    elif isinstance(part, BaseModel | dict):
        for name, value in part if isinstance(part, BaseModel) else part.items():
            yield from _with_units(value, name if name in _LENGTHS + _STRESSES else key)
    elif isinstance(part, list):
        for value in part:
            yield from _with_units(value, key)


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
    if name in METRIC[unit]:
        return InSI.given_in(float(Decimal(parts[1]).scaleb(METRIC[unit][name])), name)
    try:
        if not _UNIT.fullmatch(name):
            raise ValueError(name)
        found = _registry().parse_units(name)
        alike = found.is_compatible_with(unit)
    except Exception:  # pint raises errors of many kinds for a text that is not a unit
        near = [usual for usual in _USUAL[unit] if usual.casefold() == name.casefold()]
        raise ValueError(
            f"{needs}; the unit {name!r} is unknown" + (f", did you mean {near[0]}?" if near else "")
        ) from None
    if not alike:
        raise ValueError(f"{needs}; {name!r} is not a unit of {_KINDS[unit]}")
    value = _registry().Quantity(Decimal(parts[1]), found).to(unit).magnitude
    return InSI.given_in(float(value), name)


def of_file(value: float, unit: float) -> float:
    """``value`` in SI: as it is where it was given with a unit, otherwise times the ``unit`` of its file."""
    return float(value) if isinstance(value, InSI) else value * unit


@cache
def _registry() -> "UnitRegistry[Decimal]":
    from pint import UnitRegistry

    return UnitRegistry(non_int_type=Decimal)


def _with_unit(unit: str) -> WrapValidator:
    def validated(given: Any, checked: Callable[[Any], float]) -> float:
        if not isinstance(given, str):
            return checked(given)
        value = in_si(given, unit)
        try:
            return InSI.given_in(checked(float(value)), value.unit)
        except ValidationError as error:
            raise ValueError(error.errors(include_url=False)[0]["msg"]) from None

    return WrapValidator(validated)


Metres = Annotated[float, Field(gt=0), _with_unit("m")]
Pascals = Annotated[float, Field(gt=0), _with_unit("Pa")]
AnyPascals = Annotated[float, _with_unit("Pa")]  # of either sign
Newtons = Annotated[float, Field(gt=0), _with_unit("N")]
Seconds = Annotated[float, Field(gt=0), _with_unit("s")]
