"""A process of its own for one published case: its result into a checked file.

python -m verification.running.published_worker CASE.toml RESULT.json
"""

import sys
from pathlib import Path

from verification.cases.published import read_published
from verification.running.provenance import fingerprint
from verification.running.published import run
from verification.running.result import to_json
from verification.running.store import write_checked


def main(case: str, path: str) -> None:
    """Solve the published case of the file ``case`` and store its result at ``path``."""
    write_checked(Path(path), to_json(run(read_published(Path(case)))) | {"made_by": fingerprint()})


if __name__ == "__main__":
    main(*sys.argv[1:])
