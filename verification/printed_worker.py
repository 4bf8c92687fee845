"""A process of its own for one published case: its result into a checked file.

python -m verification.printed_worker CASE.toml RESULT.json
"""

import sys
from pathlib import Path

from verification.printed import read_published
from verification.printed_run import run
from verification.result import to_json
from verification.store import write_checked
from verification.surroundings import fingerprint


def main(case: str, path: str) -> None:
    """Solve the published case of the file ``case`` and store its result at ``path``."""
    write_checked(Path(path), to_json(run(read_published(Path(case)))) | {"made_by": fingerprint()})


if __name__ == "__main__":
    main(*sys.argv[1:])
