"""The plan of a study: its TOML file as a sequence of solves."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import product
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import Field, model_validator

from verification.cases import solid_schema
from verification.cases.case_file import SUPPORTED, Sized, refuse_unfit_scales
from verification.cases.plausibility import Limits, likely_slips, stress_warnings, warnings_of
from verification.cases.solid_schema import BallEntry, Coating, Limited, Material, in_metres
from verification.cases.toml_file import NO_SOURCE, CaseError, Strict, Text, read_bounded, read_toml
from verification.cases.unit_numbers import Newtons, Units, units_of
from verification.problem.array_types import Ball, Coatings
from verification.problem.coated_contact import CoatedContact
from verification.problem.indenter_shape import Indenter
from verification.problem.point_answers import FLAT
from verification.running.json_records import encode
from verification.sources.load_of_approach import own_radius
from verification.sources.source_registry import METHODS
from verification.study.choice.failure_criteria import Criteria
from verification.study.solve_cache import solve_key
from verification.study.study_table import SOURCES
from verification.study.sweep_values import MOST_POINTS, Range, Sweep, thicknesses_between

STUDIES = Path(__file__).parent.parent / "cases" / "shipped" / "studies"


@dataclass(frozen=True)
class Solve:
    """One contact solved by one source; it covers every friction of the study at each of its places.

    first : number of its first point.  request : argument of ``point.answer``.
    places : (thickness [m], load [N]) of equal h/a_h, of which the request is the first.
    """

    first: int
    request: dict[str, Any]
    places: tuple[tuple[float, float], ...]

    @property
    def points(self) -> int:
        return len(self.places) * len(self.request["frictions"])

    @property
    def source(self) -> str:
        return self.request["source"]

    @cached_property
    def key(self) -> str:
        """Key of the solve in the cache."""
        return solve_key(self.request)


@dataclass(frozen=True)
class Study:
    """A sphere on coatings of every modulus [Pa] and thickness [m], at every friction; SI.

    loads : smallest and largest [N], number for each thickness; None for ``load`` alone.
    asked_from : smallest load of the file, where ``loads`` were extended below it.
    held : fixed coatings, the first ``swept`` of them above the swept one.
    halved : this study with half of the sub-layers of graded coatings, whose change is part of every
    uncertainty; None where none is graded.
    residual : stress [Pa] of the coating of each modulus, () for none.
    cross_check : every point whose number is a multiple is also solved by the other sources; 0 none.
    ball : None is rigid, or as of CoatedContact.   indenter : an ellipsoid in place of the sphere, likewise.
    numerics : each source's own keywords.  criteria : of the preferable thickness.  text : the file.
    source : where its numbers come from.
    warnings : of implausible numbers, a line each.   hardness : [Pa] by the keys of the file.
    names : of the layers that have one, by the same keys.
    """

    name: str
    title: str
    radius: float
    load: float
    substrate: tuple[float, float]
    coating_nu: float
    moduli: tuple[float, ...]
    thicknesses: tuple[float, ...]
    frictions: tuple[float, ...]
    loads: tuple[float, float, int] | None = None
    asked_from: float | None = None
    residual: tuple[float, ...] = ()
    ball: Ball | None = None
    indenter: Indenter | None = None
    held: Coatings = ()
    swept: int = 0
    halved: "Study | None" = None
    cross_check: int = 10
    numerics: dict[str, dict[str, Any]] = field(default_factory=dict)
    criteria: Criteria = field(default_factory=Criteria)
    source: str = ""
    text: str = ""
    warnings: tuple[str, ...] = ()
    hardness: Limits = field(default_factory=dict)
    names: dict[str, str] = field(default_factory=dict)
    units: Units = field(default_factory=Units)

    @property
    def bare(self) -> CoatedContact:
        """The contact at ``load`` without coatings on the flat."""
        return CoatedContact(
            self.radius, self.load, (), self.substrate, ball=self.ball, indenter=self.indenter
        )

    @property
    def points(self) -> int:
        """Number of points; friction varies fastest, then thickness, then modulus."""
        return len(self.moduli) * len(self.frictions) * sum(len(places) for places in self.places)

    @cached_property
    def places(self) -> tuple[tuple[tuple[float, float], ...], ...]:
        """The (thickness [m], load [N]) of each solve: those of equal h/a_h, of which one stands for all.

        Of a study of loads h/a_h has equal ratios, and so have the loads at each thickness.
        """
        if self.loads is None:
            return tuple(((h, self.load),) for h in self.thicknesses)
        low, high, count = self.loads
        unit = self.bare.a_h / self.load ** (1 / 3)
        thin, thick = min(self.thicknesses), max(self.thicknesses)
        first, last = thin / (unit * high ** (1 / 3)), thick / (unit * low ** (1 / 3))
        steps = max(1, round(3 * (count - 1) * np.log(last / first) / np.log(high / low)))
        ratio, found = (last / first) ** (3 / steps), []
        for s in np.geomspace(first, last, steps + 1).tolist():
            loads = [(h, (h / (s * unit)) ** 3) for h in self.thicknesses]
            # Up to the first load beyond either end.
            found.append(tuple((h, W) for h, W in loads if low / ratio < W * (1 + 1e-9) and high * ratio > W))
        return tuple(places for places in found if places)

    def solves(self) -> Iterator[Solve]:
        """Every solve, in the order of its points; of each point first the semi-analytical one."""
        first = 0
        for (i, E), places in product(enumerate(self.moduli), self.places):
            thickness, load = places[0]
            stress = self.residual[i] if self.residual else 0.0
            # Over p_h, which is that of the load, it differs between the places.
            residual = [stress * (load / W) ** (1 / 3) for _, W in places] if stress else [0.0]
            step = len(places) * len(self.frictions)
            checked = self.cross_check and -(-first // self.cross_check) * self.cross_check < first + step
            # Of thin films in a stack the exact reference takes minutes; an ellipse it does not solve.
            checks = METHODS if self.held or self.indenter else SOURCES
            for source in checks if checked else SOURCES[:1]:
                request = {
                    "source": source,
                    "numerics": self.numerics.get(source, {}),
                    **self._solid(E, thickness, load),
                    "residual": residual,
                    "frictions": list(self.frictions),
                    **({"halved": self.halved._solid(E, thickness, load)} if self.halved else {}),
                }
                yield Solve(first, request, places)
            first += step

    def contact(self, E: float, thickness: float, load: float) -> CoatedContact:
        """The contact whose swept coating has the modulus ``E`` [Pa] and a ``thickness`` [m]."""
        above, below = self.held[: self.swept], self.held[self.swept :]
        return replace(self.bare, load=load, coatings=(*above, (E, self.coating_nu, thickness), *below))

    def _solid(self, E: float, thickness: float, load: float) -> dict[str, Any]:
        """A contact as a request states it."""
        return {"problem": encode(self.contact(E, thickness, load)), "swept": self.swept}


class _SweptProblem(Sized):
    load: Newtons | None = None
    substrate: Material
    coating: Coating | None = None
    coatings: Annotated[list[Coating], Field(default_factory=list, max_length=10)]
    ball: BallEntry | None = None
    temperature_change: solid_schema.TemperatureChange | None = None

    @model_validator(mode="before")
    @classmethod
    def _by_load(cls, given: Any) -> Any:
        if isinstance(given, dict) and "approach" in given:
            raise ValueError("approach differs along a study, whose points share their load: give the load")
        return given

    @model_validator(mode="after")
    def _one_swept(self) -> "_SweptProblem":
        if (self.coating is None) == (not self.coatings):
            raise ValueError("needs exactly one of coating or coatings")
        for i, one in enumerate(self.coatings, start=1):
            if one.is_sized and (one.E is None or one.residual_stress or one.expansion):
                raise ValueError(f"has coating {i}, which is not swept: give its E, and no residual stress")
        if sum(not one.is_sized for one in self.coatings) != bool(self.coatings):
            raise ValueError("needs every thickness of its coatings but that of the one to be swept")
        if self.indenter is not None and self.indenter.radii is None:
            raise ValueError(f"has indenter {self.indenter.shape!r}; a study sweeps balls and ellipsoids")
        if self.varied.layers or self.varied.is_sized:
            raise ValueError("has a swept coating: leave out its thickness and layers, give one E or none")
        return self

    @property
    def swept(self) -> int:
        """Number of the coating that is swept."""
        return next((i for i, one in enumerate(self.coatings) if not one.is_sized), 0)

    @property
    def varied(self) -> Coating:
        """The coating that is swept."""
        return self.coating or self.coatings[self.swept]

    @property
    def materials(self) -> dict[str, Limited]:
        """Every material by its key."""
        flat = {"coating": self.coating} if self.coating else _numbered("coatings", self.coatings)
        ball = {"ball": self.ball, **_numbered("ball.coatings", self.ball.coatings)} if self.ball else {}
        return {"substrate": self.substrate, **flat, **ball}

    @property
    def modulus(self) -> float | None:
        """E of the coating that is swept; None where it is swept too."""
        return self.varied.E if isinstance(self.varied.E, float) else None

    def held(self, a_h: float, over: int = 1) -> dict[str, Any]:
        """The coatings beside the swept one, how many are above it, and the ball.

        over : divisor of the number of sub-layers.
        """
        above, below = (
            in_metres(some, a_h, over)
            for some in (self.coatings[: self.swept], self.coatings[self.swept + 1 :])
        )
        ball = self.ball.coated(a_h, over) if self.ball else None
        return {"held": (*above, *below), "swept": len(above), "ball": ball}

    def graded(self) -> bool:
        """Whether a coating beside the swept one is graded."""
        return any(one.layers for one in (*self.coatings, *(self.ball.coatings if self.ball else ())))


def _numbered(key: str, some: Sequence[Limited]) -> dict[str, Limited]:
    return {f"{key}.{i}": one for i, one in enumerate(some)}


class _Semianalytic(Strict):
    patches: Annotated[int, Field(ge=33, le=1025)] | None = None
    estimate_uncertainty: bool | None = None


class _Fem(Strict):
    quality: Text | None = None
    estimate_uncertainty: bool | None = None


class _StudyFile(Strict):
    title: Text
    source: Text = NO_SOURCE
    problem: _SweptProblem
    sweep: Sweep
    semianalytic: _Semianalytic = _Semianalytic()
    fem_reference: _Fem = _Fem()
    criteria: Criteria = Criteria()


def read_study_file(path: Path) -> Study:
    """Read and check one study file. Raises CaseError, whose message names file and key."""
    return parse_study(read_bounded(path, "study", "one sweep"), path)


def parse_study(raw: bytes, path: Path) -> Study:
    """Check the content of a study file; ``path`` names it in messages. Raises CaseError."""
    text, checked = read_toml(raw, path, _StudyFile)
    p, sweep = checked.problem, checked.sweep
    limits = {key: value for name, one in p.materials.items() for key, value in one.limits(name).items()}
    try:
        criteria = checked.criteria.with_yield_strengths(limits)
    except ValueError as error:
        raise CaseError(f"{path}: problem.{error}") from None
    for reason in _unfit(p, sweep):
        raise CaseError(f"{path}: {reason}")
    load = sweep.load.to if sweep.load else p.load or 0.0
    try:
        ball, indenter = p.ball.bare if p.ball else None, p.indenter.pair if p.indenter else None
        substrate = (p.substrate.E, p.substrate.nu)
        bare = CoatedContact(p.size, load, (), substrate, ball=ball, indenter=indenter)
        around = p.held(bare.a_h)
    except ValueError as error:
        raise CaseError(f"{path}: {error}") from None
    moduli = [p.modulus] if p.modulus else [r * p.substrate.E for r in sweep.modulus_ratio or ()]
    try:
        below = p.substrate.expansion
        residual = tuple(p.varied.residual(E, p.varied.nu, below, p.temperature_change) for E in moduli)
    except ValueError as error:
        raise CaseError(f"{path}: coating: {error}") from None
    refuse_unfit_scales(path, replace(bare, coatings=around["held"], ball=around["ball"]))
    given = sweep.thickness or sweep.thickness_over_a_h or []
    if isinstance(given, Range):
        given = list(thicknesses_between(given.start, given.to, given.count))
    values = tuple(value * (1.0 if sweep.thickness else bare.a_h) for value in given)
    study = Study(
        name=path.stem,
        title=checked.title,
        radius=p.size,
        load=load,
        substrate=substrate,
        coating_nu=p.varied.nu,
        moduli=tuple(moduli),
        thicknesses=values,
        frictions=tuple(sweep.friction),
        loads=(sweep.load.start, sweep.load.to, sweep.load.count) if sweep.load else None,
        residual=residual if any(residual) else (),
        **around,
        indenter=indenter,
        cross_check=sweep.cross_check,
        numerics={
            source: getattr(checked, source).model_dump(exclude_none=True)
            for source in SOURCES
            if source in _StudyFile.model_fields
        },
        criteria=criteria,
        source=checked.source,
        text=text,
        hardness={key: value for key, value in limits.items() if key.endswith("hardness")},
        names={key: one.name for key, one in p.materials.items() if one.name},
        units=units_of(checked),
    )
    _refuse_beyond_range(path, study, "thickness" if sweep.thickness else "thickness_over_a_h")
    halved = replace(study, **p.held(bare.a_h, over=2)) if p.graded() else None
    return replace(study, halved=halved, warnings=_warnings(study, p, checked.criteria))


def _unfit(p: _SweptProblem, sweep: Sweep) -> Iterator[str]:
    """A message, with its key, on each pair of statements that do not go together."""
    coatings = p.ball.coatings if p.ball else []
    if any(one.expansion for one in (p.ball, *coatings) if one) or any(c.residual_stress for c in coatings):
        yield "ball: leave residual, expansion out, for no stress of the ball is judged"
    if p.varied.expansion is None and (p.substrate.expansion, p.temperature_change) != (None, None):
        key = "temperature_change" if p.substrate.expansion is None else "substrate.expansion"
        yield f"{key}: acts on no coating; give the expansion of the swept one"
    if (p.load is None) == (sweep.load is None):
        yield "needs exactly one of load or sweep.load"
    if sweep.load is not None and len(p.coatings) > 1:
        yield "sweep.load: not with several coatings; sweep the thickness of one"
    if sweep.load is not None and coatings:
        yield "sweep.load: not with coatings on the ball, whose h/a_h varies too"
    if (p.modulus is None) == (sweep.modulus_ratio is None):
        yield "needs exactly one of the coating's E or sweep.modulus_ratio, E1/E2"


def _refuse_beyond_range(path: Path, study: Study, key: str) -> None:
    """Raise CaseError for a thickness, a modulus or a number of points beyond what a study supports.

    key : of the thicknesses.
    """
    ends, moduli = (min(study.thicknesses), max(study.thicknesses)), study.moduli

    def first(*h: float) -> str:
        coatings = tuple((moduli[0], study.coating_nu, one) for one in h)
        slips = likely_slips(replace(study.bare, coatings=coatings)).replace("coating 1", "coating")
        return f"{path}: {slips}; as it stands, " if slips else f"{path}: "

    loads = [study.load, study.loads[0]] if study.loads else [study.load]
    for load, E, h in product(loads, {min(moduli), max(moduli)}, dict.fromkeys(ends)):
        contact = study.contact(E, h, load)
        a = own_radius(contact)
        low, high = (bound * a for bound in SUPPORTED)
        if not low <= h <= high:
            shown = Units.of_contact(contact, a).shown_length
            raise CaseError(
                f"{first(h)}sweep.{key}: value {study.thicknesses.index(h) + 1} is {shown(h)}; it must be "
                f"{shown(low)} to {shown(high)}, {SUPPORTED[0]:g} to {SUPPORTED[1]:g} contact radii"
            )
    for ratio in (E / study.substrate[0] for E in moduli):
        if not 1e-3 <= ratio <= 1e3:
            raise CaseError(f"{first()}E1/E2 = {ratio:.3g}; a study supports 1e-3 to 1e3")
    if study.points > MOST_POINTS:
        raise CaseError(f"{path}: sweep: {study.points} points; a study has at most {MOST_POINTS}")


def _warnings(study: Study, p: _SweptProblem, criteria: Criteria) -> tuple[str, ...]:
    """Warnings of the thinnest coating and the thickest, each once; of strengths and of residual stress."""
    E = p.modulus or p.substrate.E  # a ratio has no unit
    found = [
        line.replace("coating 1, ", "coating, ")
        for h in (min(study.thicknesses), max(study.thicknesses))
        for line in warnings_of(replace(study.bare, coatings=((E, study.coating_nu, h),)))
    ]
    stresses = stress_warnings({FLAT: study.residual[:1]}, study.hardness, p.temperature_change)
    told = (line.replace("coating 1", "coating") for line in stresses)
    return (*dict.fromkeys(found), *criteria.warnings(), *told)


def shipped_studies() -> dict[str, Path]:
    """The studies that come with the package, by name."""
    return {path.stem: path for path in sorted(STUDIES.glob("*.toml"))}
