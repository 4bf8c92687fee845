"""Moduli of a graded coating as those of its sub-layers.

Each of n equal sub-layers has the modulus at its middle, s = (k + 1/2)/n of the thickness:

    linear       E(s) = E_top + (E_base - E_top) s
    exponential  E(s) = E_top (E_base / E_top)^s
    tabulated    E(s) linear between the given ones

so that the contact converges with the square of the sub-layers' thickness.
"""

from typing import Annotated, Any, ClassVar, Literal, get_args

import numpy as np
from pydantic import Discriminator, Field, Tag, model_validator

from verification.cases.toml_file import Strict
from verification.cases.unit_numbers import Pascals
from verification.problem.array_types import Array

LAYERS = 50  # of a body at most, sub-layers counted


class GradedCourse(Strict):
    """A modulus [Pa] that goes from ``top`` to ``base`` of the coating, the top being its surface."""

    tag: ClassVar = "course"
    course: Literal["linear", "exponential"]
    top: Pascals
    base: Pascals

    def at(self, s: Array) -> Array:
        """The modulus [Pa] at shares of the thickness."""
        if self.course == "linear":
            return self.top + (self.base - self.top) * s
        return np.asarray(self.top * (self.base / self.top) ** s)

    @property
    def words(self) -> str:
        """The course in words: "130 to 300 GPa, linear"."""
        return f"{self.top / 1e9:.4g} to {self.base / 1e9:.4g} GPa, {self.course}"


class ModulusTable(Strict):
    """Moduli ``E`` [Pa] at shares ``depth`` of the thickness, from 0 at the surface of the coating to 1."""

    tag: ClassVar = "table"
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

    def at(self, s: Array) -> Array:
        """The modulus [Pa] at shares of the thickness."""
        return np.interp(s, self.depth, self.E)

    @property
    def words(self) -> str:
        """The table in words: "130 to 300 GPa, 3 depths"."""
        return f"{self.E[0] / 1e9:.4g} to {self.E[-1] / 1e9:.4g} GPa, {len(self.E)} depths"


# Every kind of E that varies with the depth: its modulus ``at`` a depth, its words, a tag of its own, known
# to ``toml_file.KINDS``, and one more line of ``Modulus``.
Graded = GradedCourse | ModulusTable


def _kind(given: Any) -> str:
    """The kind that has most of the keys that are given; "value" where none are."""
    if isinstance(given, Graded):
        return given.tag
    if not isinstance(given, dict):
        return "value"
    return max(get_args(Graded), key=lambda kind: len(kind.model_fields.keys() & given.keys())).tag


Modulus = Annotated[
    Annotated[Pascals, Tag("value")]
    | Annotated[GradedCourse, Tag(GradedCourse.tag)]
    | Annotated[ModulusTable, Tag(ModulusTable.tag)],
    Discriminator(_kind),
]


def moduli(E: float | Graded, layers: int) -> tuple[float, ...]:
    """The modulus [Pa] of each of ``layers`` equal sub-layers from the surface down."""
    if not isinstance(E, Graded):
        return (E,) * layers
    return tuple(E.at((np.arange(layers) + 0.5) / layers).tolist())
