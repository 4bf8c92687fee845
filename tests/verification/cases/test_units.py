"""Numbers with a unit: exact in their digits, refused with key and unit otherwise."""

import re
from decimal import Decimal
from pathlib import Path

import pytest
from case_texts import case_text
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from pint import UnitRegistry

from verification.cases.case_file import parse_case
from verification.cases.toml_file import CaseError
from verification.cases.unit_numbers import METRIC

BARE = case_text("E = 450e9; nu = 0.22; thickness = 3e-6")
PREFIXES = {"": 0, "n": -9, "u": -6, "µ": -6, "μ": -6, "m": -3, "k": 3, "M": 6, "G": 9}
# SI value of 1, written out here: pint is not asked.
OTHERS = {
    "load": {"kgf": "9.80665", "lbf": "4.4482216152605", "kg*m/s^2": "1", "newton": "1", "dyn": "1e-5"},
    "thickness": {"inch": "0.0254", "in": "0.0254", "micron": "1e-6", "angstrom": "1e-10", "mm^2/m": "1e-6"},
    "E": {"N/mm^2": "1e6", "N/mm²": "1e6", "N/mm**2": "1e6", "bar": "1e5", "kgf / mm^2": "9806650"},
}
BASE = {"load": "N", "thickness": "m", "E": "Pa"}
KEYS = {"load": "load", "thickness": "coating 1, thickness", "E": "substrate, E"}
BAD = ("furlongish", "Gpa", "GPA", "kg", "K", "mm^2", "Pa s", "N/m", "m^99", "Pa**Pa", "1/Pa", "", "(N)", "%")
NUMBERS = st.decimals("1e-3", "1e3", allow_nan=False, places=4).filter(bool).map(str) | st.sampled_from(
    ["20", "+2.5", "3.", ".5", "2.5e3", "7E-2", "1e+1"]
)
SPACE = st.sampled_from([" ", "", "  "])


def parse(text):
    return parse_case(text.encode(), Path("mine.toml"))


def with_text(key, text):
    new = {
        "load": ("load = 20", f'load = "{text}"'),
        "thickness": ("thickness = 3e-6", f'thickness = "{text}"'),
        "E": ("substrate = { E = 210e9", f'substrate = {{ E = "{text}"'),
    }
    return BARE.replace(*new[key])


@st.composite
def unit_texts(draw):
    """A key with a text for it and its exact value in SI, None where the text is bad."""
    key = draw(st.sampled_from(sorted(BASE)))
    number, space = draw(NUMBERS), draw(SPACE)
    if draw(st.booleans()):
        others = {k: unit for k in sorted(BASE) if k != key for unit in (BASE[k],)}
        unit = draw(st.sampled_from([*BAD, *others.values()]))
        text = draw(
            st.sampled_from(
                [f"{number}{space}{unit}", unit, f"{number},5 {BASE[key]}", f"{number} {number} {BASE[key]}"]
            )
        )
        return key, text, None
    prefix = draw(st.sampled_from(sorted(PREFIXES)))
    unit, factor = prefix + BASE[key], Decimal(10) ** PREFIXES[prefix]
    if draw(st.booleans()):
        unit, exact = draw(st.sampled_from(sorted(OTHERS[key].items())))
        factor = Decimal(exact)
    return key, f"{number}{space}{unit}", Decimal(number) * factor


def given_by(problem, key):
    return {"load": problem.load, "thickness": problem.coatings[0][2], "E": problem.substrate[0]}[key]


@settings(max_examples=300, derandomize=True, database=None, deadline=None, phases=[Phase.generate])
@given(unit_texts())
def test_generated_texts_are_exact_or_refused_with_key_and_unit(drawn):
    key, text, value = drawn
    if value is None:
        with pytest.raises(CaseError) as error:
            parse(with_text(key, text))
        message = str(error.value)
        assert message.startswith(f"mine.toml: {KEYS[key]} ")
        assert repr(text) in message
        assert "\n" not in message
        return
    try:
        found = given_by(parse(with_text(key, text)).problem, key)
    except CaseError as error:
        # A number that no contact has is refused as the same bare number is.
        bare = with_text(key, text).replace(f'"{text}"', repr(float(value)))
        with pytest.raises(
            CaseError, match=re.escape(re.split("mine.toml: |as it stands, ", str(error))[-1])
        ):
            parse(bare)
        return
    assert found == float(value)


@pytest.mark.parametrize(("unit", "name"), [(unit, name) for unit, names in METRIC.items() for name in names])
def test_metric_units_are_those_of_pint(unit, name):
    units = UnitRegistry(non_int_type=Decimal)
    assert units.Quantity(Decimal(1), name).to(unit).magnitude == Decimal(1).scaleb(METRIC[unit][name])
