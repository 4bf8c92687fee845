"""Description of a guest: its ``guest.toml``.

name = "my code"
callable = "adapter:solve"     # or command = ["./adapter"], or results = "answers"
"""

import re
from difflib import get_close_matches
from fnmatch import fnmatchcase
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from verification.cases.toml_file import Strict, Text, read_bounded, read_toml
from verification.cases.unit_numbers import FORCES, LENGTHS, STRESSES, Seconds
from verification.judging.verdict import Claim
from verification.problem.coated_contact import CoatedContact
from verification.problem.quantity import QUANTITIES
from verification.sources.source_registry import SOURCES

FILE = "guest.toml"
_PLACE = re.compile(r"[A-Za-z_][\w.]*:[A-Za-z_][\w.]*")

Word = Annotated[str, Field(min_length=1, max_length=1000)]
Level = Annotated[int | float, Field(gt=0)]


class Supports(Strict):
    """Abilities of a code: the largest number of coatings, friction, stresses, an elastic ball.

    ellipsoid : an indenter with two radii of curvature.
    loads : prescribed ones, each a uniform pressure on a disc or on a square.
    lacks : quantities that it does not give.
    """

    coatings: Annotated[int, Field(ge=0, le=50)] = 0
    ball: bool = False
    ellipsoid: bool = False
    friction: bool = False
    stress: bool = False
    loads: Annotated[list[Literal["disc", "square"]], Field(max_length=2)] = Field(default=[])
    lacks: Annotated[list[Word], Field(max_length=50)] = Field(default=[])


class GuestUnits(Strict):
    """GuestUnits of the code; numbers are converted on the way to it and back."""

    length: Literal["m", "mm", "um", "nm", "inch", "in"] = "m"
    stress: Literal["Pa", "kPa", "MPa", "GPa", "psi", "ksi"] = "Pa"
    force: Literal["N", "mN", "uN", "kN", "lbf"] = "N"


Axis = Literal["x", "y", "z", "r", "t", "-x", "-y", "-z"]


class NodalFile(Strict):
    """How a file of nodes is read.

    axes : what its coordinates are, "-z" where they point out of the solid; with "r" it is axisymmetric.
    """

    axes: Annotated[list[Axis], Field(min_length=2, max_length=3)] = Field(default=["r", "z"])

    @model_validator(mode="after")
    def _a_basis(self) -> "NodalFile":
        letters = {axis[-1] for axis in self.axes}
        bases = ({"r", "z"}, {"r", "t", "z"}, {"x", "z"}, {"x", "y", "z"})
        if len(letters) != len(self.axes) or letters not in bases:
            raise ValueError(f"axes = {self.axes}; give r and z, or x, y and z, each once")
        return self


class GuestFile(Strict):
    """The keys of a guest file.

    version : of the code, for the report.   callable, command, results : the way in, one of the three.
    python : the interpreter of ``callable``, of an environment with numpy; coatcheck's own unless given.
    nodes : how files of nodes below ``results`` are read.
    claim : largest relative difference that the code claims to have; None where it does not say.
    edge : half-width of a zone around the contact edge that is left out, as a fraction of a.
    refine : numerical parameter of the refinement study with its values, coarse to fine.
    notes : what users of the code should know and its documentation does not say: axis, sign, side, default.
    known : reason of each known failure by "case/quantity" or "case/quantity/line".
    """

    name: Annotated[str, Field(pattern=r"^[^\x00-\x1f\x7f]{1,60}$")]
    version: Word | None = None
    callable: Word | None = None
    python: Word | None = None
    command: Annotated[list[Word], Field(min_length=1, max_length=50)] | None = None
    results: Word | None = None
    claim: Annotated[float, Field(gt=0, le=1)] | None = None
    edge: Annotated[float, Field(ge=0, lt=1)] = 0.0
    time_limit: Seconds = 120.0
    homepage: Text | None = None
    supports: Supports = Supports()
    units: GuestUnits = GuestUnits()
    nodes: NodalFile = NodalFile()
    refine: Annotated[
        dict[str, Annotated[list[Level], Field(min_length=3, max_length=12)]], Field(max_length=1)
    ] = Field(default_factory=dict)
    notes: Annotated[list[Text], Field(max_length=20)] = Field(default=[])
    known: Annotated[dict[str, Text], Field(default_factory=dict, max_length=1000)]

    @model_validator(mode="after")
    def _one_way_in(self) -> "GuestFile":
        given = [name for name in ("callable", "command", "results") if getattr(self, name) is not None]
        if len(given) != 1:
            raise ValueError(
                f"needs exactly one of callable, command, results, not {' and '.join(given) or 'none'}"
            )
        if self.python is not None and self.callable is None:
            raise ValueError(f"python = {self.python!r} runs a callable, and none is given")
        if self.callable is not None and not _PLACE.fullmatch(self.callable):
            raise ValueError(f"callable = {self.callable!r}; give it as module:function")
        if self.name in SOURCES:
            raise ValueError(f"name = {self.name!r}; this is the name of a source of coatcheck")
        for name, levels in self.refine.items():
            steps = [b - a for a, b in pairwise(levels)]
            if not (all(step > 0 for step in steps) or all(step < 0 for step in steps)):
                raise ValueError(f"refine.{name}: levels go from coarse to fine, each only once")
        for name in self.supports.lacks:
            if name not in QUANTITIES:
                near = ", ".join(get_close_matches(name, QUANTITIES, 3) or list(QUANTITIES)[:8])
                raise ValueError(f"supports.lacks: {name!r} is no quantity; there are {near}")
        for key in self.known:
            if key.count("/") not in (1, 2):
                raise ValueError(f'known."{key}": give "case/quantity" or "case/quantity/line"')
        return self


