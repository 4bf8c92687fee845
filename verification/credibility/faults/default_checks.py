"""One check of the default run with its outcome."""

from collections.abc import Sequence
from dataclasses import dataclass

from verification.credibility.self_tests import SelfTest
from verification.judging.invariants import Invariant
from verification.judging.verdict import Claim, Outcome, Verdict
from verification.regression.baseline_change import Drift, State
from verification.regression.manifest import Difference, manifest_message
from verification.sources.source_registry import CLOSED, EXACT, PUBLISHED


@dataclass(frozen=True)
class Check:
    """``name`` is the quantity, invariant or self-test; ``detail`` its line and sources."""

    column: str
    name: str
    case: str
    detail: str
    outcome: Outcome
    reason: str

    @property
    def passed(self) -> bool:
        return self.outcome is Outcome.AGREES

    @property
    def reports(self) -> bool:
        """True where the check finds an error, or U above its cap; not where a source has no result."""
        return self.outcome in (Outcome.DISAGREES, Outcome.INCONCLUSIVE)

    @property
    def compares(self) -> bool:
        """True for a comparison with another source."""
        return self.column.startswith(("bare", "coated"))

    @property
    def key(self) -> tuple[str, str, str, str]:
        """What identifies the check."""
        return self.column, self.name, self.case, self.detail

    @property
    def message(self) -> str:
        """The check with its reason."""
        return f"{self.name} ({', '.join(filter(None, (self.detail, self.case)))}): {self.reason}"[:400]


def of_claim(claim: Claim, verdict: Verdict, case: str, coated: bool) -> Check:
    """A comparison; that with a published table has a column of its own."""
    sides = set(claim.between)
    other = "closed form" if sides & set(CLOSED) else "exact" if sides & set(EXACT) else "methods"
    column = PUBLISHED if PUBLISHED in sides else f"{'coated' if coated else 'bare'}, {other}"
    detail = f"{claim.line}, {' against '.join(claim.between)}"
    return Check(column, claim.quantity, case, detail, verdict.outcome, verdict.reason)


def of_invariant(row: Invariant, case: str) -> Check:
    """An invariant; its number at the end (interface 1, layer 0) belongs to the detail."""
    name, _, place = row.name.partition(", ")
    detail = ", ".join(filter(None, (place, row.source)))
    return Check("invariants", name, case, detail, row.outcome, row.message)


def of_study(row: Invariant) -> Check:
    """A judged study."""
    return Check("studies", row.name, "", "", row.outcome, row.message)


def of_baseline(row: Drift, case: str) -> Check:
    """A profile compared with the baseline."""
    outcome = Outcome.AGREES if row.state is State.SAME else Outcome.DISAGREES
    detail = f"{row.quantity} on {row.line}, {row.source}"
    return Check("baseline", "baseline", case, detail, outcome, row.message)


def of_manifest(found: Sequence[Difference], case: str) -> Check:
    """What is judged of a case compared with the clean run."""
    message = manifest_message([row for row in found if row.less])
    outcome = Outcome.DISAGREES if message else Outcome.AGREES
    return Check("manifest", "manifest", case, "what is judged", outcome, message)


def of_self_test(test: SelfTest) -> Check:
    """A self-test of the harness: passed or not."""
    outcome = Outcome.AGREES if test.passed else Outcome.DISAGREES
    return Check("self-tests", test.name, "", test.statement, outcome, test.found)
