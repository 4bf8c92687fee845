"""A case: one coated contact with the claims about it, read from a TOML file."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from math import inf, isinf, prod
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, WrapValidator, model_validator

from verification.cases.plausibility import (
    before,
    diameter_remark,
    likely_slips,
    stress_warnings,
    warnings_of,
)
from verification.cases.solid_schema import (
    BallEntry,
    Material,
    TemperatureChange,
    WholeCoating,
    WholeCoatings,
    in_metres,
    limits_of,
)
from verification.cases.toml_file import (
    NO_SOURCE,
    CaseError,
    Friction,
    Strict,
    Text,
    place,
    read_bounded,
    read_toml,
    spoken,
)
from verification.cases.unit_numbers import AnyMetres, InSI, Metres, Newtons
from verification.judging.standard_claims import standard_claims
from verification.judging.verdict import Claim
from verification.problem.coated_contact import CoatedContact
from verification.problem.display_units import Units, prefixed
from verification.problem.indenter_shape import Indenter, effective_radius
from verification.problem.line_profile import line_of
from verification.problem.point_answers import BALL, FLAT
from verification.sources.load_of_approach import load_of_approach, own_radius
from verification.sources.source_registry import METHODS, sources_of

CONTRAST = 1e4  # of a layer over those below it, where digits are lost
MOST_UNLIKE = 4000.0  # radii of the gap over each other; the contact is 150 times as long as wide
SUPPORTED = (1e-3, 1e3)  # thickness over contact radius, by both methods
CASES = Path(__file__).parent / "shipped" / "contact"
SHAPES = Path(__file__).parent / "shipped" / "shapes"


@dataclass(frozen=True)
class Case:
    """``problem`` with the ``claims`` about it; ``numerics`` holds each method's own keywords.

    text : the file it was read from, kept with the results so that they carry their full input.
    warnings : of implausible numbers, a line each.   limits : hardness, yield strength [Pa] by their keys.
    residual : equibiaxial stress [Pa] of each coating by body, no part of ``problem``; {} without any.
    layers : number of sub-layers of each coating by body; {} where no coating is graded.
    courses : E of each coating by body as it was given, "" where it is not graded; likewise {}.
    remarks : on numbers that are likely but may be meant otherwise, a line each.
    names : those of the coatings of each body, then that of the body itself; "" where none is given.
    approach : that states the problem [m], whose load was found; None where the load is given.
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
    warnings: tuple[str, ...] = ()
    limits: dict[str, float] = field(default_factory=dict)
    residual: dict[str, tuple[float, ...]] = field(default_factory=dict)
    layers: dict[str, tuple[int, ...]] = field(default_factory=dict)
    names: dict[str, tuple[str, ...]] = field(default_factory=dict)
    courses: dict[str, tuple[str, ...]] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    approach: float | None = None

    def sublayers(self, body: str) -> tuple[int, ...]:
        """Number of sub-layers of each coating of a body."""
        return self.layers.get(body) or (1,) * len(self.problem.seen_from(body).coatings)


def _straight(given: Any, checked: Callable[[Any], float]) -> float:
    """A radius of curvature, infinite of the word "flat"."""
    if given == "flat":
        return inf
    value = checked(given)
    if value == 0:
        raise ValueError('a radius of curvature is not 0; "flat" has none')
    return value


Bend = Annotated[AnyMetres, WrapValidator(_straight)]  # negative of a concave surface


