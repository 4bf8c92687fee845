"""A process of its own for one planted fault: its trial into a checked file.

python -m verification.faults.worker FAULT CLEAN_FOLDER TRIAL.json
"""

import sys
from pathlib import Path

from verification.faults.catalogue import BLANKS, FAULTS
from verification.faults.trial import to_json, try_fault
from verification.store import write_checked


def main(name: str, clean: str, path: str) -> None:
    """Try the fault named ``name`` against the clean run in ``clean`` and store its trial at ``path``."""
    trial = try_fault((FAULTS | BLANKS)[name], Path(clean))
    write_checked(Path(path), to_json(trial))


if __name__ == "__main__":
    main(*sys.argv[1:])
