"""A process of its own for one case: the case file on standard input, its results into checked files.

python -m verification.running.worker NAME RESULT.json PLANE.json [DIRECTORY] < case.toml
"""

import sys
from pathlib import Path

from verification.cases.contact import parse_case
from verification.running.contact import judge_case, solve_case
from verification.running.fields import write_fields
from verification.running.planes import write_plane
from verification.running.provenance import fingerprint
from verification.running.result import to_json
from verification.running.store import write_checked
from verification.sampling.plane import sample_plane


def main(name: str, path: str, plane: str, directory: str | None = None) -> None:
    """Solve the case named ``name``; store what is drawn of it at ``plane``, its result at ``path``.

    directory : of the run, where the fields are written too.
    """
    case = parse_case(sys.stdin.buffer.read(), Path(f"{name}.toml"))
    solved = solve_case(case)
    result = judge_case(case, solved)
    # The result comes last: where it lies, all that belongs to it does.
    write_plane(Path(plane), sample_plane(case.problem.interfaces, solved.solutions), case.text)
    if directory is not None:
        write_fields(case, solved.solutions, Path(directory))
    write_checked(Path(path), to_json(result) | {"made_by": fingerprint()})


if __name__ == "__main__":
    main(*sys.argv[1:])
