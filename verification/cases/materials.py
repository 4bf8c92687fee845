"""Materials by name: typical elastic constants, each with its public source, from one TOML file."""

from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import Annotated

from pydantic import Field, model_validator

from verification.cases.toml_file import CaseError, Poisson, Strict, Text, read_bounded, read_toml
from verification.cases.unit_numbers import Pascals
from verification.problem.display_units import prefixed

SHIPPED = Path(__file__).parent / "shipped" / "materials" / "materials.toml"


class KnownMaterial(Strict):
    """Typical ``E`` [Pa] and ``nu`` of a material, by ``name`` or one of its other names.

    low, high : range of E [Pa] that the ``source`` gives.   checked : values that were compared with it.
    """

    name: Text
    also: Annotated[list[Text], Field(default_factory=list)]
    E: Pascals
    nu: Poisson
    low: Pascals | None = None
    high: Pascals | None = None
    yield_strength: Pascals | None = None
    source: Text
    checked: Text = "no"
    note: Text = "-"

    @model_validator(mode="after")
    def _within(self) -> "KnownMaterial":
        low, high = self.low or 0.0, self.high or self.E
        if (self.low is None) != (self.high is None) or not low <= self.E <= high:
            raise ValueError("needs low and high together, with its E between them")
        return self

    @property
    def range(self) -> str:
        """The range of E in words; "" where none is given."""
        return f"{prefixed(self.low, 'Pa')} to {prefixed(self.high, 'Pa')}" if self.low and self.high else ""

    @property
    def told(self) -> str:
        """The values that are used, in words, with their source."""
        between = f", {self.range}" if self.range else ""
        doubt = ", not compared with it" if self.checked == "no" else ""
        return f"{self.name} E = {prefixed(self.E, 'Pa')}{between}, nu = {self.nu:g} ({self.source}{doubt})"


class _Materials(Strict):
    material: Annotated[list[KnownMaterial], Field(min_length=1, max_length=1000)]


@cache
def read_materials(path: Path = SHIPPED) -> dict[str, KnownMaterial]:
    """Every material of a file by each of its names, see ``plain_name``. Raises CaseError."""
    _, checked = read_toml(read_bounded(path, "materials", "materials"), path, _Materials)
    found: dict[str, KnownMaterial] = {}
    for one in checked.material:
        for name in (one.name, *one.also):
            if found.setdefault(plain_name(name), one) is not one:
                raise CaseError(f"{path}: {name} names two materials; rename one of them")
    return found


def plain_name(name: str) -> str:
    """A name without what people write differently: case, spaces, hyphens."""
    return name.casefold().replace(" ", "").replace("-", "")


def meant(name: str, known: dict[str, KnownMaterial]) -> str:
    """Advice on a name that is not ``known``: names that share a word with it or are spelt like it."""
    words = {word for word in name.casefold().split() if len(word) > 2}
    near = [
        one.name
        for one in known.values()
        for called in (one.name, *one.also)
        if words & {*called.casefold().split()}
    ]
    for key in get_close_matches(plain_name(name), [key for key in known if len(key) > 2], n=2):
        near += [called for called in (known[key].name, *known[key].also) if plain_name(called) == key]
    *others, last = dict.fromkeys(near) or ("",)
    return f"; did you mean {', '.join(others)}{' or ' * bool(others)}{last}?" if near else ""
