"""One planted fault tried against the checks of the default run, each with its outcome."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from faults_planted import short_study
from faults_planted.fault_planting import Fault, planted
from verification.cases.case_file import Case, default_cases, read_case
from verification.cases.published_file import PublishedCase, published_cases, read_published
from verification.cases.published_table import PublishedColumn
from verification.credibility.self_tests import SelfTest, self_tests
from verification.judging.invariant_verdict import Invariant
from verification.judging.invariants import check as invariants_of
from verification.judging.invariants import resolved
from verification.judging.invariants.resolved_invariants import NAMES
from verification.judging.verdict import Claim, Outcome, Verdict
from verification.problem.array_types import Array
from verification.problem.coated_contact import ContactSolution
from verification.problem.line_profile import EDGE_LINE, Profile, all_lines
from verification.problem.quantity import DISPLACEMENTS
from verification.regression.baseline_change import State, drift, measured
from verification.regression.manifest import ManifestDifference, differences, manifest_message, manifest_of
from verification.running import contact_run as run
from verification.running import published_run
from verification.running.case_result import CaseResult, SourceResult, from_json
from verification.running.checked_files import read_checked
from verification.sampling.line_sampling import BESIDE_SHAPED, sample, sample_contact
from verification.sampling.stress_plane import plane_invariants, sample_plane
from verification.sources.source_record import Solver
from verification.sources.source_registry import CLOSED, EXACT, METHODS, PUBLISHED

Profiles = dict[tuple[str, str, str], Profile]
Columns = list[tuple[PublishedColumn, np.ndarray]]  # each with the values the methods are compared with
BESIDE = ("baseline", "manifest")  # columns that do not spare the resolved invariants, the studies
FOR_PUBLISHED = METHODS[:1]  # published tables are compared with the faster method only


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


def of_manifest(found: Sequence[ManifestDifference], case: str) -> Check:
    """What is judged of a case compared with the clean run."""
    message = manifest_message([row for row in found if row.less])
    outcome = Outcome.DISAGREES if message else Outcome.AGREES
    return Check("manifest", "manifest", case, "what is judged", outcome, message)


def of_self_test(test: SelfTest) -> Check:
    """A self-test of the harness: passed or not."""
    outcome = Outcome.AGREES if test.passed else Outcome.DISAGREES
    return Check("self-tests", test.name, "", test.statement, outcome, test.found)


@dataclass(frozen=True)
class Trial:
    """Checks of one fault.

    checks : every check that was made, passed or not.   change : the largest change of a value over its
    scale, or of an uncertainty over itself where no value changed; ``changed`` names it.
    failing_clean : checks that do not pass without the fault either, which are no evidence and not among
    ``checks``.   seconds : of one core.   failure : why there was no trial.
    """

    fault: str
    checks: tuple[Check, ...] = ()
    change: float = 0.0
    changed: str = ""
    seconds: float = 0.0
    failure: str | None = None
    failing_clean: tuple[str, ...] = ()


def clean_path(folder: Path, case: str) -> Path:
    """Path of the clean result of a shipped case in the folder of the clean run."""
    return folder / "cases" / f"{case}.json"


def try_fault(fault: Fault, clean_folder: Path) -> Trial:
    """Plant ``fault``, solve and judge what it affects, restore the code.

    Sources without the fault are not solved: their profiles are those of the clean run in ``clean_folder``,
    and the faulty source is sampled at the same points. A trial of a method ends with the case in which a
    predicted comparison reports the fault; invariants between solutions and judged studies, which need
    further solves, are made only where nothing reported it, finite elements under ellipses only where
    predicted. Raises StoreError where the clean run is missing,
    PlantError where the fault no longer fits the source.
    """
    began = time.process_time()
    clean = {name: from_json(read_checked(clean_path(clean_folder, name))) for name in fault.cases}
    published = {name: _as_read(name)[1] for name in fault.published}
    checks: list[Check] = []
    changes: list[tuple[float, str]] = []
    failing = {check.key: check for result in clean.values() for check in _of_clean(result)}
    with planted(fault.changes):
        cases = [read_case(default_cases()[name]) for name in fault.cases]
        for case in cases:
            found, profiles = _judged(case, clean[case.name], fault)
            checks += found
            changes += _changes(clean[case.name], profiles)
            if fault.where in METHODS and _settled(checks, fault):
                break
        # further solves, only where nothing before noticed the fault
        for case in cases:
            if case.resolve and _staged(fault) and not _noticed(checks):
                checks += [of_invariant(row, case.name) for row in resolved(case.problem, _available(fault))]
        for name in fault.published:
            found, moved = _published(name, published[name])
            checks += found
            changes.append(moved)
        if _staged(fault) and not _noticed(checks):
            judged = short_study.quick()
            checks += [Check("studies", row.name, "", "", row.outcome, row.message) for row in judged]
        tests = () if fault.where in METHODS and _settled(checks, fault) else self_tests()
    checks += [of_self_test(test) for test in tests]
    failed = [test.name for test in tests if not test.passed]
    if failed:
        changes.append((float(len(failed)), f"answers of the harness: {', '.join(failed)}"))
    change, changed = max(changes, default=(0.0, "nothing"))
    seconds = time.process_time() - began
    failing_clean = tuple(sorted({failing[c.key].message for c in checks if c.key in failing}))
    evidence = tuple(check for check in checks if check.key not in failing)
    return Trial(fault.name, evidence, change, changed, seconds, failing_clean=failing_clean)


def _settled(checks: Sequence[Check], fault: Fault) -> bool:
    """Whether a comparison that was predicted reports the fault of a method: no further case is needed."""
    return any(c.reports and c.compares and c.name in fault.predicted for c in checks)


def _noticed(checks: Sequence[Check]) -> bool:
    """Whether a check reports the fault; a source without a result leaves that to the further checks."""
    return any(check.reports and check.column not in BESIDE for check in checks)


def _staged(fault: Fault) -> bool:
    """Whether the checks that need further solves are made only where the others pass: of the method."""
    return fault.where == METHODS[0]


def _available(fault: Fault) -> dict[str, Solver]:
    solve = fault.solve or (fault.where,)
    return {name: solver for name, solver in run.solvers().items() if name in solve}


def _of_clean(result: CaseResult) -> list[Check]:
    """The checks of a clean run that do not pass."""
    coated = bool(result.problem["coatings"])
    checks = [of_claim(claim, verdict, result.name, coated) for claim, verdict in result.verdicts]
    checks += [of_invariant(row, result.name) for row in result.invariants]
    return [check for check in checks if not check.passed]


def _judged(case: Case, clean: CaseResult, fault: Fault) -> tuple[list[Check], Profiles]:
    """The verdicts that involve the faulty sources, their invariants and their profiles."""
    solve = fault.solve or (fault.where,)
    profiles: Profiles = {(p.quantity, p.line, p.source): p for p in clean.profiles if p.source not in solve}
    outcomes = {source.source: source for source in clean.sources}
    available = _available(fault)
    staged = _staged(fault)
    solved = run.solve_case(replace(case, resolve=case.resolve and not staged), available)
    outcomes |= solved.outcomes
    fresh: Profiles = {}
    checks: list[Check] = []
    invariants: list[Invariant] = []
    for source, solution in solved.solutions.items():
        try:
            found = _sampled(case, clean, source, solution)
        except Exception as error:  # as in the run itself
            outcomes[source] = SourceResult(source, 0.0, run.message_of(error))
            continue
        fresh |= {(p.quantity, p.line, source): p for p in found}
        invariants += invariants_of(solution, source, case.problem)
    drawn = sample_plane(case.problem.interfaces, solved.solutions)
    invariants += solved.resolved
    invariants += plane_invariants(drawn, solved.solutions, case.problem)
    profiles |= fresh
    checks += [of_invariant(row, case.name) for row in invariants]
    checks += _drifts(clean, fresh)

    def concerned(claim: Claim) -> bool:
        return not available or bool(set(claim.between) & set(solve))

    claims = [claim for claim in case.claims if concerned(claim)]
    verdicts = [(claim, run.decide(claim, profiles, outcomes, case.problem)) for claim in claims]
    coated = bool(case.problem.coatings)
    checks += [of_claim(claim, verdict, case.name, coated) for claim, verdict in verdicts]
    now = replace(clean, verdicts=tuple(verdicts), invariants=tuple(invariants))
    made_here = [row for row in clean.invariants if row.source in solved.solutions]
    before = replace(
        clean,
        verdicts=tuple(one for one in clean.verdicts if concerned(one[0])),
        invariants=tuple(row for row in made_here if not (staged and row.name in NAMES)),
    )
    checks.append(of_manifest(differences(now, manifest_of(before)), clean.name))
    return checks, fresh


def _sampled(case: Case, clean: CaseResult, source: str, solution: ContactSolution) -> list[Profile]:
    places = {profile.line: profile.position for profile in clean.profiles}
    found = list(sample_contact(solution, source))
    radii = [p for p in clean.profiles if (p.quantity, p.line) == ("contact_radius", "contact")]
    edge: float | Array = float(radii[-1].value[0])
    if case.problem.indenter is not None:
        n = BESIDE_SHAPED.size  # the ends lie in the middle of the points around each
        edge = places[EDGE_LINE][n - 1 :: 2 * n - 1]
    for line in all_lines(case.problem):
        found += sample(solution, source, line, places[line.name], case.problem, edge)
    return found


def _drifts(clean: CaseResult, fresh: Profiles) -> list[Check]:
    """The numbers of the sources solved in the trial, compared with the clean run as with a baseline."""
    now = tuple(fresh.get((p.quantity, p.line, p.source), p) for p in clean.profiles)
    found = {numbers.key: numbers for numbers in measured(replace(clean, profiles=now))}
    solved = {source for _, _, source in fresh}
    rows = [drift(then, found[then.key]) for then in measured(clean) if then.source in solved]
    return [
        Check(
            "baseline",
            "baseline",
            clean.name,
            f"{row.quantity} on {row.line}, {row.source}",
            Outcome.AGREES if row.state is State.SAME else Outcome.DISAGREES,
            row.message,
        )
        for row in rows
    ]


def _changes(clean: CaseResult, fresh: Profiles) -> list[tuple[float, str]]:
    """Change of each profile by the fault; where none changed, that of its uncertainty."""
    p_h, delta_h = (float(clean.problem[name]) for name in ("p_h", "delta_h"))
    values, uncertainties = [], []
    for (quantity, line, source), profile in fresh.items():
        old = clean.profile_of.get((quantity, line, source))
        if old is None:
            continue
        scale = delta_h if quantity in DISPLACEMENTS else p_h
        if line == "contact":
            scale = float(abs(old.value[0]))
        where = f"{quantity} on {line} in {clean.name}"
        values.append((_largest(profile.value - old.value) / scale, where))
        if profile.uncertainty is not None and old.uncertainty is not None:
            change = _largest(profile.uncertainty - old.uncertainty) / (_largest(old.uncertainty) or 1.0)
            uncertainties.append((change, f"uncertainty of {where}"))
    return values if any(value > 0 for value, _ in values) else uncertainties


def _largest(values: np.ndarray) -> float:
    """Largest magnitude; infinite where one is not finite."""
    return float(np.max(np.abs(values))) if np.isfinite(values).all() else float("inf")


def _as_read(name: str) -> tuple[PublishedCase, Columns]:
    """A published case, and its columns as they are read now, with or without a fault."""
    case = read_published(published_cases()[name])
    return case, [(column, column.reference.value) for column in case.columns]


def _published(name: str, before: Columns) -> tuple[list[Check], tuple[float, str]]:
    """Verdicts of a published table read under the fault, and how far the fault changed the values read."""
    case, columns = _as_read(name)
    available = {m: s for m, s in run.solvers().items() if m in FOR_PUBLISHED}
    result = published_run.run(case, available)
    decided = [(c, v) for c, v in result.verdicts if set(c.between) & set(available)]
    checks = [of_claim(c, v, name, coated=False) for c, v in decided]
    change = (0.0, "nothing")
    for (old, old_value), (new, value) in zip(before, columns, strict=True):
        moved = max(
            _largest(value - old_value) / old.scale,
            _largest(new.at.z - old.at.z) / (_largest(old.at.z) or 1.0),
        )
        change = max(change, (moved, f"{old.column} of {old.file} as read"))
    return checks, change
