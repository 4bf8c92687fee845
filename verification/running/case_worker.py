"""What a process of the pool does: solve a case, judge it, store the result in checked files.

Cases of one process share the normal contact where they differ in friction alone.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

from verification.cases.case_file import Case
from verification.cases.published_file import PublishedCase
from verification.running import published_run
from verification.running.case_result import to_json
from verification.running.checked_files import write_checked
from verification.running.contact_run import judge_case, solve_case
from verification.running.provenance import fingerprint
from verification.running.stored_fields import write_fields, write_plane
from verification.sampling.stress_plane import plane_invariants, sample_plane
from verification.sources.method_sources import sharing_pressure
from verification.sources.source_record import Solver
from verification.sources.source_registry import solvers


def solve_and_store(case: Case, path: Path, plane: Path, directory: Path | None = None) -> None:
    """Solve ``case``, store the stresses that the report draws at ``plane`` and the result at ``path``.

    directory : of the run, where the fields are written too.
    """
    solved = solve_case(case, _solvers())
    result = judge_case(case, solved)
    drawn = sample_plane(case.problem.interfaces, solved.solutions)
    checked = plane_invariants(drawn, solved.solutions, case.problem)
    result = replace(result, invariants=(*result.invariants, *checked))
    # The result comes last: where it lies, all that belongs to it does.
    write_plane(plane, drawn, case.text)
    if directory is not None:
        write_fields(case, solved.solutions, directory)
    write_checked(path, to_json(result) | {"made_by": fingerprint()})


def solve_and_store_published(case: PublishedCase, path: Path) -> None:
    """Solve a published ``case`` and store its result at ``path``."""
    result = published_run.with_digits(case, published_run.run(case))
    write_checked(path, to_json(result) | {"made_by": fingerprint()})


@cache
def _solvers() -> dict[str, Solver]:
    return {name: sharing_pressure(solve) for name, solve in solvers().items()}
