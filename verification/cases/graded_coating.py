"""Moduli of a graded coating as those of its sub-layers.

Each of n equal sub-layers has the modulus at its middle, s = (k + 1/2)/n of the thickness:

    linear       E(s) = E_top + (E_base - E_top) s
    exponential  E(s) = E_top (E_base / E_top)^s
    tabulated    E(s) linear between the given ones

so that the contact converges with the square of the sub-layers' thickness.
"""

from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Discriminator, Field, Tag, model_validator

from verification.cases.toml_file import Strict
from verification.cases.unit_numbers import Pascals

LAYERS = 50  # of a body at most, sub-layers counted


class GradedCourse(Strict):
    """A modulus [Pa] that goes from ``top`` to ``base`` of the coating, the top being its surface."""

    course: Literal["linear", "exponential"]
    top: Pascals
    base: Pascals

    @property
    def words(self) -> str:
        """The course in words: "130 to 300 GPa, linear"."""
        return f"{self.top / 1e9:.4g} to {self.base / 1e9:.4g} GPa, {self.course}"


class ModulusTable(Strict):
    """Moduli ``E`` [Pa] at shares ``depth`` of the thickness, from 0 at the surface of the coating to 1."""

    depth: Annotated[list[Annotated[float, Field(ge=0, le=1)]], Field(min_length=2, max_length=1000)]
    E: Annotated[list[Pascals], Field(min_length=2, max_length=1000)]

    @model_validator(mode="after")
    def _whole(self) -> "ModulusTable":
        if len(self.depth) != len(self.E):
            count = f"{len(self.depth)} depths and {len(self.E)} moduli"
            raise ValueError(f"has {count}; give one E for each depth")
        if (self.depth[0], self.depth[-1]) != (0, 1) or np.diff(self.depth).min() <= 0:
            raise ValueError("has depths that do not rise from 0 to 1")
        return self

    @property
    def words(self) -> str:
        """The table in words: "130 to 300 GPa, 3 depths"."""
        return f"{self.E[0] / 1e9:.4g} to {self.E[-1] / 1e9:.4g} GPa, {len(self.E)} depths"


Graded = GradedCourse | ModulusTable  # every kind of E that varies with the depth


def _kind(given: Any) -> str:
    if isinstance(given, ModulusTable) or (isinstance(given, dict) and "depth" in given):
        return "table"
    return "course" if isinstance(given, dict | GradedCourse) else "value"


Modulus = Annotated[
    Annotated[Pascals, Tag("value")]
    | Annotated[GradedCourse, Tag("course")]
    | Annotated[ModulusTable, Tag("table")],
    Discriminator(_kind),
]


def moduli(E: float | Graded, layers: int) -> tuple[float, ...]:
    """The modulus [Pa] of each of ``layers`` equal sub-layers from the surface down."""
    s = (np.arange(layers) + 0.5) / layers
    if isinstance(E, ModulusTable):
        return tuple(np.interp(s, E.depth, E.E).tolist())
    if isinstance(E, GradedCourse):
        linear = E.top + (E.base - E.top) * s
        return tuple((linear if E.course == "linear" else E.top * (E.base / E.top) ** s).tolist())
    return (E,) * layers
