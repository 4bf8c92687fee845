"""A process of its own for one case: the case file on standard input, its result into a checked file.

python -m verification.worker NAME RESULT.json < case.toml
"""

import sys
from pathlib import Path

from verification.case import parse_case
from verification.result import to_json
from verification.run import run
from verification.store import write_checked
from verification.surroundings import fingerprint


def main(name: str, path: str) -> None:
    """Solve the case named ``name`` and store its result at ``path``."""
    case = parse_case(sys.stdin.buffer.read(), Path(f"{name}.toml"))
    write_checked(Path(path), to_json(run(case)) | {"made_by": fingerprint()})


if __name__ == "__main__":
    main(*sys.argv[1:])
