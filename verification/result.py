"""The result of a case, with its exact JSON form."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from verification.profile import Profile
from verification.verdict import Claim, Outcome, Verdict

__all__ = ["SCHEMA", "CaseResult", "RunInfo", "SourceResult", "from_json", "plain", "to_json"]

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

    @property
    def outcome(self) -> Outcome:
        """The worst verdict: DISAGREES, then NO_RESULT, then INCONCLUSIVE, then AGREES."""
        found = {verdict.outcome for _, verdict in self.verdicts}
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
    }


def from_json(data: dict[str, Any]) -> CaseResult:
    """The inverse of ``to_json``. Raises ValueError where the schema is another one."""
    if data.get("schema") != SCHEMA:
        raise ValueError(
            f"schema = {data.get('schema')!r}; this version reads {SCHEMA!r}, run the case again"
        )
    return CaseResult(
        name=data["name"],
        title=data["title"],
        source=data["source"],
        problem=data["problem"],
        sources=tuple(
            SourceResult(
                s["source"],
                s["seconds"],
                s["failure"],
                s["diagnostics"],
                tuple((str(q), str(k), float(v)) for q, k, v in s["budget"]),
            )
            for s in data["sources"]
        ),
        profiles=tuple(
            Profile(
                p["quantity"],
                p["line"],
                _array(p["position"]),
                _array(p["value"]),
                p["source"],
                None if p["uncertainty"] is None else _array(p["uncertainty"]),
            )
            for p in data["profiles"]
        ),
        verdicts=tuple(
            (
                Claim(**{**v["claim"], "between": tuple(v["claim"]["between"])}),
                Verdict(**{**v["verdict"], "outcome": Outcome(v["verdict"]["outcome"])}),
            )
            for v in data["verdicts"]
        ),
        seconds=data["seconds"],
        text=data["case_file"],
        published=data.get("published", {}),
    )


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
