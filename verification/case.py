"""A case: one coated contact with the claims made about it, read from a TOML file."""

import tomllib
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError, model_validator

from verification.problem import CoatedContact
from verification.profile import SCALARS, Line, line_of, lines_of
from verification.verdict import Claim

__all__ = [
    "METHODS",
    "Case",
    "CaseError",
    "Strict",
    "Text",
    "first_complaint",
    "load_toml",
    "parse_case",
    "read_bounded",
    "read_case",
    "read_toml",
    "refuse_unfit_scales",
    "shipped_cases",
    "sources_of",
    "standard_claims",
]

METHODS = ("semianalytic", "fem_reference")
Checked = TypeVar("Checked", bound=BaseModel)

CASES = Path(__file__).parent / "cases"
MAX_BYTES = 250_000
# Python's TOML reader takes time and memory with the square of the parts of a dotted key: 100,000 of them, in
# 200 kB, exhaust 20 GB. A line of a case file has a few dots.
MAX_DOTS = 250
MAX_NAME = 100

# Caps as fractions of the scale of each comparison: the value itself for the scalars, p_h for the lines.
CAPS = {"peak_pressure": 1e-3, "contact_radius": 5e-3, "approach": 1e-3}
LINE_CAP = 5e-3
# The pressure falls to zero with a vertical tangent, so no method has a meaningful value within a few
# patches of the edge; this fraction of a is left unjudged on the surface.
EDGE = 0.05


class CaseError(ValueError):
    """A case file that cannot be used; the message names file and key."""


@dataclass(frozen=True)
class Case:
    """``problem`` with the ``claims`` about it; ``numerics`` holds each method's own keywords.

    text : the file it was read from, kept with the results so that they carry their full input.
    laws : whether the problem is solved again scaled, with equal moduli, thick and thin, see ``invariants``.
    """

    name: str
    title: str
    problem: CoatedContact
    claims: tuple[Claim, ...]
    source: str = ""
    numerics: dict[str, dict[str, Any]] = field(default_factory=dict)
    text: str = ""
    laws: bool = False

    @property
    def lines(self) -> tuple[Line, ...]:
        """The lines of the plane y = 0 on which this case is looked at."""
        return lines_of(self.problem)


def sources_of(problem: CoatedContact) -> tuple[str, ...]:
    """Whatever speaks about a problem: both methods, then every reference that holds for it."""
    closed = ("hamilton" if problem.friction else "hertz",) if problem.homogeneous else ()
    return (*METHODS, "integral_equation", *closed)


def standard_claims(problem: CoatedContact) -> tuple[Claim, ...]:
    """Every quantity on every line, method against method, then against every reference."""
    sources = sources_of(problem)
    pairs = [METHODS, *((method, reference) for reference in sources[2:] for method in METHODS)]
    pairs += [("integral_equation", closed) for closed in sources[3:]]
    claims = [
        Claim(name, "contact", pair, CAPS[name], "scalars of the contact, from one number each")
        for pair in pairs
        for name in SCALARS
    ]
    for line in lines_of(problem):
        for quantity in _quantities(line, problem):
            edge = EDGE if line.name == "surface" else 0.0
            claims += [
                Claim(quantity, line.name, pair, LINE_CAP, "the stress a coating cracks or peels by", edge)
                for pair in pairs
            ]
    return tuple(claims)


def _quantities(line: Line, problem: CoatedContact) -> tuple[str, ...]:
    if line.name == "surface":
        # sigma_zz = -p and sigma_xz = -f p hold by construction there; the pressure says it all.
        return ("pressure", "sigma_xx", "sigma_yy")
    if line.name == "axis":
        return ("sigma_xx", "sigma_zz", *(("sigma_xz",) if problem.friction else ()))
    return ("sigma_xx", "sigma_yy", "sigma_zz", "sigma_xz")


