"""Tasks of the pool: a case solved, judged, stored in checked files.

Cases of one process share the normal contact where they differ in friction alone.
"""

from dataclasses import replace
from functools import cache
from importlib import import_module
from pathlib import Path

from verification.cases.contact import parse_case
from verification.cases.published import read_published
from verification.running import published as published_run
from verification.running.contact import judge_case, solve_case
from verification.running.fields import write_fields, write_plane
from verification.running.provenance import fingerprint
from verification.running.result import to_json
from verification.running.store import write_checked
from verification.sampling.plane import plane_invariants, sample_plane
from verification.sources.methods import sharing_pressure
from verification.sources.record import Solver
from verification.sources.registry import METHODS, SOURCES, solvers

for _method in METHODS:  # once for all cases, see ``guard``
    import_module(SOURCES[_method].package)


def contact(name: str, text: str, path: str, plane: str, directory: str | None = None) -> None:
    """Solve the case file ``text``; store the stresses drawn of it at ``plane``, its result at ``path``.

    directory : of the run, where the fields are written too.
    """
    case = parse_case(text.encode(), Path(f"{name}.toml"))
    solved = solve_case(case, _solvers())
    result = judge_case(case, solved)
    drawn = sample_plane(case.problem.interfaces, solved.solutions)
    checked = plane_invariants(drawn, solved.solutions, case.problem)
    result = replace(result, invariants=(*result.invariants, *checked))
    # The result comes last: where it lies, all that belongs to it does.
    write_plane(Path(plane), drawn, case.text)
    if directory is not None:
        write_fields(case, solved.solutions, Path(directory))
    write_checked(Path(path), to_json(result) | {"made_by": fingerprint()})


def published(file: str, path: str) -> None:
    """Solve the published case of ``file`` and store its result at ``path``."""
    case = read_published(Path(file))
    result = published_run.with_digits(case, published_run.run(case))
    write_checked(Path(path), to_json(result) | {"made_by": fingerprint()})


@cache
def _solvers() -> dict[str, Solver]:
    return {name: sharing_pressure(solve) for name, solve in solvers().items()}
