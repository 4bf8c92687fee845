"""The result of a case, with its exact JSON form."""

from dataclasses import asdict, dataclass, field, is_dataclass
from typing import Any

import numpy as np

from verification.judging.invariants import Invariant
from verification.judging.verdict import Claim, Outcome, Verdict
from verification.problem.contact import CoatedContact, PrescribedLoad
from verification.problem.loading import LoadingCurve
from verification.problem.profile import Profile

__all__ = [
    "SCHEMA",
    "CaseResult",
    "RunInfo",
    "SourceResult",
    "describe",
    "diagnostics_of",
    "from_json",
    "plain",
    "sentence",
    "to_json",
]

SCHEMA = "coatcheck-report/1"


@dataclass(frozen=True)
class SourceResult:
    """How one method or reference fared: its seconds and diagnostics, or the sentence it failed with.

    budget : (quantity, knob, uncertainty) rows of the method's own ladders, SI.
    """

    source: str
    seconds: float
    failure: str | None = None
    diagnostics: dict[str, Any] = field(default_factory=dict)
    budget: tuple[tuple[str, str, float], ...] = ()


@dataclass(frozen=True, eq=False)
class CaseResult:
    """Everything one case came to; the report is drawn from these alone.

    problem : the fields of CoatedContact, with the scales a_h, p_h, delta_h and the interfaces.
    verdicts : one (Claim, Verdict) per claim of the case, in its order.
    published : of a published case its citation and the tables as printed; empty for any other.
    invariants : what each solution was held against by itself.
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

    @property
    def outcome(self) -> Outcome:
        """The worst verdict or invariant: DISAGREES, then NO_RESULT, then INCONCLUSIVE, then AGREES."""
        found = {verdict.outcome for _, verdict in self.verdicts}
        found |= {invariant.outcome for invariant in self.invariants}
        for outcome in (Outcome.DISAGREES, Outcome.NO_RESULT, Outcome.INCONCLUSIVE):
            if outcome in found:
                return outcome
        return Outcome.AGREES if found else Outcome.NO_RESULT

    def profile(self, quantity: str, line: str, source: str) -> Profile | None:
        """The profile of ``quantity`` on ``line`` by ``source``; None where there is none."""
        for profile in self.profiles:
            if (profile.quantity, profile.line, profile.source) == (quantity, line, source):
                return profile
        return None


@dataclass(frozen=True)
class RunInfo:
    """Where and how a run was made: the command, its start (ISO 8601), seconds, versions by package."""

    command: str
    started: str
    seconds: float
    jobs: int
    commit: str | None
    machine: str
    versions: dict[str, str]


def to_json(result: CaseResult) -> dict[str, Any]:
    """Plain dictionaries, lists, numbers and text; NaN and infinity become text, so the JSON is strict."""
    return {
        "schema": SCHEMA,
        "name": result.name,
        "title": result.title,
        "source": result.source,
        "outcome": result.outcome,
        "seconds": result.seconds,
        "problem": plain(result.problem),
        "sources": [plain(vars(source)) for source in result.sources],
        "verdicts": [
            {"claim": plain(vars(claim)), "verdict": plain(vars(verdict))}
            for claim, verdict in result.verdicts
        ],
        "profiles": [plain(vars(profile)) for profile in result.profiles],
        "case_file": result.text,
        "published": plain(result.published),
        "invariants": [plain(vars(invariant)) for invariant in result.invariants],
    }


def from_json(data: dict[str, Any]) -> CaseResult:
    """The inverse of ``to_json``. Raises ValueError for another schema or a part that is not what it states.

    The data may be a stranger's: every part is brought to its type, nothing in it is looked up or called.
    """
    if data.get("schema") != SCHEMA:
        raise ValueError(
            f"schema = {data.get('schema')!r}; this version reads {SCHEMA!r}, run the case again"
        )
    try:
        return CaseResult(
            name=str(data["name"]),
            title=str(data["title"]),
            source=str(data["source"]),
            problem=dict(data["problem"]),
            sources=tuple(
                SourceResult(
                    str(s["source"]),
                    float(s["seconds"]),
                    None if s["failure"] is None else str(s["failure"]),
                    dict(s["diagnostics"]),
                    tuple((str(q), str(k), float(v)) for q, k, v in s["budget"]),
                )
                for s in data["sources"]
            ),
            profiles=tuple(_profile(p) for p in data["profiles"]),
            verdicts=tuple((_claim(v["claim"]), _verdict(v["verdict"])) for v in data["verdicts"]),
            seconds=float(data["seconds"]),
            text=str(data["case_file"]),
            published=dict(data.get("published", {})),
            invariants=tuple(_invariant(row) for row in data["invariants"]),
        )
    except (KeyError, TypeError, AttributeError, OverflowError) as error:
        raise ValueError(f"not a result of this program ({error!r}); run the case again") from None


def _profile(p: dict[str, Any]) -> Profile:
    position, value = _array(p["position"]), _array(p["value"])
    spread = None if p["uncertainty"] is None else _array(p["uncertainty"])
    if position.shape != value.shape or (spread is not None and spread.shape != value.shape):
        raise ValueError(f"profile of {p['quantity']} on {p['line']}: as many values as positions are needed")
    return Profile(str(p["quantity"]), str(p["line"]), position, value, str(p["source"]), spread)


def _claim(c: dict[str, Any]) -> Claim:
    first, second = c["between"]
    texts = {key: str(c[key]) for key in ("quantity", "line", "why")}
    return Claim(**texts, between=(str(first), str(second)), cap=float(c["cap"]), edge=float(c["edge"]))


def _verdict(v: dict[str, Any]) -> Verdict:
    keys = ("difference", "uncertainty", "margin", "worst")
    figures = {key: None if v[key] is None else float(v[key]) for key in keys}
    return Verdict(Outcome(v["outcome"]), str(v["reason"]), **figures)


def _invariant(row: dict[str, Any]) -> Invariant:
    name, source, said = (str(row[key]) for key in ("name", "source", "message"))
    value, bound = (None if row[key] is None else float(row[key]) for key in ("value", "bound"))
    return Invariant(name, source, value, bound, Outcome(row["outcome"]), said)


def plain(value: Any) -> Any:
    """``value`` as strict JSON takes it: containers and numbers of Python, NaN and infinity as text."""
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float) and not np.isfinite(value):
        return repr(value)
    if value is None or isinstance(value, bool | int | float | str):
        return value
    return str(value)


def _array(values: list[Any]) -> np.ndarray:
    return np.array([float(value) for value in values])


def describe(problem: CoatedContact | PrescribedLoad | LoadingCurve) -> dict[str, Any]:
    """The fields of a problem; of a contact its Hertz scales and interfaces besides."""
    if not isinstance(problem, CoatedContact):
        return asdict(problem)
    return asdict(problem) | {
        "a_h": problem.a_h,
        "p_h": problem.p_h,
        "delta_h": problem.delta_h,
        "interfaces": problem.interfaces,
    }


def diagnostics_of(diagnostics: Any) -> dict[str, Any]:
    """A method's own record as a dictionary."""
    return asdict(diagnostics) if is_dataclass(diagnostics) and not isinstance(diagnostics, type) else {}


def sentence(error: Exception) -> str:
    """What went wrong, in one line."""
    text = " ".join(str(error).split())[:500]
    # Both methods raise ValueError or their own NotConverged with a sentence; anything else is named.
    if isinstance(error, ValueError) or type(error).__name__ == "NotConverged":
        return text
    return f"{type(error).__name__}: {text or 'no message'}"
