"""A case: one coated contact with the claims about it, read from a TOML file."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, model_validator

from verification.cases.toml import (
    CaseError,
    Friction,
    Poisson,
    Positive,
    Strict,
    Text,
    read_bounded,
    read_toml,
)
from verification.judging.claims import standard_claims
from verification.judging.verdict import Claim
from verification.problem.arrays import Ball, Coatings
from verification.problem.contact import BALL, CoatedContact
from verification.problem.profile import Line, line_of, lines_of, oblique_lines
from verification.sources.registry import METHODS, sources_of

CASES = Path(__file__).parent / "shipped" / "contact"


@dataclass(frozen=True)
class Case:
    """``problem`` with the ``claims`` about it; ``numerics`` holds each method's own keywords.

    text : the file it was read from, kept with the results so that they carry their full input.
    resolve : whether it is also solved scaled, with equal moduli, thick and thin (``invariants.resolved``).
    """

    name: str
    title: str
    problem: CoatedContact
    claims: tuple[Claim, ...]
    source: str = ""
    numerics: dict[str, dict[str, Any]] = field(default_factory=dict)
    text: str = ""
    resolve: bool = False

    @property
    def lines(self) -> tuple[Line, ...]:
        """The lines on which sources are compared: those of the plane y = 0, then the others."""
        return lines_of(self.problem) + oblique_lines(self.problem)


class _Substrate(Strict):
    E: Positive
    nu: Poisson


class _Coating(_Substrate):
    thickness: Positive | None = None
    thickness_over_a_h: Positive | None = None

    @model_validator(mode="after")
    def _one_thickness(self) -> "_Coating":
        if (self.thickness is None) == (self.thickness_over_a_h is None):
            raise ValueError("needs exactly one of thickness [m] or thickness_over_a_h")
        return self

    def in_metres(self, a_h: float) -> float:
        return self.thickness if self.thickness is not None else a_h * (self.thickness_over_a_h or 0.0)


class BallEntry(_Substrate):
    """An elastic ball; its coatings from its surface inwards."""

    coatings: Annotated[list[_Coating], Field(default_factory=list, max_length=50)]

    @property
    def bare(self) -> Ball:
        """The ball without its coatings."""
        return self.E, self.nu, ()

    def coated(self, a_h: float) -> Ball:
        """The ball; a thickness over a_h is that over the scale of both bodies uncoated."""
        return self.E, self.nu, _in_metres(self.coatings, a_h)


def _in_metres(coatings: list[_Coating], a_h: float) -> Coatings:
    return tuple((c.E, c.nu, c.in_metres(a_h)) for c in coatings)


class _Problem(Strict):
    radius: Positive
    load: Positive
    friction: Friction = 0.0
    substrate: _Substrate
    coatings: Annotated[list[_Coating], Field(default_factory=list, max_length=50)]
    ball: BallEntry | None = None

    def contact(self) -> CoatedContact:
        """The problem; a thickness over a_h is that over the scale of both bodies uncoated."""
        ball, substrate = self.ball, (self.substrate.E, self.substrate.nu)
        bare = CoatedContact(
            self.radius, self.load, (), substrate, self.friction, ball.bare if ball else None
        )
        given = ball.coated(bare.a_h) if ball else None
        return replace(bare, coatings=_in_metres(self.coatings, bare.a_h), ball=given)


class _Claim(Strict):
    quantity: Text
    line: Text
    between: Annotated[list[Text], Field(min_length=2, max_length=2)]
    cap: Annotated[float, Field(gt=0, le=1)]
    why: Text
    edge: Annotated[float, Field(ge=0, lt=1)] = 0.0


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
    claim: Annotated[list[_Claim], Field(default_factory=list, max_length=1000)]
    resolve: bool = False


def read_case(path: Path) -> Case:
    """Read and check one case file. Raises CaseError naming file and key."""
    return parse_case(read_bounded(path, "case", "one problem"), path)


def parse_case(raw: bytes, path: Path) -> Case:
    """Check the content of a case file; ``path`` names it in messages. Raises CaseError."""
    text, checked = read_toml(raw, path, _CaseFile)
    try:
        problem = checked.problem.contact()
    except (ValueError, OverflowError, ZeroDivisionError) as error:
        raise CaseError(f"{path}: problem: {error}") from None
    refuse_unfit_scales(path, problem)
    if checked.resolve and not problem.coatings:
        raise CaseError(f"{path}: resolve: requires a coating; add one, or leave resolve out")
    numerics = {
        method: getattr(checked, method).model_dump(exclude_none=True)
        for method in METHODS
        if method in _CaseFile.model_fields
    }
    claims = _claims(path, checked, problem)
    if not claims:
        raise CaseError(f"{path}: claim: nothing is claimed of this problem, so that nothing would be judged")
    return Case(path.stem, checked.title, problem, claims, checked.source, numerics, text, checked.resolve)


def refuse_unfit_scales(path: Path, problem: CoatedContact) -> None:
    """Raise CaseError beyond the range of the parabolic sphere, of a method or of floating point."""
    a_h, R = problem.a_h, problem.radius
    if a_h > R:
        reason = f".load: gives a contact radius of {a_h:.3g} m on a sphere of {R:.3g} m; lower the load"
        raise CaseError(f"{path}: problem{reason}")
    if not 1e-12 < a_h < 1e3:
        raise CaseError(f"{path}: problem: contact radius a_h = {a_h:.3g} m; check units of radius, load, E")
    for body in problem.bodies:
        seen, key = problem.seen_from(body), f"{path}: problem{'.ball' if body == BALL else ''}"
        for i, (_, _, h) in enumerate(seen.coatings):
            if not 1e-3 <= h / a_h <= 1e3:
                reason = (
                    f"{h / a_h:.3g} times the contact radius {a_h:.3g} m; both methods support 1e-3 to 1e3"
                )
                raise CaseError(f"{key}.coatings.{i}.thickness: {reason}")
        moduli = [*(E for E, _, _ in seen.coatings), seen.substrate[0]]
        contrast = max(moduli) / min(moduli)
        if contrast > 1e4:
            raise CaseError(f"{key}: moduli differ {contrast:.3g} times; at most 1e4 is supported")


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
        claims.append(Claim(claim.quantity, claim.line, (first, second), claim.cap, claim.why, claim.edge))
    return tuple(claims)


def shipped_cases() -> dict[str, Path]:
    """The cases of the default run, by name, in the order of their file names."""
    return {path.stem: path for path in sorted(CASES.glob("*.toml"))}