class IndenterEntry(Strict):
    """An indenter that is no sphere, see ``indenter_shape``.

    radii, against : radii of curvature along x and y of either body, negative where its surface is concave.
    """

    shape: Literal["ellipsoid", "asperities", "lobes"]
    radii: Annotated[list[Bend], Field(min_length=2, max_length=2)] | None = None
    against: Annotated[list[Bend], Field(min_length=2, max_length=2)] | None = None
    distance: Metres | None = None
    lobes: Annotated[int, Field(ge=2, le=6)] | None = None
    amplitude: Metres | None = None
    at: Metres | None = None

    @model_validator(mode="after")
    def _own_numbers(self) -> "IndenterEntry":
        own = {"ellipsoid": {"radii"}, "asperities": {"distance"}, "lobes": {"lobes", "amplitude", "at"}}
        given = {name for name in type(self).model_fields if getattr(self, name) is not None} - {"shape"}
        given -= {"against"} if self.shape == "ellipsoid" else set()
        if given != own[self.shape]:
            raise ValueError(f"{self.shape} needs {', '.join(sorted(own[self.shape]))} and no other number")
        if self.radii is not None:
            for axis, *bends in zip("xy", self.radii, self.against or (inf, inf), strict=True):
                if sum(1 / R for R in bends) <= 0:
                    both = " and ".join("flat" if isinf(R) else f"{1e3 * R:g} mm" for R in bends)
                    why = "a convex surface has a positive radius, one around it a larger negative one"
                    if all(map(isinf, bends)):
                        why = "a contact along a line is not solved; give a crown, such as 2 m"
                    said = f"has no gap that opens along {axis}, where the radii of curvature are {both}"
                    raise ValueError(f"{said}; {why}")
            if (unlike := max(self.pair[1]) / min(self.pair[1])) > MOST_UNLIKE:
                raise ValueError(
                    f"leaves a gap whose radii along x and y differ by a factor of {unlike:.3g}, beyond "
                    f"{MOST_UNLIKE:g}; give a smaller crown, or take the contact along a line"
                )
        return self

    @property
    def pair(self) -> Indenter:
        """Shape and numbers."""
        if self.radii is not None:
            along, across = zip(self.radii, self.against or (inf, inf), strict=True)
            return self.shape, (effective_radius(*along), effective_radius(*across))
        if self.distance is not None:
            return self.shape, (self.distance,)
        return self.shape, (float(self.lobes or 0), self.amplitude or 0.0, self.at or 0.0)


class Sized(Strict):
    """A problem with a ball of given ``radius`` or ``diameter``, or with an ``indenter`` that has radii."""

    radius: Metres | None = None
    diameter: Metres | None = None
    indenter: IndenterEntry | None = None

    @model_validator(mode="after")
    def _one_size(self) -> "Sized":
        radii = self.indenter.radii if self.indenter else None
        if [self.radius, self.diameter, radii].count(None) != 2:
            raise ValueError("needs exactly one of radius or diameter")
        return self

    @property
    def size(self) -> float:
        """The radius [m], which knows whether it was given with a unit; sqrt(R_x R_y) of an ellipsoid."""
        if self.indenter is not None and self.indenter.radii is not None:
            return float(prod(self.indenter.pair[1]) ** 0.5)
        if self.radius is not None:
            return self.radius
        half = (self.diameter or 0.0) / 2
        return InSI.given_in(half, self.diameter.unit) if isinstance(self.diameter, InSI) else half


