"""Materials, coatings and balls as users write them in case files and study files alike."""

from collections.abc import Sequence
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, model_validator

from verification.cases.graded_coating import LAYERS, Graded, Modulus, moduli
from verification.cases.toml_file import Poisson, Positive, Strict
from verification.cases.unit_numbers import AnyPascals, Metres, Pascals, is_of
from verification.problem.array_types import Ball, Coatings

Expansion = Annotated[float, Field(ge=-1e-3, le=1e-3)]
TemperatureChange = Annotated[float, Field(ge=-5000, le=5000)]


LIMITS = ("hardness", "yield_strength", "strength", "adhesion")


class Limited(Strict):
    """A material by ``name``, with stresses beyond which the contact is not elastic.

    strength : the tension at which it cracks.
    """

    name: Annotated[str, Field(min_length=1, max_length=30)] = ""
    hardness: Pascals | None = None
    yield_strength: Pascals | None = None
    strength: Pascals | None = None

    def limits(self, key: str) -> dict[str, float]:
        """Those given [Pa], by their keys after ``key``."""
        given = {name: getattr(self, name, None) for name in LIMITS}
        return {f"{key}.{name}": value for name, value in given.items() if value is not None}


class Material(Limited):
    """An elastic material; ``expansion`` is its coefficient of thermal expansion [1/K]."""

    E: Pascals
    nu: Poisson
    expansion: Expansion | None = None


class Coating(Limited):
    """One coating; of a graded one E is a course over its depth, followed by ``layers`` sub-layers.

    E and thickness may be missing where a study sweeps them.   residual_stress : of its growth, to which the
    mismatch of its thermal ``expansion`` adds.   adhesion : the shear, or the tension, at which it comes off
    what lies below.
    """

    E: Modulus | None = None
    nu: Poisson
    thickness: Metres | None = None
    thickness_over_a_h: Positive | None = None
    layers: Annotated[int, Field(ge=2, le=LAYERS)] | None = None
    residual_stress: AnyPascals | None = None
    expansion: Expansion | None = None
    adhesion: Pascals | None = None

    def residual(self, E: float, nu: float, below: float | None, change: float | None) -> float:
        """Equibiaxial residual stress [Pa]: that given, from growth, and that of thermal mismatch.

        sigma = E/(1 - nu) (alpha_s - alpha) dT, of a thin film whose strain is that of its thick substrate.
        L. B. Freund, S. Suresh, Thin Film Materials, Cambridge University Press, 2003, chapter 2.
        below : expansion of the substrate alpha_s [1/K].   change : of the temperature since deposition [K].
        Raises ValueError where the mismatch lacks a part.
        """
        if self.expansion is None:
            return self.residual_stress or 0.0
        if below is None or change is None:
            raise ValueError("expansion requires that of the substrate, and problem.temperature_change")
        return (self.residual_stress or 0.0) + E / (1 - nu) * (below - self.expansion) * change

    @model_validator(mode="before")
    @classmethod
    def _not_swapped(cls, given: Any) -> Any:
        E, h = (given.get(key) for key in ("E", "thickness")) if isinstance(given, dict) else (None, None)
        if is_of("m", E) and is_of("Pa", h):
            h, E = (one if isinstance(one, str) else f"{one:g}" for one in (h, E))
            raise ValueError(f"has thickness = {h} and E = {E}; exchange them")
        return given

    @model_validator(mode="after")
    def _one_of_each(self) -> "Coating":
        if (self.layers is None) == isinstance(self.E, Graded):
            raise ValueError(
                "is graded: give layers, the number of its sub-layers, such as 20, beside the course of E"
                if self.layers is None
                else "has layers but one E; leave layers out, or give E as a course over the depth"
            )
        if self.thickness is not None and self.thickness_over_a_h is not None:
            raise ValueError("needs exactly one of thickness [m] or thickness_over_a_h")
        return self

    @property
    def is_sized(self) -> bool:
        """Whether a thickness is given, one way or the other."""
        return self.thickness is not None or self.thickness_over_a_h is not None

    def sublayers(self, over: int) -> int:
        """Number of its sub-layers, over ``over``."""
        return max(1, (self.layers or 1) // over)

    def in_metres(self, a_h: float, over: int = 1) -> Coatings:
        """E, nu, thickness of its sub-layers."""
        thickness = self.thickness if self.thickness is not None else a_h * (self.thickness_over_a_h or 0.0)
        n = self.sublayers(over)
        # One layer keeps the number as it was given, which knows whether it had a unit.
        return tuple((E, self.nu, thickness / n if n > 1 else thickness) for E in self.moduli(over))

    @property
    def course(self) -> str:
        """E of a graded coating as it was given; "" of any other."""
        return self.E.words if isinstance(self.E, Graded) else ""

    def moduli(self, over: int = 1) -> tuple[float, ...]:
        """The modulus [Pa] of each of its sub-layers, whose number is divided by ``over``."""
        assert self.E is not None
        return moduli(self.E, self.sublayers(over))


class WholeCoating(Coating):
    """A coating of which nothing is swept."""

    E: Modulus

    @model_validator(mode="after")
    def _sized(self) -> "WholeCoating":
        if not self.is_sized:
            raise ValueError("needs exactly one of thickness [m] or thickness_over_a_h")
        return self


def _written_out(given: Any) -> Any:
    """The coatings of a list with each { repeat = 10, stack = [ ... ] } in it written out."""
    found = []
    for i, one in enumerate(given if isinstance(given, list) else (), start=1):
        if not (isinstance(one, dict) and {"repeat", "stack"} & set(one)):
            found.append(one)
            continue
        count, stack = one.get("repeat"), one.get("stack")
        if set(one) != {"repeat", "stack"} or not isinstance(stack, list) or not stack:
            raise ValueError(f"entry {i} repeats coatings: give it repeat and stack = [ ... ], no other key")
        if type(count) is not int or not 1 <= count <= LAYERS:
            raise ValueError(f"entry {i} has repeat = {count!r}; it must be 1 to {LAYERS}")
        found += count * stack
    return found if isinstance(given, list) else given


WholeCoatings = Annotated[list[WholeCoating], BeforeValidator(_written_out), Field(max_length=LAYERS)]


class BallEntry(Material):
    """An elastic ball; its coatings from its surface inwards."""

    coatings: WholeCoatings = Field(default_factory=list)

    @property
    def bare(self) -> Ball:
        """The ball without its coatings."""
        return self.E, self.nu, ()

    def coated(self, a_h: float, over: int = 1) -> Ball:
        """The ball; a thickness over a_h is that over the scale of both bodies uncoated."""
        return self.E, self.nu, in_metres(self.coatings, a_h, over)


def limits_of(coatings: Sequence[Coating], key: str) -> dict[str, float]:
    """Hardness and yield strength [Pa] of coatings, by their keys after ``key``."""
    return {k: v for i, c in enumerate(coatings) for k, v in c.limits(f"{key}.{i}").items()}


def in_metres(coatings: Sequence[Coating], a_h: float, over: int = 1) -> Coatings:
    """E, nu, thickness of every sub-layer of coatings. Raises ValueError beyond ``LAYERS``."""
    found = tuple(layer for c in coatings for layer in c.in_metres(a_h, over))
    if len(found) > LAYERS:
        raise ValueError(f"coatings have {len(found)} layers; at most {LAYERS} are supported on a body")
    return found
