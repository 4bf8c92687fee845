"""Strengths as a study file gives them: a value, a range, or a mean with its standard deviation.

A range is a uniform distribution; a mean with its standard deviation is log-normal, which is never negative:

    ln S ~ N(ln m - s^2/2, s^2),   s^2 = ln(1 + (sd/m)^2)
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import exp, log, sqrt
from typing import Annotated, Any

import numpy as np
from pydantic import Discriminator, Field, Tag, model_validator
from scipy.special import ndtri

from verification.cases.toml_file import Strict
from verification.cases.unit_numbers import Pascals
from verification.problem.array_types import Array

__all__ = ["Given", "Strength", "strength_of"]


class Uniform(Strict):
    """Any strength [Pa] between two, equally likely."""

    start: Annotated[Pascals, Field(alias="from")]
    to: Pascals

    @model_validator(mode="after")
    def _upwards(self) -> "Uniform":
        if not self.start < self.to:
            raise ValueError(f"runs from {self.start:g} to {self.to:g} Pa; give from < to")
        return self

    @property
    def first(self) -> tuple[str, float]:
        """Key and value of its lower end."""
        return ".from", self.start


class LogNormal(Strict):
    """A strength of known ``mean`` and ``standard_deviation`` [Pa]."""

    mean: Pascals
    standard_deviation: Pascals

    @model_validator(mode="after")
    def _narrow(self) -> "LogNormal":
        if self.standard_deviation > self.mean:
            raise ValueError("standard_deviation exceeds the mean; check its unit")
        return self

    @property
    def first(self) -> tuple[str, float]:
        """Key and value of its mean."""
        return ".mean", self.mean


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
        return Strength(
            f"{shown(given.start)} to {shown(given.to)}",
            lambda p: low + width * np.asarray(p),
        )
    if isinstance(given, LogNormal):
        s = sqrt(log(1 + (given.standard_deviation / given.mean) ** 2))
        median = given.mean * exp(-(s**2) / 2)
        return Strength(
            f"{shown(given.mean)}, standard deviation {shown(given.standard_deviation)}",
            lambda p: median * np.exp(s * ndtri(p)),
        )
    return Strength(
        shown(given),
        lambda p: np.full(np.shape(p), float(given)),
        scatters=False,
    )