class _CaseProblem(Sized):
    load: Newtons | None = None
    approach: Metres | None = None
    friction: Friction = 0.0
    substrate: Material
    coatings: WholeCoatings = Field(default_factory=list)
    ball: BallEntry | None = None
    temperature_change: TemperatureChange | None = None

    @model_validator(mode="after")
    def _one_statement(self) -> "_CaseProblem":
        given = [f"{name} = {value:g}" for name in ("load", "approach") if (value := getattr(self, name))]
        if len(given) != 1:
            found = f"{' and '.join(given)} are both given" if given else "neither of them is given"
            raise ValueError(f"needs exactly one of load [N] or approach [m]; {found}")
        if self.approach is not None and self.indenter is not None:
            raise ValueError("approach states the contact of a ball alone; give the load of this indenter")
        if self.approach is not None and self.approach > self.size:
            ball = f"the radius of the ball, {prefixed(self.size, 'm')}"
            raise ValueError(f"approach = {prefixed(self.approach, 'm')} is beyond {ball}; check its unit")
        coatings = [*self.coatings, *(self.ball.coatings if self.ball else ())]
        if self.temperature_change is not None and all(c.expansion is None for c in coatings):
            raise ValueError(
                "temperature_change acts on no coating: give the expansion of each whose residual "
                "stress it makes, or leave it out"
            )
        return self

    @property
    def bodies(self) -> dict[str, tuple[Material, list[WholeCoating]]]:
        """Each body with its coatings."""
        ball = {BALL: (self.ball, self.ball.coatings)} if self.ball else {}
        return {FLAT: (self.substrate, self.coatings), **ball}

    def graded(self) -> dict[str, list[WholeCoating]]:
        """The coatings by body; {} where none of them is graded."""
        found = {body: coatings for body, (_, coatings) in self.bodies.items()}
        return found if any(c.layers for coatings in found.values() for c in coatings) else {}

    def residual(self, over: int = 1) -> dict[str, tuple[float, ...]]:
        """Residual stress [Pa] of each sub-layer of the coatings by body; {} where there is none.

        Raises ValueError naming the coating whose residual stress is not determined.
        """
        found = {}
        for body, (solid, coatings) in self.bodies.items():
            below, stresses = solid.expansion, []
            if below is not None and all(c.expansion is None for c in coatings):
                key = BALL if body == BALL else "substrate"
                raise ValueError(f"{key}.expansion acts on no coating: give that of one, or leave it out")
            for i, coating in enumerate(coatings):
                try:
                    for E in coating.moduli(over):
                        stresses.append(coating.residual(E, coating.nu, below, self.temperature_change))
                except ValueError as error:
                    raise ValueError(f"{spoken(f'{before(body)}coatings.{i}')}: {error}") from None
            found[body] = tuple(stresses)
        return found if any(any(stresses) for stresses in found.values()) else {}

    def contact(self, over: int = 1) -> CoatedContact:
        """The problem under its load, or under the load of its approach by the exact reference.

        over : divisor of the number of sub-layers.
        """
        load = self.load
        if load is None:
            load = load_of_approach(self.approach or 0.0, lambda W: self._under(W, over))
        return self._under(load, over)

    def _under(self, load: float, over: int) -> CoatedContact:
        """The problem under a load; a thickness over a_h is that over the scale of both bodies uncoated."""
        ball, substrate = self.ball, (self.substrate.E, self.substrate.nu)
        indenter = self.indenter.pair if self.indenter else None
        uncoated = ball.bare if ball else None
        bare = CoatedContact(self.size, load, (), substrate, self.friction, uncoated, indenter)
        given = ball.coated(bare.a_h, over) if ball else None
        return replace(bare, coatings=in_metres(self.coatings, bare.a_h, over), ball=given)

    def names(self) -> dict[str, tuple[str, ...]]:
        """Names of the coatings of each body, then of the body itself."""
        return {
            body: (*(c.name for c in coatings), solid.name) for body, (solid, coatings) in self.bodies.items()
        }

    def limits(self) -> dict[str, float]:
        """Hardness and yield strength [Pa] of every material that has one, by their keys."""
        found: dict[str, float] = {}
        for body, (solid, coatings) in self.bodies.items():
            found |= solid.limits(BALL if body == BALL else "substrate")
            found |= limits_of(coatings, f"{before(body)}coatings")
        return found


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
    conversion: Literal["split", "plain"] | None = None
    edge_correction: bool | None = None
    max_iterations: Annotated[int, Field(ge=1, le=100_000)] | None = None

    @model_validator(mode="before")
    @classmethod
    def _moved(cls, given: Any) -> Any:
        if isinstance(given, dict) and "approach" in given:
            raise ValueError("approach states the problem: give it in [problem], in place of the load")
        return given


class _FemNumerics(Strict):
    order: Annotated[int, Field(ge=2, le=4)] | None = None
    quality: Literal["fast", "default", "fine"] | None = None


class _CaseFile(Strict):
    title: Text
    source: Text = NO_SOURCE
    problem: _CaseProblem
    semianalytic: _SemianalyticNumerics = _SemianalyticNumerics()
    fem_reference: _FemNumerics = _FemNumerics()
    claim: Annotated[list[_Claim], Field(default_factory=list, max_length=1000)]
    resolve: bool = False


def read_case(path: Path) -> Case:
    """Read and check one case file. Raises CaseError naming file and key."""
    return parse_case(read_bounded(path, "case", "one problem"), path)


def parse_case(raw: bytes, path: Path, over: int = 1) -> Case:
    """Check the content of a case file; ``path`` names it in messages. Raises CaseError.

    over : divisor of the number of sub-layers of graded coatings.
    """
    text, checked = read_toml(raw, path, _CaseFile)
    try:
        problem, residual = checked.problem.contact(over), checked.problem.residual(over)
    except (ValueError, OverflowError, ZeroDivisionError) as error:
        raise CaseError(f"{path}: {error}") from None
    refuse_unfit_scales(path, problem, "load" if checked.problem.approach is None else "approach")
    if checked.resolve and not problem.coatings:
        raise CaseError(f"{path}: resolve: requires a coating; add one, or leave resolve out")
    numerics = {method: getattr(checked, method).model_dump(exclude_none=True) for method in METHODS}
    claims = _claims(path, checked, problem)
    if not claims:
        raise CaseError(f"{path}: claim: nothing is claimed of this problem, so that nothing would be judged")
    limits, graded = checked.problem.limits(), checked.problem.graded()
    return Case(
        path.stem,
        checked.title,
        problem,
        claims,
        checked.source,
        numerics,
        text,
        checked.resolve,
        (*warnings_of(problem), *stress_warnings(residual, limits, checked.problem.temperature_change)),
        limits,
        residual,
        {body: tuple(c.sublayers(over) for c in coatings) for body, coatings in graded.items()},
        checked.problem.names(),
        {body: tuple(c.course for c in coatings) for body, coatings in graded.items()},
        diameter_remark(checked.problem.radius),
        checked.problem.approach,
    )


