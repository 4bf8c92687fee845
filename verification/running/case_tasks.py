"""Cases as tasks of the process pool: what a process does, and the results stored by an earlier run.

A process solves a case, judges it and stores the result in checked files. Cases of one process share the
normal contact where they differ in friction alone.
"""

import os
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

from verification.cases.case_file import Case
from verification.cases.published_file import PublishedCase
from verification.judging.verdict import Outcome
from verification.running import published_run
from verification.running.case_result import CaseResult
from verification.running.contact_run import judge_case, solve_case
from verification.running.pool.pool_task import Task
from verification.running.slicing import slicing_remarks
from verification.running.stored_fields import (
    confirm_fields,
    plane_path,
    read_plane,
    write_fields,
    write_plane,
)
from verification.running.stored_run import read_stored, result_of, write_result
from verification.sampling.stress_plane import plane_invariants, sample_plane
from verification.sources.method_sources import sharing_pressure
from verification.sources.source_record import Solver
from verification.sources.source_registry import METHODS, SOURCES, solvers

_METHOD_PACKAGES = tuple(SOURCES[method].package for method in METHODS)


def result_path(folder: Path, case: Case | PublishedCase) -> Path:
    """Path of the checked result of ``case`` in a run directory."""
    return folder / "cases" / f"{case.name}.json"


def case_task(case: Case | PublishedCase, folder: Path, *, fields: bool = False) -> Task[CaseResult]:
    """Solving ``case``, its result stored under ``folder``, and its ``fields`` where they are wanted.

    Contacts that differ in friction alone share a process, and so the solution without friction.
    """
    path, read = result_path(folder, case), partial(result_of, case)
    if not isinstance(case, Case):
        work, lost = (partial(solve_and_store_published, case, path), partial(published_run.failed, case))
        return Task(case.name, work, path, read, lost, cost=1.0, ahead=_METHOD_PACKAGES)
    work = partial(solve_and_store, case, path, plane_path(folder, case.name), folder if fields else None)
    alike = repr((replace(case.problem, friction=0.0), case.approach, sorted(case.numerics.items())))
    lost = partial(CaseResult.failed, case, warnings=case.warnings)
    return Task(case.name, work, path, read, lost, cost(case), alike, ahead=_METHOD_PACKAGES)


def cost(case: Case) -> float:
    """Estimated time over that of an uncoated contact at rest.

    Layers, the harmonic of sliding, further solves, the finer grid under a thin first coating.
    """
    problem = case.problem
    layers = 1 + 0.3 * len(problem.coatings)
    solves = 1 + bool(problem.friction) + 4 * case.resolve
    finest = [numerics["patches"] / 257 for numerics in case.numerics.values() if "patches" in numerics]
    thin = [0.1 * problem.a_h / thickness for _, _, thickness in problem.coatings[:1]]
    return layers * solves * min(max([1.0, *finest, *thin]), 2.0) ** 2


def solve_and_store(case: Case, path: Path, plane: Path, directory: Path | None = None) -> None:
    """Solve ``case``, store the stresses that the report draws at ``plane`` and the result at ``path``.

    directory : of the run, where the fields are written too.
    """
    solved = solve_case(case, _solvers())
    result = judge_case(case, solved)
    drawn = sample_plane(case.problem.interfaces, solved.solutions)
    checked = plane_invariants(drawn, solved.solutions, case.problem)
    remarks = (*case.remarks, *slicing_remarks(case, solved.solutions, _solvers()))
    result = replace(result, invariants=(*result.invariants, *checked), remarks=remarks)
    # The result comes last: where it lies, all that belongs to it does.
    write_plane(plane, drawn, case.text)
    if directory is not None:
        write_fields(case, solved.solutions, directory)
    write_result(path, result)


def solve_and_store_published(case: PublishedCase, path: Path) -> None:
    """Solve a published ``case`` and store its result at ``path``."""
    write_result(path, published_run.run(case))


@cache
def _solvers() -> dict[str, Solver]:
    return {name: sharing_pressure(solve) for name, solve in solvers().items()}


def kept_result(folder: Path, case: Case | PublishedCase, *, fields: bool = False) -> CaseResult | None:
    """The result of ``case`` in a run directory that need not be computed again; None where there is none.

    It is whole, of the same case file, made by the same code, and a result; so is what is drawn of it, and
    so are its ``fields`` where they are wanted.
    Raises StoreError, naming the file, where there is one that cannot be used.
    """
    path = result_path(folder, case)
    if not os.path.lexists(path):
        return None
    result = read_stored(path, case)
    if isinstance(case, Case):
        read_plane(plane_path(folder, case.name), case.text)
        if fields:
            confirm_fields(folder, case.name, case.text)
    return result if result.outcome is not Outcome.NO_RESULT else None
