"""Examination of a guest on several cases: exact references, questions, answers, verdicts."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from verification.cases.case_file import Case
from verification.guests.case_exam import claims_of, exam_task, kept_exam, question_of
from verification.guests.diagnosis.slip_diagnosis import Cause, causes_of
from verification.guests.doors.ask_guest import ask_task, end_programs
from verification.guests.doors.file_door import pack
from verification.guests.doors.program_door import TimedAnswer
from verification.guests.exam_subjects import Subject, subjects_of
from verification.guests.guest_description import Guest
from verification.guests.guest_protocol import Question
from verification.guests.guest_verdicts import judged, refused
from verification.judging.verdict import Claim, Outcome, Verdict
from verification.running.case_result import CaseResult
from verification.running.checked_files import StoreError

Solve = Callable[[Sequence[Any], float], list[Any]]  # tasks and their time limit [s]
EXACT_LIMIT = 300.0  # s of the exact reference of a case
MARGIN = 30.0  # s beyond the limits of the guest's own answers, to end it


@dataclass(frozen=True, eq=False)
class Examined:
    """The results of a guest, a case each, and its answers at each level by case."""

    guest: Guest
    results: tuple[CaseResult, ...]
    replies: dict[str, list[TimedAnswer]]
    subjects: tuple[Subject, ...]

    @cached_property
    def comparisons(self) -> list[tuple[CaseResult, Claim, Verdict]]:
        """Every comparison of every case."""
        return [(result, claim, verdict) for result in self.results for claim, verdict in result.verdicts]

    @cached_property
    def causes(self) -> dict[str, dict[str, Cause]]:
        """The likely slips by name, of each the cases in which it explains wrong answers."""
        found: dict[str, dict[str, Cause]] = {}
        for case, result in zip(self.subjects, self.results, strict=True):
            for cause in causes_of(case, result, self.guest.name):
                found.setdefault(cause.name, {})[result.name] = cause
        return dict(sorted(found.items(), key=lambda item: -sum(len(c.places) for c in item[1].values())))

    @cached_property
    def explained(self) -> set[tuple[str, str, str]]:
        """Case, quantity, line of each wrong answer that a likely slip explains."""
        by = (one for cases in self.causes.values() for one in cases.items())
        return {(case, *place) for case, cause in by for place in cause.places}

    @property
    def remarks(self) -> Counter[str]:
        """Remarks on the answers themselves, with the number of cases."""
        return Counter(text for replies in self.replies.values() for text in set(replies[-1].answer.warnings))

    @cached_property
    def total(self) -> Counter[Outcome]:
        """How many comparisons have each outcome."""
        return outcome_counts(self.results)

    @property
    def answered(self) -> int:
        """How many comparisons the guest supports."""
        return self.total.total() - self.total[Outcome.UNSUPPORTED]

    @cached_property
    def _listed(self) -> list[tuple[str, str, Outcome]]:
        """Name, reason and outcome of each comparison that is listed as a known failure."""
        return [
            (f"{result.name}/{claim.quantity}/{claim.line}", reason, verdict.outcome)
            for result, claim, verdict in self.comparisons
            if verdict.outcome is not Outcome.UNSUPPORTED
            and (reason := self.guest.known_failure(result.name, claim)) is not None
        ]

    @property
    def known(self) -> list[tuple[str, str]]:
        """Name and reason of each known failure that does fail."""
        return [(name, why) for name, why, outcome in self._listed if outcome is not Outcome.AGREES]

    @property
    def unexpected(self) -> list[tuple[str, str]]:
        """Name and reason of each listed known failure that does not fail."""
        failing = {why for _, why in self.known}
        listed = [(name, why) for name, why, outcome in self._listed if outcome is Outcome.AGREES]
        return [(name, why) for name, why in listed if why not in failing]


def examined(guest: Guest, cases: Sequence[Case], folder: Path, solve: Solve, jobs: int = 1) -> Examined:
    """``guest`` examined on ``cases``, exact references and answers stored under ``folder``.

    solve : runs tasks with a time limit each, as ``run_tasks`` does.
    jobs : programs side by side.
    """
    subjects = subjects_of(cases, guest)
    chosen = [case for case in subjects if guest.refusal(case.problem) is None]
    exams = dict(zip((case.name for case in chosen), _exams(chosen, folder, solve), strict=True))
    able = [case for case in chosen if exams[case.name].profiles]
    limit = guest.time_limit * len(guest.questions) + MARGIN
    tasks = [ask_task(guest, case, folder, number % jobs) for number, case in enumerate(able)]
    try:
        answers = solve(tasks, limit)
    finally:
        end_programs()
    replies = {case.name: answer for case, answer in zip(able, answers, strict=True)}
    results = []
    for case in subjects:
        reason = guest.refusal(case.problem)
        if reason is not None:
            results.append(refused(guest, case, reason))
        elif case.name in replies:
            results.append(judged(guest, case, exams[case.name], replies[case.name]))
        else:
            results.append(exams[case.name])
    return Examined(guest, tuple(results), replies, subjects)


def packed_cases(guest: Guest, cases: Sequence[Case], folder: Path, solve: Solve) -> list[Question]:
    """Write the files to fill in of each case that ``guest`` supports; returns the finest question of each.

    Raises StoreError where one cannot be solved or written.
    """
    chosen = [case for case in subjects_of(cases, guest) if guest.refusal(case.problem) is None]
    packed = []
    for case, exam in zip(chosen, _exams(chosen, folder, solve), strict=True):
        if not exam.profiles:
            raise StoreError(f"{case.name}: {exam.sources[0].failure}")
        claims = claims_of(case, guest)
        questions = [question_of(case, exam, guest, claims, parameter) for parameter in guest.questions]
        for question in questions:
            pack(guest, case, question)
        packed.append(questions[-1])
    return packed


def _exams(cases: Sequence[Subject], folder: Path, solve: Solve) -> list[CaseResult]:
    """The exact reference of each case, those of an earlier run kept."""
    found = {case.name: exam for case in cases if (exam := kept_exam(folder, case)) is not None}
    new = [case for case in cases if case.name not in found]
    solved = solve([exam_task(case, folder) for case in new], EXACT_LIMIT)
    found |= {case.name: exam for case, exam in zip(new, solved, strict=True)}
    return [found[case.name] for case in cases]


def outcome_counts(results: Sequence[CaseResult]) -> Counter[Outcome]:
    """How many comparisons have each outcome."""
    return Counter(verdict.outcome for result in results for _, verdict in result.verdicts)