def with_moduli(case: Case, moduli: Mapping[tuple[str, int], float]) -> Case:
    """``case`` with other moduli [Pa] by body and number of the coating, the last of which is the body."""
    _, checked = read_toml(case.text.encode(), Path(case.name), _CaseFile)
    parts: dict[str, Any] = {}
    for body, (solid, coatings) in checked.problem.bodies.items():
        every: list[Any] = [*coatings, solid]
        *layers, base = (
            one.model_copy(update={"E": moduli.get((body, i), one.E)}) for i, one in enumerate(every)
        )
        if body == BALL:
            parts["ball"] = base.model_copy(update={"coatings": layers})
        else:
            parts |= {"coatings": layers, "substrate": base}
    problem = checked.problem.model_copy(update=parts)
    return replace(case, problem=problem.contact(), residual=problem.residual())


def refuse_unfit_scales(path: Path, problem: CoatedContact, pressed: str = "load") -> None:
    """Raise CaseError beyond the range of the parabolic sphere, of a method or of floating point.

    Thicknesses lie within the range over the contact's own radius or over that of the bare bodies.
    pressed : key that states the load.
    """
    R, slips = problem.radius, likely_slips(problem)
    first = f"{path}: {slips}; as it stands, " if slips else f"{path}: "
    if not 1e-12 < problem.a_h < 1e3:
        reason = f"contact radius a_h = {problem.a_h:.3g} m; check units of radius, load, E"
        raise CaseError(f"{first}problem: {reason}")
    a = own_radius(problem)
    if a > R:
        reason = f"gives a contact radius of {a:.3g} m on a sphere of {R:.3g} m; lower it"
        raise CaseError(f"{first}{pressed}: {reason}")
    unit = Units.of_contact(problem, a)
    for body in problem.bodies:
        seen = problem.seen_from(body)
        for i, (_, _, h) in enumerate(seen.coatings):
            low, high = SUPPORTED[0] * min(a, problem.a_h), SUPPORTED[1] * max(a, problem.a_h)
            if not low <= h <= high:
                reason = (
                    f"{unit.shown_length(h)} is {h / a:.3g} times the contact radius; both methods support "
                    f"{unit.shown_length(low, 3)} to {unit.shown_length(high, 3)}"
                )
                key = spoken(f"{before(body)}coatings.{i}.thickness")
                raise CaseError(f"{first}{key}: {reason}")
        moduli = [*(E for E, _, _ in seen.coatings), seen.substrate[0]]
        contrast = max(E / min(moduli[i:]) for i, E in enumerate(moduli))
        if contrast > CONTRAST:
            reason = (
                f"moduli: a layer is {contrast:.3g} times as stiff as one below it; at most {CONTRAST:g} is "
                "supported; lower its modulus or raise the one below"
            )
            raise CaseError(f"{first}{'ball' if body == BALL else 'problem'}: {reason}")


def _claims(path: Path, checked: _CaseFile, problem: CoatedContact) -> tuple[Claim, ...]:
    if not checked.claim:
        return standard_claims(problem)
    known = {(c.quantity, c.line) for c in standard_claims(problem)}
    sources = sources_of(problem)
    claims = []
    for i, claim in enumerate(checked.claim):
        key = f"{path}: {place('claim', i)}"
        if claim.line != "contact":
            try:
                line_of(claim.line, problem)
            except ValueError as error:
                raise CaseError(f"{key}, {error}") from None
        if (claim.quantity, claim.line) not in known:
            fit = sorted(q for q, line in known if line == claim.line)
            raise CaseError(
                f"{key}, quantity = {claim.quantity!r}; on {claim.line} there is {', '.join(fit)}"
            )
        first, second = claim.between
        if first == second or not {first, second} <= set(sources):
            raise CaseError(f"{key}, between = {claim.between}; give two of {', '.join(sources)}")
        claims.append(Claim(claim.quantity, claim.line, (first, second), claim.cap, claim.why, claim.edge))
    return tuple(claims)


def shipped_cases() -> dict[str, Path]:
    """The spheres of the default run, by name, in the order of their file names."""
    return {path.stem: path for path in sorted(CASES.glob("*.toml"))}


def shaped_cases() -> dict[str, Path]:
    """The indenters of the default run that are no spheres, likewise."""
    return {path.stem: path for path in sorted(SHAPES.glob("*.toml"))}


def default_cases() -> dict[str, Path]:
    """All cases of the default run, the spheres first."""
    return shipped_cases() | shaped_cases()
