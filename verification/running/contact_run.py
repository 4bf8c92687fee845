"""One case from its problem to its verdicts."""

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from verification.cases.case_file import Case
from verification.cases.plausibility import strain_warning
from verification.judging.invariants import Invariant, check, resolved
from verification.judging.verdict import Claim, Outcome, Verdict, compare, judge
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, ContactSolution
from verification.problem.line_profile import Profile, all_lines, lines_of
from verification.problem.point_answers import FLAT
from verification.problem.quantity import QUANTITIES, SCALARS, largest_strain
from verification.running.case_result import CaseResult, SourceResult, attempted, message_of
from verification.sampling.line_sampling import edge_of, ends_of, positions, sample, sample_contact
from verification.sources.source_record import Solver
from verification.sources.source_registry import METHODS, solvers, sources_of


def run(case: Case, available: Mapping[str, Solver] | None = None) -> CaseResult:
    """Solve a case by every source its claims name, sample all at the same points, judge the claims.

    A source that fails leaves its message and NO_RESULT on each of its claims; the others are compared.
    available : other solvers by name, as in tests and with planted faults.
    """
    return judge_case(case, solve_case(case, available))


@dataclass(frozen=True, eq=False)
class SolvedCase:
    """Solution and SourceResult of each source of a case, by name; a source that failed has no Solution.

    resolved : invariants between solutions of the problem and of others, where the case has ``resolve``.
    """

    solutions: Mapping[str, ContactSolution]
    outcomes: Mapping[str, SourceResult]
    resolved: tuple[Invariant, ...] = ()


def solve_case(case: Case, available: Mapping[str, Solver] | None = None) -> SolvedCase:
    """Solve a case by every source its claims name; ``available`` as in ``run``."""
    available = solvers() if available is None else available
    wanted = {source for claim in case.claims for source in claim.between}
    outcomes: dict[str, SourceResult] = {}
    solutions: dict[str, ContactSolution] = {}
    for source in (name for name in available if name in wanted):
        solution, outcomes[source] = attempted(source, partial(_solved, case, source, available[source]))
        if solution is not None:
            solutions[source] = solution
    return SolvedCase(solutions, outcomes, resolved(case.problem, available) if case.resolve else ())


def keywords_of(case: Case, source: str) -> dict[str, Any]:
    """Those of ``source`` besides the problem; the semi-analytical method presses by a given approach."""
    stated = {} if case.approach is None or source != METHODS[0] else {"approach": case.approach}
    return case.numerics.get(source, {}) | stated


def _solved(case: Case, source: str, solve: Solver) -> ContactSolution:
    solution: ContactSolution = solve(case.problem, keywords_of(case, source))
    for name in SCALARS:
        if not np.isfinite(value := solution.sample(None, name, False).value):
            raise ValueError(f"{name} = {value}; the solution is not finite")
    return solution


def judge_case(case: Case, solved: SolvedCase, *, invariants: bool = True) -> CaseResult:
    """Sample every solution at the same points of every line, then decide each claim of ``case``.

    invariants : whether each solution is checked against its invariants too.
    """
    started = time.perf_counter()
    solutions, outcomes = dict(solved.solutions), dict(solved.outcomes)
    profiles: dict[tuple[str, str, str], Profile] = {}
    lines = all_lines(case.problem)
    places = positions(case.problem, lines, solutions) if solutions else {}
    edge: float | Array | None = None
    if solutions:
        shaped = case.problem.indenter is not None
        edge = ends_of(next(iter(solutions.values()))) if shaped else edge_of(solutions)
    for source, solution in solutions.items():
        begin, old = time.perf_counter(), outcomes[source]
        try:
            found = list(sample_contact(solution, source))
            for line in lines if source in sources_of(case.problem) else ():
                found += sample(solution, source, line, places[line], case.problem, edge)
        except Exception as error:  # any failed source is a row of the report
            outcomes[source] = SourceResult(source, old.seconds, message_of(error))
            continue
        outcomes[source] = replace(old, seconds=old.seconds + time.perf_counter() - begin)
        profiles |= {(p.quantity, p.line, source): p for p in found}

    held: list[Invariant] = []
    if invariants:
        for source, solution in solutions.items():
            held += check(solution, source, case.problem)
        held += solved.resolved
    verdicts = tuple((claim, decide(claim, profiles, outcomes, case.problem)) for claim in case.claims)
    return CaseResult.of(
        case,
        sources=tuple(outcomes.values()),
        profiles=tuple(profiles.values()),
        verdicts=verdicts,
        seconds=sum(s.seconds for s in solved.outcomes.values()) + time.perf_counter() - started,
        invariants=tuple(held),
        warnings=(*case.warnings, *_strains(case.problem, profiles)),
    )


