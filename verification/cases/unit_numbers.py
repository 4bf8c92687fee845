"""Numbers with a unit in files of users: "210 GPa", "3 um", "20 N" beside bare SI numbers.

A text is a decimal number and a unit; pint knows the units. The conversion is exact in decimal digits: "3 um"
is the same number as 3e-6.
"""

import re
from collections.abc import Callable, Iterator
from decimal import Decimal
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import BaseModel, Field, ValidationError, WrapValidator

from verification.cases.toml_file import worded
from verification.problem.display_units import Units

if TYPE_CHECKING:
    from pint import UnitRegistry

LONGEST = 60  # characters of a text
NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,4})?"
_NUMBER = re.compile(rf"({NUMBER})(.*)", re.ASCII | re.DOTALL)
# Pint evaluates expressions; from an untrusted file it only gets names with small exponents.
_NAME = r"[A-Za-zµμÅ]+(?:(?:\^|\*\*)?[1-9]|[²³])?"
_UNIT = re.compile(rf"{_NAME}(?:(?: ?[*/] ?| ){_NAME}){{0,4}}")
_THOUSANDS = re.compile(r"([+-]?\d{1,3})((?:,\d{3})+)(?!\d)(\.\d+)?(.*)", re.DOTALL)
_GERMAN = re.compile(r"([+-]?\d{1,3}(?:\.\d{3})*),(\d+)(.*)", re.DOTALL)
_FRACTION = re.compile(r"(\d{1,4})/([1-9]\d{0,3})(.*)", re.DOTALL)
_POWER = re.compile(rf"({NUMBER})\s*[x*×·]\s*10\s*(?:\^|\*\*)\s*([+-]?\d{{1,3}})(.*)", re.DOTALL)
_SPACED = re.compile(r"(\d{1,3})((?:[ '\u202f]\d{3})+)(?!\d)(.*)", re.DOTALL)
_RANGE = re.compile(rf"{NUMBER} ?[^\W\d_]* ?(?:to|-|–|\.\.\.?) ?({NUMBER}.*)", re.DOTALL)
_LAST = re.compile(rf".*[\s=]({NUMBER} *[^\W\d_].*)", re.DOTALL)
_KINDS = {"m": "length", "Pa": "stress", "N": "force", "s": "duration"}
_EXAMPLES = {"m": "3 um", "Pa": "210 GPa", "N": "20 N", "s": "120 s"}
_USUAL = {
    "m": ("m", "mm", "um", "nm", "inch"),
    "Pa": ("Pa", "kPa", "MPa", "GPa", "TPa", "N/mm^2", "ksi"),
    "N": ("N", "mN", "uN", "kN", "MN", "kgf", "lbf"),
    "s": ("s", "min", "h"),
}
# Powers of ten of the units of most files, for which pint, half a second, need not be imported.
METRIC = {
    "m": {"m": 0, "mm": -3, "um": -6, "µm": -6, "nm": -9},
    "Pa": {"Pa": 0, "kPa": 3, "MPa": 6, "GPa": 9, "TPa": 12},
    "N": {"N": 0, "mN": -3, "uN": -6, "kN": 3},
    "s": {"s": 0},
}
INCH, PSI = 0.0254, 6894.757293168361  # m; Pa, 1 lbf/inch^2
# SI values of the units of tables and of guests.
LENGTHS = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "inch": INCH, "in": INCH}
STRESSES = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "psi": PSI, "ksi": 1e3 * PSI}
FORCES = {"N": 1.0, "mN": 1e-3, "uN": 1e-6, "kN": 1e3, "lbf": PSI * INCH**2}
_OF_MASS = {"lb": "lbf", "lbs": "lbf", "pound": "lbf", "pounds": "lbf", "kg": "kgf", "g": "kgf (1000 g)"}


class InSI(float):
    """A number given with a ``unit``: it is in SI, whatever the unit of bare numbers in its file."""

    unit = ""

    @classmethod
    def given_in(cls, value: float, unit: str) -> "InSI":
        found = cls(value)
        found.unit = unit
        return found


