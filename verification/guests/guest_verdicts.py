"""Verdicts on a guest's answers about one case.

A guest that states no uncertainty gets that of its refinement study, by Roache's grid convergence index:

    U = F |f_n - f_{n-1}| / (r^p - 1),   p = ln(|f_{n-1} - f_{n-2}| / |f_n - f_{n-1}|) / ln r

Roache, J. Fluids Eng. 116 (1994) 405-413. F = 1.25 where p is observed within ``ORDERS``; elsewhere changes
are erratic, as those of a radius counted in patches, and F = 3 with the lower bound or the order 1. A change
that is small by chance does not count: |f_n - f_{n-1}| is at least that of the level before over r^2; along
a line the largest of its neighbours.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.ndimage import maximum_filter1d

from verification.guests.case_exam import claims_of, profiles_of
from verification.guests.doors.program_door import TimedAnswer
from verification.guests.exam_subjects import REFERENCE, Subject, reference_of
from verification.guests.guest_description import Guest
from verification.guests.guest_protocol import GuestAnswer
from verification.judging.verdict import Claim, Outcome, Verdict
from verification.problem.array_types import Array
from verification.problem.line_profile import Profile
from verification.problem.quantity import BALL_PEAKS, PEAKS
from verification.running.case_result import CaseResult, SourceResult
from verification.running.contact_run import decide

ORDERS = (0.5, 2.1)  # Eca and Hoekstra, J. Comput. Phys. 262 (2014) 104-130
NEIGHBOURS = 5


def estimated(levels: Sequence[float], profiles: Sequence[Profile]) -> Array:
    """Uncertainty of the last of ``profiles``, of one quantity at ``levels``, coarse to fine; its shape.

    The order is that of the mean changes along the line.
    """
    coarse, middle, fine = (profile.value for profile in profiles[-3:])
    ratios = [max(b / a, a / b) for a, b in pairwise(levels)][-2:]
    early, late = np.abs(middle - coarse), np.abs(fine - middle)
    r = ratios[1]
    p = observed_order(float(np.mean(early)), float(np.mean(late)), ratios)
    change = np.maximum(late, early / r**2)
    if change.size > 1:
        change = maximum_filter1d(change, NEIGHBOURS, mode="nearest")
    low, high = ORDERS
    regular = low <= p <= high
    order = p if regular else float(np.nan_to_num(np.clip(p, low, 1.0), nan=low))
    found: Array = (1.25 if regular else 3.0) * change / (r**order - 1)
    return found


def observed_order(early: float, late: float, ratios: Sequence[float]) -> float:
    """Order at which changes fall, solved for p of (r1^p - 1) r2^p / (r2^p - 1) = early / late.

    ratios : r1 of the coarse and the middle level, r2 of the middle and the fine one.
    Infinite where the last change is 0, NaN where there is none.
    """
    if not (np.isfinite(early) and np.isfinite(late)):
        return float("nan")
    if late == 0:
        return float("inf") if early else float("nan")
    if early == 0:
        return float("-inf")
    r1, r2 = ratios
    p = float(np.log(early / late) / np.log(r2))
    for _ in range(50):  # Celik et al., J. Fluids Eng. 130 (2008) 078001; exact at once for r1 = r2
        if not 0.01 < p < 50:
            break
        p = float(np.log(early / late * (r2**p - 1) / (r1**p - 1)) / np.log(r2)) if r1 != r2 else p
    return p


def judged(guest: Guest, case: Subject, exam: CaseResult, replies: Sequence[TimedAnswer]) -> CaseResult:
    """The verdicts on ``replies``, one for each level, with the profiles behind them."""
    levels = [profiles_of(reply.answer, exam, guest) for reply in replies]
    last = replies[-1].answer
    found = {(p.quantity, p.line): p for p in levels[-1]} if last.values is not None else {}
    if last.values and guest.levels:
        found = {key: _with_uncertainty(guest, key, profile, levels) for key, profile in found.items()}
    profiles = {(q, line, guest.name): profile for (q, line), profile in found.items()}
    reference = reference_of(case.problem)
    profiles |= {(p.quantity, p.line, reference): p for p in exam.profiles}
    seconds = replies[-1].seconds
    mine = SourceResult(guest.name, seconds, last.error, _diagnostics(guest, replies))
    (exact,) = exam.sources
    outcomes = {guest.name: mine, reference: exact}
    verdicts = []
    for claim in claims_of(case, guest):
        verdict = _unanswered(guest, claim, exam, last, (claim.quantity, claim.line) in found)
        if verdict is None:
            verdict = decided(guest, decide(claim, profiles, outcomes, case.problem))
        verdicts.append((claim, verdict))
    return CaseResult.of(
        case,
        sources=(mine, exact),
        profiles=tuple(profiles.values()),
        verdicts=tuple(verdicts),
        seconds=sum(r.seconds for r in replies),
    )


def refused(guest: Guest, case: Subject, reason: str) -> CaseResult:
    """The result of a case that the guest does not solve, by its own statement."""
    verdict = Verdict(Outcome.UNSUPPORTED, reason)
    verdicts = tuple((claim, verdict) for claim in claims_of(case, guest))
    return CaseResult.of(case, sources=(SourceResult(guest.name, 0.0),), verdicts=verdicts)


def decided(guest: Guest, verdict: Verdict) -> Verdict:
    """``verdict`` with what the guest claims: a difference within the claim agrees, whatever its own U is.

    The reason says where U does not cover the difference, or is larger than it may be.
    """
    gap, U = verdict.difference, verdict.uncertainty
    if gap is None or (guest.claim is None and U is not None):
        return verdict
    if guest.claim is None:
        reason = f"difference {gap:.2e}; the guest states no uncertainty: give refine or claim"
        return replace(verdict, outcome=Outcome.INCONCLUSIVE, reason=reason)
    within = gap <= guest.claim
    if not within and U is not None:
        return replace(verdict, reason=f"{verdict.reason}; the claim is {guest.claim:g}")
    reason = f"difference {gap:.2e} {'within' if within else 'exceeds'} the claimed {guest.claim:g}"
    if U is None:
        reason += "; the guest states no uncertainty"
    elif verdict.outcome is not Outcome.AGREES:
        study = f"the levels of {guest.parameter} do" if guest.levels else "what it states does"
        reason += f"; {study} not show this accuracy: {verdict.reason}"
    return replace(verdict, outcome=Outcome.AGREES if within else Outcome.DISAGREES, reason=reason)


def _unanswered(
    guest: Guest, claim: Claim, exam: CaseResult, answer: GuestAnswer, found: bool
) -> Verdict | None:
    """UNSUPPORTED or NO_RESULT of a quantity that the guest does not give, or could not; None of others."""
    missing = answer.unsupported or guest.lack(claim.quantity) or _at_the_edge(guest, claim, exam)
    if missing is None and answer.error is None and not found:
        failed = answer.failed.get(claim.line, {}).get(claim.quantity)
        if failed is not None:
            return Verdict(Outcome.NO_RESULT, f"{guest.name}: {failed}")
        missing = answer.missing.get(claim.line, {}).get(claim.quantity, "not answered")
    return None if missing is None else Verdict(Outcome.UNSUPPORTED, missing)


def _at_the_edge(guest: Guest, claim: Claim, exam: CaseResult) -> str | None:
    """Why a largest tension is not asked for: it lies at the contact edge, which the guest leaves out."""
    for names in (PEAKS, BALL_PEAKS):
        if guest.edge and claim.quantity in names:
            place, a = (
                exam.profile_of[q, "contact", REFERENCE].value[0] for q in (names[1], "contact_radius")
            )
            if abs(abs(place) - a) < guest.edge * a:
                return f"at the contact edge, where the guest gives no stress (edge = {guest.edge:g})"
    return None


def _with_uncertainty(
    guest: Guest, key: tuple[str, str], profile: Profile, levels: Sequence[Sequence[Profile]]
) -> Profile:
    """``profile`` with its stated uncertainty, or that of the refinement study where every level gives it."""
    study = [p for level in levels for p in level if (p.quantity, p.line) == key]
    if profile.uncertainty is not None or len(study) != len(guest.levels):
        return profile
    return replace(profile, uncertainty=estimated(guest.levels, study))


def _diagnostics(guest: Guest, replies: Sequence[TimedAnswer]) -> dict[str, Any]:
    memory = max((r.memory for r in replies if r.memory), default=None)
    found: dict[str, Any] = {"memory": memory} if memory else {}
    if guest.levels:
        found[guest.parameter] = list(guest.levels[: len(replies)])
        found["seconds"] = [r.seconds for r in replies]
    return found