class Guest(GuestFile):
    """A contact code to examine: its file as ``text``, the ``folder`` that its paths are relative to."""

    folder: Path
    text: str

    @property
    def parameter(self) -> str:
        """Numerical parameter of the refinement study; "" without one."""
        return next(iter(self.refine), "")

    @property
    def levels(self) -> tuple[float, ...]:
        """Values of the parameter, coarse to fine."""
        return tuple(self.refine.get(self.parameter, ()))

    def refusal(self, problem: CoatedContact) -> str | None:
        """Why the code does not solve ``problem``, by its own statement; None where it does."""
        count = len(problem.coatings)
        if count > self.supports.coatings:
            return f"the guest supports {self.supports.coatings} coatings, this problem has {count}"
        if problem.friction and not self.supports.friction:
            return "the guest does not support friction"
        if problem.ball is not None and not self.supports.ball:
            return "the guest does not support an elastic ball"
        if problem.indenter is not None and not self.supports.ellipsoid:
            return "the guest does not support an ellipsoid"
        return None

    def lack(self, quantity: str) -> str | None:
        """Why the code does not give ``quantity``, by its own statement; None where it does."""
        if quantity in self.supports.lacks:
            return f"the guest lacks {quantity}, by its own statement"
        stressed = QUANTITIES[quantity].kind in ("stress", "peak")
        return "the guest does not give stresses" if stressed and not self.supports.stress else None

    def known_failure(self, case: str, claim: Claim) -> str | None:
        """The reason of a known failure; None where none is listed."""
        names = (f"{case}/{claim.quantity}", f"{case}/{claim.quantity}/{claim.line}")
        found = (why for pattern, why in self.known.items() if any(fnmatchcase(n, pattern) for n in names))
        return next(found, None)

    def factor(self, unit: str) -> float:
        """SI value of the code's unit for quantities of the SI ``unit``."""
        m, N = LENGTHS[self.units.length], FORCES[self.units.force]
        return {"m": m, "N": N, "N/m": N / m, "Pa": STRESSES[self.units.stress]}.get(unit, 1.0)

    @property
    def questions(self) -> tuple[dict[str, float], ...]:
        """Numerical parameters of each solve, coarse to fine."""
        return tuple({self.parameter: level} for level in self.levels) or ({},)


def read_guest(place: str | Path) -> Guest:
    """The guest in the directory ``place`` or in the file ``place``.

    Raises CaseError naming file and key.
    """
    path = Path(place)
    if path.is_dir():
        path = path / FILE
    raw = read_bounded(path, "guest", "one guest; coatcheck guest init writes one")
    return parse_guest(raw, path)


def parse_guest(raw: bytes, path: Path) -> Guest:
    """Check the content of a guest file; ``path`` names it in messages. Raises CaseError."""
    text, checked = read_toml(raw, path, GuestFile)
    return Guest.model_construct(**dict(checked), folder=path.resolve().parent, text=text)