class Strict(BaseModel):
    """A part of a case file: no unknown keys, no text where a number belongs."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


Modulus = Annotated[float, Field(gt=0)]
Poisson = Annotated[float, Field(gt=-1, lt=0.5)]
Length = Annotated[float, Field(gt=0)]
Text = Annotated[str, Field(min_length=1, max_length=500)]


class _Substrate(Strict):
    E: Modulus
    nu: Poisson


class _Coating(_Substrate):
    thickness: Length | None = None
    thickness_over_a_h: Length | None = None

    @model_validator(mode="after")
    def _one_thickness(self) -> "_Coating":
        if (self.thickness is None) == (self.thickness_over_a_h is None):
            raise ValueError("needs exactly one of thickness [m] or thickness_over_a_h")
        return self

    def in_metres(self, a_h: float) -> float:
        return self.thickness if self.thickness is not None else a_h * (self.thickness_over_a_h or 0.0)


class _Problem(Strict):
    radius: Length
    load: Annotated[float, Field(gt=0)]
    friction: Annotated[float, Field(ge=0, le=2)] = 0.0
    substrate: _Substrate
    coatings: Annotated[list[_Coating], Field(max_length=50)] = []


class _Claim(Strict):
    quantity: Text
    line: Text
    between: Annotated[list[Text], Field(min_length=2, max_length=2)]
    cap: Annotated[float, Field(gt=0, le=1)]
    why: Text
    edge: Annotated[float, Field(ge=0, lt=1)] | None = None


def _odd(number: int) -> int:
    if number % 2 == 0:
        raise ValueError("must be odd, so that a patch lies in the middle")
    return number


class _SemianalyticNumerics(Strict):
    patches: Annotated[int, Field(ge=33, le=4097), AfterValidator(_odd)] | None = None
    conversion: Literal["split", "split-fft", "plain"] | None = None
    max_iterations: Annotated[int, Field(ge=1, le=100_000)] | None = None


class _FemNumerics(Strict):
    order: Annotated[int, Field(ge=2, le=4)] | None = None
    quality: Literal["fast", "default", "fine"] | None = None


class _CaseFile(Strict):
    title: Text
    source: Text = "no source stated"
    problem: _Problem
    semianalytic: _SemianalyticNumerics = _SemianalyticNumerics()
    fem_reference: _FemNumerics = _FemNumerics()
    claim: Annotated[list[_Claim], Field(max_length=1000)] = []
    laws: bool = False


def read_case(path: Path) -> Case:
    """Read and check one case file. Raises CaseError: one sentence with file and key."""
    return parse_case(read_bounded(path, "case", "one problem"), path)


def read_bounded(path: Path, kind: str, holds: str) -> bytes:
    """The content of a .toml file of a ``kind`` that ``holds`` little. Raises CaseError."""
    # The name goes into file names, terminals and tables.
    if len(path.stem) > MAX_NAME or not path.stem.isprintable():
        raise CaseError(
            f"{path.name[:MAX_NAME]!r}: give the file a name of at most {MAX_NAME} printable characters"
        )
    try:
        if not path.is_file():
            what = "is a directory" if path.is_dir() else "there is no such file"
            raise CaseError(f"{path}: {what}; give the path of a .toml {kind} file")
        with path.open("rb") as file:
            raw = file.read(MAX_BYTES + 1)
    except OSError as error:
        raise CaseError(f"{path}: {error.strerror or error}; give the path of a .toml {kind} file") from None
    if len(raw) > MAX_BYTES:
        raise CaseError(f"{path}: larger than {MAX_BYTES} bytes; a {kind} file holds {holds}")
    return raw


def load_toml(raw: bytes) -> tuple[str, dict[str, Any]]:
    """The text of a TOML file with its content. Raises ValueError, in one sentence, where it is none."""
    try:
        text = raw.decode("utf-8")
    except UnicodeDecodeError:
        raise ValueError("not UTF-8 text; a case file is TOML") from None
    for number, line in enumerate(text.split("\n"), start=1):  # as TOML breaks lines
        if line.count(".") > MAX_DOTS:
            raise ValueError(f"line {number} has more than {MAX_DOTS} dots; break it into several")
    try:
        return text, tomllib.loads(text)
    except RecursionError:
        raise ValueError("not TOML: nested too deeply") from None
    except ValueError as error:  # TOMLDecodeError, or a number of thousands of digits
        raise ValueError(f"not TOML: {error}") from None


def read_toml(raw: bytes, path: Path, model: type[Checked]) -> tuple[str, Checked]:
    """The text of a TOML file with its content checked against ``model``. Raises CaseError."""
    try:
        text, content = load_toml(raw)
        return text, model.model_validate(content)
    except ValidationError as error:
        raise CaseError(f"{path}: {first_complaint(error)}") from None
    except ValueError as error:
        raise CaseError(f"{path}: {error}") from None


def parse_case(raw: bytes, path: Path) -> Case:
    """Check the content of a case file; ``path`` names it in complaints. Raises CaseError."""
    text, checked = read_toml(raw, path, _CaseFile)
    try:
        p = checked.problem
        bare = CoatedContact(p.radius, p.load, (), (p.substrate.E, p.substrate.nu), p.friction)
        problem = replace(bare, coatings=tuple((c.E, c.nu, c.in_metres(bare.a_h)) for c in p.coatings))
    except (ValueError, OverflowError, ZeroDivisionError) as error:
        raise CaseError(f"{path}: problem: {error}") from None
    refuse_unfit_scales(path, problem)
    if checked.laws and not problem.coatings:
        raise CaseError(f"{path}: laws: needs a coating to make thick and thin; add one, or leave laws out")
    return Case(
        name=path.stem,
        title=checked.title,
        problem=problem,
        claims=_claims(path, checked, problem),
        source=checked.source,
        numerics={
            "semianalytic": checked.semianalytic.model_dump(exclude_none=True),
            "fem_reference": checked.fem_reference.model_dump(exclude_none=True),
        },
        text=text,
        laws=checked.laws,
    )


def refuse_unfit_scales(path: Path, problem: CoatedContact) -> None:
    """Raise CaseError where the parabolic sphere, a method or floating point no longer holds."""
    if problem.a_h > problem.radius:
        raise CaseError(
            f"{path}: problem.load: gives a contact radius of {problem.a_h:.3g} m on a sphere of "
            f"{problem.radius:.3g} m; lower the load"
        )
    if not 1e-12 < problem.a_h < 1e3:
        raise CaseError(
            f"{path}: problem: contact radius a_h = {problem.a_h:.3g} m; check units of radius, load, E"
        )
    for i, (_, _, thickness) in enumerate(problem.coatings):
        if not 1e-3 <= thickness / problem.a_h <= 1e3:
            raise CaseError(
                f"{path}: problem.coatings.{i}.thickness: {thickness / problem.a_h:.3g} times the contact "
                f"radius {problem.a_h:.3g} m; both methods are made for 1e-3 to 1e3"
            )
    stiffest = max([E for E, _, _ in problem.coatings] + [problem.substrate[0]])
    softest = min([E for E, _, _ in problem.coatings] + [problem.substrate[0]])
    if stiffest > 1e4 * softest:
        raise CaseError(
            f"{path}: problem: moduli differ {stiffest / softest:.3g} times; at most 1e4 is supported"
        )


def _claims(path: Path, checked: _CaseFile, problem: CoatedContact) -> tuple[Claim, ...]:
    if not checked.claim:
        return standard_claims(problem)
    known = {(c.quantity, c.line) for c in standard_claims(problem)}
    sources = sources_of(problem)
    claims = []
    for i, claim in enumerate(checked.claim):
        key = f"{path}: claim.{i}"
        if claim.line != "contact":
            try:
                line_of(claim.line, problem)
            except ValueError as error:
                raise CaseError(f"{key}.{error}") from None
        if (claim.quantity, claim.line) not in known:
            fit = sorted(q for q, line in known if line == claim.line)
            raise CaseError(f"{key}.quantity = {claim.quantity!r}; on {claim.line} there is {', '.join(fit)}")
        first, second = claim.between
        if first == second or not {first, second} <= set(sources):
            raise CaseError(f"{key}.between = {claim.between}; give two of {', '.join(sources)}")
        edge = claim.edge if claim.edge is not None else (EDGE if claim.line == "surface" else 0.0)
        claims.append(Claim(claim.quantity, claim.line, (first, second), claim.cap, claim.why, edge))
    return tuple(claims)


def first_complaint(error: ValidationError) -> str:
    """The first thing wrong with a case file, with its key and what stands there, in one sentence."""
    first = error.errors(include_url=False)[0]
    key = ".".join(_shortened(str(part)) for part in first["loc"]) or "top level"
    message = first["msg"].removeprefix("Value error, ")
    said = {
        "missing": "is missing",
        "extra_forbidden": "is an unknown key",
        "finite_number": "must be a finite number",
        "float_type": "must be a number",
        "int_type": "must be a whole number",
        "string_type": "must be text",
    }.get(first["type"], message[0].lower() + message[1:])
    if first["type"] not in ("missing", "extra_forbidden") and not isinstance(first["input"], dict | list):
        said += f", not {_shown(first['input'])}"
    more = error.error_count() - 1
    return f"{key} {said}" + (f" (and {more} more)" if more else "")


def _shown(value: object) -> str:
    # An integer of thousands of digits is one that Python refuses to print.
    whole = isinstance(value, int) and abs(value) >= 10**60
    return "a whole number of more than 60 digits" if whole else _shortened(repr(value))


def _shortened(text: str) -> str:
    return text if len(text) <= 60 else text[:57] + "..."


def shipped_cases() -> dict[str, Path]:
    """The cases of the default run, by name, in the order of their file names."""
    return {path.stem: path for path in sorted(CASES.glob("*.toml"))}
