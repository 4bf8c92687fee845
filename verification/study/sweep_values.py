"""The values that a study sweeps: lists, or ranges {from, to, count}.

The thicknesses of a range {from, to, count} are denser about its geometric middle, where the stresses change
from those of the bare substrate to those of the bulk coating:

    h = sqrt(from to) (to/from)^((3 t + 2 t^3)/10),   t = -1 .. 1 in equal steps

so that neighbours differ by 0.6 of an equal ratio's step (in log h) in the middle, by 1.8 of it at the ends.
"""

from typing import Annotated

import numpy as np
from pydantic import Discriminator, Field, Tag, model_validator

from verification.cases.toml_file import Positive, Strict
from verification.cases.unit_numbers import Metres, Newtons

MOST_POINTS = 1_000_000
Values = Annotated[list[Positive], Field(min_length=1, max_length=100_000)]


def thicknesses_between(low: float, high: float, count: int) -> tuple[float, ...]:
    """``count`` values from ``low`` to ``high`` by the formula of this file, the ends as they are given."""
    if count == 1:
        return (low,)
    t = np.linspace(-1, 1, count)
    values = np.sqrt(low * high) * (high / low) ** ((3 * t + 2 * t**3) / 10)
    return (low, *(float(v) for v in values[1:-1]), high)


Lengths = Annotated[list[Metres], Field(min_length=1, max_length=100_000)]


class Between(Strict):
    """Anything between two positive values, {from, to}."""

    start: Annotated[Positive, Field(alias="from")]
    to: Positive

    @model_validator(mode="after")
    def _upwards(self) -> "Between":
        if not self.start < self.to:
            raise ValueError(f"runs from {self.start:g} to {self.to:g}; give from < to")
        return self


class Range(Between):
    """A range {from, to, count}."""

    count: Annotated[int, Field(ge=1, le=100_000)]


class _Lengths(Range):
    start: Annotated[Metres, Field(alias="from")]
    to: Metres


class _Loads(Range):
    start: Annotated[Newtons, Field(alias="from")]
    to: Newtons
    count: Annotated[int, Field(ge=4, le=1000)]


# Discriminated by type, so that an error message concerns one of them only.
_BY_TYPE = Discriminator(lambda given: "range" if isinstance(given, dict | Range) else "list")
_Ratios = Annotated[Annotated[Values, Tag("list")] | Annotated[Range, Tag("range")], _BY_TYPE]
_Thicknesses = Annotated[Annotated[Lengths, Tag("list")] | Annotated[_Lengths, Tag("range")], _BY_TYPE]


class Sweep(Strict):
    """The table [sweep] of a study file."""

    modulus_ratio: Values | None = None
    thickness: _Thicknesses | None = None
    thickness_over_a_h: _Ratios | None = None
    load: _Loads | None = None
    friction: Annotated[list[Annotated[float, Field(ge=0, le=2)]], Field(min_length=1, max_length=1000)] = (
        Field(default_factory=lambda: [0.0])
    )
    cross_check: Annotated[int, Field(ge=0, le=MOST_POINTS)] = 10

    @model_validator(mode="after")
    def _one_thickness(self) -> "Sweep":
        if (self.thickness is None) == (self.thickness_over_a_h is None):
            raise ValueError("needs exactly one of thickness [m] or thickness_over_a_h")
        return self
