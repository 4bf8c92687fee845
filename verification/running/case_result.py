"""The result of a case, with its exact JSON form."""

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field, is_dataclass
from functools import cached_property
from typing import Any

from verification.judging.invariants import Invariant
from verification.judging.outcome import worst
from verification.judging.verdict import Claim, Outcome, Verdict
from verification.problem.coated_contact import CoatedContact, PrescribedLoad
from verification.problem.line_profile import Profile
from verification.problem.loading_curve import LoadingCurve
from verification.running.json_records import decode, encode

SCHEMA = "coatcheck-report/1"


@dataclass(frozen=True)
class SourceResult:
    """Time and diagnostics of one source of a case, or the message it failed with.

    budget : (quantity, numerical parameter, uncertainty) rows of the method's own refinement studies, SI.
    """

    source: str
    seconds: float
    failure: str | None = None
    diagnostics: dict[str, Any] = field(default_factory=dict)
    budget: tuple[tuple[str, str, float], ...] = ()


@dataclass(frozen=True, eq=False)
class CaseResult:
    """Result of one case, all that the report needs.

    problem : the fields of CoatedContact, with the scales a_h, p_h, delta_h and the interfaces.
    verdicts : one (Claim, Verdict) per claim of the case, in its order.
    published : of a published case its citation and the tables as printed; empty for any other.
    invariants : of each solution by itself.   warnings : of implausible input, and of strains that are not
    small, a line each.   stated : what a case says of its layers that is no part of the problem: names,
    residual stresses, limits, numbers of sub-layers, as in ``Case``; empty where it says nothing.
    remarks : on the input and on what its uncertainties leave out, a line each.
    """

    name: str
    title: str
    source: str
    problem: dict[str, Any]
    sources: tuple[SourceResult, ...]
    profiles: tuple[Profile, ...]
    verdicts: tuple[tuple[Claim, Verdict], ...]
    seconds: float
    text: str = ""
    published: dict[str, Any] = field(default_factory=dict)
    invariants: tuple[Invariant, ...] = ()
    warnings: tuple[str, ...] = ()
    stated: dict[str, Any] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()

    @classmethod
    def of(cls, case: Any, **parts: Any) -> "CaseResult":
        """The result of ``case`` with these ``parts``, empty where none are given."""
        given = {name: getattr(case, name) for name in ("name", "title", "source", "text")}
        stated = {name: getattr(case, name, {}) for name in ("names", "residual", "limits", "layers")}
        if not any(name for names in stated["names"].values() for name in names):
            stated["names"] = {}
        empty = {"sources": (), "profiles": (), "verdicts": (), "seconds": 0.0}
        given |= empty | {"stated": {name: value for name, value in stated.items() if value}} | parts
        return cls(problem=describe(case.problem), **given)

    @classmethod
    def failed(cls, case: Any, reason: str, seconds: float, **parts: Any) -> "CaseResult":
        """The result of a case that could not be run at all: every claim NO_RESULT, for ``reason``."""
        verdicts = tuple((claim, Verdict(Outcome.NO_RESULT, reason)) for claim in case.claims)
        sources = (SourceResult("case", seconds, reason),)
        return cls.of(case, sources=sources, verdicts=verdicts, seconds=seconds, **parts)

    @property
    def outcome(self) -> Outcome:
        """The worst of verdicts and invariants; without any verdict no better than NO_RESULT."""
        judged = {verdict.outcome for _, verdict in self.verdicts}
        found = worst(judged | {invariant.outcome for invariant in self.invariants})
        return found if found is not Outcome.AGREES or Outcome.AGREES in judged else Outcome.NO_RESULT

    @cached_property
    def profile_of(self) -> dict[tuple[str, str, str], Profile]:
        """Each profile by its (quantity, line, source)."""
        return {(profile.quantity, profile.line, profile.source): profile for profile in self.profiles}


@dataclass(frozen=True)
class RunInfo:
    """Provenance of a run: command, start (ISO 8601), seconds, versions by package, hash of the source."""

    command: str
    started: str
    seconds: float
    jobs: int
    commit: str | None
    machine: str
    versions: dict[str, str]
    source: str = ""


def to_json(result: CaseResult) -> dict[str, Any]:
    """``result`` as strict JSON, with its outcome."""
    outcome, data = result.outcome, encode(result)
    verdicts = [{"claim": claim, "verdict": verdict} for claim, verdict in data["verdicts"]]
    data |= {"verdicts": verdicts, "case_file": data.pop("text")}
    return {"schema": SCHEMA, "outcome": outcome} | data


def from_json(data: dict[str, Any]) -> CaseResult:
    """The inverse of ``to_json``; the data may be untrusted.

    Raises ValueError for another schema, a part that is not of its type, a profile whose arrays differ in
    size.
    """
    if data.get("schema") != SCHEMA:
        raise ValueError(
            f"schema = {data.get('schema')!r}; this version reads {SCHEMA!r}, run the case again"
        )
    try:
        verdicts = [(item["claim"], item["verdict"]) for item in data["verdicts"]]
        result = decode(CaseResult, data | {"verdicts": verdicts, "text": data["case_file"]})
    except (KeyError, TypeError) as error:
        raise ValueError(f"not a result of this program ({error!r}); run the case again") from None
    if result.published and not {"tables", "columns"} <= result.published.keys():
        raise ValueError("a published result of another version; run the case again")
    for p in result.profiles:
        if any(found is not None and found.shape != p.position.shape for found in (p.value, p.uncertainty)):
            raise ValueError(f"profile of {p.quantity} on {p.line}: as many values as positions are needed")
    return result


def describe(problem: CoatedContact | PrescribedLoad | LoadingCurve) -> dict[str, Any]:
    """The fields of a problem; of a contact its Hertz scales and interfaces besides."""
    if not isinstance(problem, CoatedContact):
        return asdict(problem)
    known = asdict(problem)
    if problem.indenter is None:
        del known["indenter"]
    return known | {
        "a_h": problem.a_h,
        "p_h": problem.p_h,
        "delta_h": problem.delta_h,
        "dundurs_beta": problem.dundurs_beta,
        "S_h": problem.S_h,
        "interfaces": problem.interfaces,
    }


def attempted(source: str, solve: Callable[[], Any]) -> tuple[Any, SourceResult]:
    """The find of ``solve``, None where it fails, and the row of the report: any failure is a message."""
    begin = time.perf_counter()
    try:
        found = solve()
    except Exception as error:
        return None, SourceResult(source, time.perf_counter() - begin, message_of(error))
    known, budget = found.diagnostics, getattr(found.uncertainty, "budget", ())
    diagnostics = known if isinstance(known, dict) else asdict(known) if is_dataclass(type(known)) else {}
    return found, SourceResult(source, time.perf_counter() - begin, None, diagnostics, budget)


def message_of(error: Exception) -> str:
    """The message of ``error`` in one line."""
    text = " ".join(str(error).split())[:500]
    # Both methods raise ValueError or their own NotConverged with a whole message; any other has its type.
    if isinstance(error, ValueError) or type(error).__name__.endswith("NotConverged"):
        return text
    return f"{type(error).__name__}: {text or 'no message'}"