def _strains(problem: CoatedContact, profiles: Mapping[tuple[str, str, str], Profile]) -> Iterator[str]:
    """A line for each layer whose strain is not small, along the lines of y = 0, by the first source."""
    found: dict[tuple[str, int], float] = {}
    for line in lines_of(problem):
        of = {(p.quantity, p.source): p for p in profiles.values() if p.line == line.name}
        source = next((source for quantity, source in of if quantity == "sigma_xx"), "")
        stresses = [of.get((f"sigma_{component}", source)) for component in ("xx", "yy", "zz", "xz")]
        if None in stresses[:3]:
            continue
        position = of["sigma_xx", source].position
        sigma = np.stack([np.zeros_like(position) if p is None else p.value for p in stresses])
        seen = problem.seen_from(line.body)
        z = line.points(position)[2]
        # on an interface the upper side counts, as in the solutions
        layers = np.searchsorted(seen.interfaces, z) if line.layer is None else np.full(z.shape, line.layer)
        for k in np.unique(layers).tolist():
            E, nu = (*seen.coatings, seen.substrate)[k][:2]
            strain = float(largest_strain(sigma[:, layers == k], E, nu).max())
            found[line.body, k] = max(found.get((line.body, k), 0.0), strain)
    for (body, k), strain in sorted(found.items()):
        count = len(problem.seen_from(body).coatings)
        layer = "substrate" if k == count else f"coating {k + 1}"
        yield from strain_warning(layer if body == FLAT else f"{body}, {layer}", strain)


def decide(
    claim: Claim,
    profiles: Mapping[tuple[str, str, str], Profile],
    outcomes: Mapping[str, SourceResult],
    problem: CoatedContact,
) -> Verdict:
    """The verdict of ``claim``; ``profiles`` by (quantity, line, source)."""
    sides = []
    for source in claim.between:
        outcome = outcomes.get(source)
        if outcome is None or outcome.failure is not None:
            reason = "was not solved" if outcome is None else outcome.failure
            return Verdict(Outcome.NO_RESULT, f"{source}: {reason}")
        side = profiles.get((claim.quantity, claim.line, source))
        if side is None:
            return Verdict(Outcome.NO_RESULT, f"{source} gives no {claim.quantity} on {claim.line}")
        sides.append(side)
    a, b = sides
    scales = ("peak_pressure", "contact_radius", "approach")
    p0, edge, delta = (_of_best(name, profiles, outcomes) for name in scales)
    divisor = QUANTITIES[claim.quantity].divisor
    scale = divisor(float(b.value[0]), problem.p_h, p0, edge, problem.delta_h, delta)
    excluded = np.abs(np.abs(a.position) - edge) < claim.edge * edge
    return judge(compare(a, b, scale=scale, excluded=excluded), claim.cap)


def _of_best(
    quantity: str, profiles: Mapping[tuple[str, str, str], Profile], outcomes: Mapping[str, SourceResult]
) -> float:
    """A scalar of the contact [SI] by the last source that has one, an exact reference where there is any."""
    found = [profiles.get((quantity, "contact", source)) for source in outcomes]
    return next((float(profile.value[0]) for profile in reversed(found) if profile is not None), 0.0)
