"""Preferable thickness: the stress of each failure mode compared with a strength.

    utilisation u_i(h) = safety * stress_i(h) / strength_i,   governing mode: the largest u_i

A strength is a value, a range (a uniform distribution), or a mean with its standard deviation (log-normal,
which is never negative):

    ln S ~ N(ln m - s^2/2, s^2),   s^2 = ln(1 + (sd/m)^2)

Of a strength that scatters the fractile counts below which a stated share lies, 5 % unless given. A thickness
is admissible where every u_i, computed with its stress plus numerical uncertainty, is at most 1; the
preferable one minimises the largest u_i. Without strengths the criterion is the least maximum of a few
stresses over p_h, which is the same with equal strengths.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import exp, log, sqrt
from typing import Annotated, Any

import numpy as np
from pydantic import Discriminator, Field, Tag, model_validator
from scipy.special import ndtri

from verification.cases.plausibility import Limits, small_limits
from verification.cases.toml_file import Strict
from verification.cases.unit_numbers import Pascals
from verification.problem.array_types import Array
from verification.study.largest_stresses import Stress
from verification.study.sweep_values import Between


class Uniform(Between):
    """Any strength [Pa] between two, equally likely."""

    start: Annotated[Pascals, Field(alias="from")]
    to: Pascals


class LogNormal(Strict):
    """A strength of known ``mean`` and ``standard_deviation`` [Pa]."""

    mean: Pascals
    standard_deviation: Pascals

    @model_validator(mode="after")
    def _narrow(self) -> "LogNormal":
        if self.standard_deviation > self.mean:
            raise ValueError("standard_deviation exceeds the mean; check its unit")
        return self


def _kind(given: Any) -> str:
    if isinstance(given, dict | Uniform | LogNormal):
        return "scatter" if isinstance(given, LogNormal) or "mean" in dict(given) else "range"
    return "value"


Given = Annotated[
    Annotated[Pascals, Tag("value")]
    | Annotated[Uniform, Tag("range")]
    | Annotated[LogNormal, Tag("scatter")],
    Discriminator(_kind),
]


@dataclass(frozen=True)
class Strength:
    """A strength [Pa] in words, with its distribution.

    quantile : the strength below which a share of all lies.   scatters : False of a single value.
    """

    text: str
    quantile: Callable[[Any], Array]
    scatters: bool = True


def strength_of(given: float | Uniform | LogNormal, shown: Callable[[float], str]) -> Strength:
    """The strength of an entry of a file; ``shown`` writes a stress [Pa] with its unit."""
    if isinstance(given, Uniform):
        low, width = given.start, given.to - given.start
        return Strength(f"{shown(given.start)} to {shown(given.to)}", lambda p: low + width * np.asarray(p))
    if isinstance(given, LogNormal):
        s = sqrt(log(1 + (given.standard_deviation / given.mean) ** 2))
        median = given.mean * exp(-(s**2) / 2)
        return Strength(
            f"{shown(given.mean)}, standard deviation {shown(given.standard_deviation)}",
            lambda p: median * np.exp(s * ndtri(p)),
        )
    return Strength(shown(given), lambda p: np.full(np.shape(p), float(given)), scatters=False)


# Failure mode of each stress.
MODES = {
    "sigma_xx_surface": "the coating cracks at its surface",
    "sigma_xx_base": "the coating cracks at its base",
    "sigma_xx_substrate": "the substrate cracks under the coating",
    "sigma_xz_interface": "the coating shears off",
    "sigma_zz_interface": "the coating lifts off",
    "von_mises_coating": "the coating yields",
    "von_mises_substrate": "the substrate yields",
}


class Criteria(Strict):
    """The table ``[criteria]`` of a study file.

    strength : upper limit of each stress [Pa].   safety : factor on every stress.
    fractile : share of weaker ones below the strength that counts, of strengths that scatter.
    minimise : without strengths, the stresses whose maximum is minimised.
    """

    strength: Annotated[dict[Stress, Given], Field(min_length=1)] | None = None
    safety: Annotated[float, Field(ge=1, le=100)] = 1.0
    fractile: Annotated[float, Field(gt=0, le=0.5)] = 0.05
    minimise: Annotated[list[Stress], Field(min_length=1)] | None = None

    @model_validator(mode="after")
    def _one(self) -> "Criteria":
        if self.strength is not None and self.minimise is not None:
            raise ValueError("takes strength or minimise, not both")
        return self

    def with_yield_strengths(self, limits: Limits) -> "Criteria":
        """These with the yield strengths among ``limits`` as the strengths of the von Mises stresses.

        limits : [Pa] by the keys of a file.   Raises ValueError for one by which a study judges nothing.
        """
        modes = {"substrate": "von_mises_substrate", "coating": "von_mises_coating"}
        strength: dict[Any, Any] = dict(self.strength or {})
        for key, value in limits.items():
            layer, _, name = key.rpartition(".")
            if name == "hardness":
                continue
            if name != "yield_strength":
                raise ValueError(f"{key}: a study takes the strengths of its coatings from criteria.strength")
            if (mode := modes.get(layer)) is None:
                judged = (
                    "no stress of the ball" if layer.startswith("ball") else "all coatings together, no one"
                )
                raise ValueError(f"{key}: a study judges {judged}; leave it out, see criteria.strength")
            if mode in strength or self.minimise is not None:
                other = "minimise" if self.minimise is not None else f"strength.{mode}"
                raise ValueError(f"{key}: not with criteria.{other}; give one of both")
            strength[mode] = value
        return self.model_copy(update={"strength": strength or None})

    def warnings(self) -> tuple[str, ...]:
        """A line for each implausible strength."""
        found = {}
        for name, given in (self.strength or {}).items():
            if isinstance(given, Uniform):
                key, value = ".from", given.start
            elif isinstance(given, LogNormal):
                key, value = ".mean", given.mean
            else:
                key, value = "", given
            found[f"criteria.strength.{name}{key}"] = value
        return tuple(small_limits(found))

    @property
    def limited(self) -> bool:
        """Whether strengths are given."""
        return self.strength is not None

    @property
    def scatters(self) -> bool:
        """Whether any strength is more than one value."""
        return any(one.scatters for one in self.given().values())

    def given(self, shown: Callable[[float], str] = str) -> dict[str, Strength]:
        """Strength of every mode that has one, in the order of ``MODES``; {} without strengths."""
        given = self.strength or {}
        return {mode: strength_of(given[mode], shown) for mode in MODES if mode in given}

    def strengths(self, p_h: float) -> dict[str, float]:
        """Strength [Pa] that counts of every mode in the criterion; ``p_h`` [Pa] for all without any."""
        if self.strength is not None:
            return {mode: float(one.quantile(self.fractile)) for mode, one in self.given().items()}
        chosen = self.minimise or ["sigma_xx_surface", "sigma_xx_base", "sigma_xz_interface"]
        return {mode: p_h for mode in MODES if mode in chosen}

    def description(self) -> str:
        """The criterion in words."""
        if self.strength is None:
            names = ", ".join(self.strengths(1.0))
            return (
                f"No strengths are given, so the preferable thickness is where the largest of {names} is "
                "smallest; criteria.minimise chooses other stresses, criteria.strength states strengths."
            )
        factor = f", each stress times {self.safety:g}" if self.safety != 1 else ""
        kind = f"the {100 * self.fractile:g} % fractile of its strength" if self.scatters else "its strength"
        return f"Every stress must stay below {kind}{factor}."