# Keys whose units are those of results. Moduli are in GPa in any file, without a wish for stresses in GPa.
_LENGTHS = ("thickness",)
_STRESSES = ("strength", "residual_stress", "hardness", "yield_strength", "adhesion")


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
        raise ValueError(needs + (_form(text.strip(), unit) if len(text) <= LONGEST else ""))
    name = parts[2].strip()
    if not name:
        raise ValueError(f"{needs}; without a unit leave out the quotation marks")
    if name in METRIC[unit]:
        return InSI.given_in(float(Decimal(parts[1]).scaleb(METRIC[unit][name])), name)
    if other := next((kind for kind in METRIC if name in METRIC[kind]), None):
        raise ValueError(f"{needs}; {name!r} is not a unit of {_KINDS[unit]}, but of {_KINDS[other]}")
    try:
        if not _UNIT.fullmatch(name):
            raise ValueError(name)
        name = re.sub(r"(?<=[A-Za-z])[23]", r"^\g<0>", name)  # N/mm2
        found = _registry().parse_units(name)
        alike = found.is_compatible_with(unit)
    except Exception:  # pint raises errors of many kinds for a text that is not a unit
        form = _form(text.strip(), unit)
        near = [usual for usual in _USUAL[unit] if usual.casefold() == name.casefold()]
        if not form:
            form = f"; the unit {name!r} is unknown" + (f", did you mean {near[0]}?" if near else "")
        raise ValueError(needs + form) from None
    if not alike:
        near = [one for one in (name.casefold(), name.casefold().rstrip("s")) if one in _OF_MASS]
        mass = f", but of mass; did you mean {_OF_MASS[near[0]]}?" if near and unit == "N" else ""
        kind = next((f", but of {_KINDS[one]}" for one in _KINDS if found.is_compatible_with(one)), mass)
        raise ValueError(f"{needs}; {name!r} is not a unit of {_KINDS[unit]}{kind}")
    value = _registry().Quantity(Decimal(parts[1]), found).to(unit).magnitude
    return InSI.given_in(float(value), name)


def _form(text: str, unit: str) -> str:
    """The form to type in place of a text that is no number with a unit; "" where it is not guessed."""
    if found := _THOUSANDS.fullmatch(text):
        whole, point = found[1] + found[2].replace(",", ""), found[1] + found[2].replace(",", ".", 1)
        if found[3] or found[2].count(",") > 1:
            return f'; leave out the commas, "{whole}{found[3] or ""}{found[4]}"'
        return f'; the comma has two readings, give "{whole}{found[4]}" or "{point}{found[4]}"'
    if found := _GERMAN.fullmatch(text):
        return f'; write it with a decimal point, "{found[1].replace(".", "")}.{found[2]}{found[3]}"'
    if found := _SPACED.fullmatch(text):
        groups = re.findall(r"\d+", found[2])
        return f'; leave out the separators, "{found[1]}{"".join(groups)}{found[3]}"'
    if found := _FRACTION.fullmatch(text):
        return f'; write the fraction as "{int(found[1]) / int(found[2]):.6g}{found[3]}"'
    if found := _POWER.fullmatch(text):
        return f'; write it as "{found[1]}e{int(found[2])}{found[3]}"'
    if unit == "m" and re.fullmatch(rf"{NUMBER} *(?:\"|\u201d|\u2033|'')", text):
        return f'; write "{re.match(NUMBER, text)[0]} inch"'  # type: ignore[index]
    if unit == "m" and (found := re.fullmatch(rf"(?:d|D|dia\w*|Ø)\s*=?\s*({NUMBER}.*)", text)):
        return f'; give it as diameter = "{found[1]}"' + _form(found[1], unit)
    if _RANGE.fullmatch(text):
        course = (
            '; a graded coating has E = { course = "linear", top = "130 GPa", base = "300 GPa" } in a file'
        )
        course += ', "130 GPa to 300 GPa" in --coating'
        return "; give one value" + (course if unit == "Pa" else "")
    if (found := _LAST.fullmatch(text)) and is_of(unit, found[1]):
        return f'; give "{found[1]}" alone, and a name as name = "..."'
    return ""


def is_of(unit: str, given: Any) -> bool:
    """Whether ``given`` is a number with a unit of the kind of ``unit``, or can only be one as a bare number.

    No coating is 1,000 km thick, and none has a modulus below 1 Pa.
    """
    if isinstance(given, str):
        try:
            return bool(in_si(given, unit))
        except ValueError:
            return False
    return isinstance(given, float | int) and (given > 1e6 if unit == "Pa" else 0 < given < 1)


def of_file(value: float, unit: float) -> float:
    """``value`` in SI: as it is where it was given with a unit, otherwise times the ``unit`` of its file."""
    return float(value) if isinstance(value, InSI) else value * unit


@cache
def _registry() -> "UnitRegistry[Decimal]":
    from pint import UnitRegistry

    registry: UnitRegistry[Decimal] = UnitRegistry(non_int_type=Decimal)
    registry.define("Msi = 1e6 * psi")
    return registry


def _with_unit(unit: str) -> WrapValidator:
    def validated(given: Any, checked: Callable[[Any], float]) -> float:
        if not isinstance(given, str):
            return checked(given)
        value = in_si(given, unit)
        try:
            return InSI.given_in(checked(float(value)), value.unit)
        except ValidationError as error:
            raise ValueError(worded(error.errors(include_url=False)[0], shown=False)) from None

    return WrapValidator(validated)


Metres = Annotated[float, Field(gt=0), _with_unit("m")]
AnyMetres = Annotated[float, _with_unit("m")]  # of either sign
Pascals = Annotated[float, Field(gt=0), _with_unit("Pa")]
AnyPascals = Annotated[float, _with_unit("Pa")]  # of either sign
Newtons = Annotated[float, Field(gt=0), _with_unit("N")]
Seconds = Annotated[float, Field(gt=0), _with_unit("s")]
