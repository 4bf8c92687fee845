"""A process of its own for one planted fault: its trial into a checked file.

python -m verification.credibility.faults.worker FAULT CLEAN_FOLDER TRIAL.json
"""

import sys
import time
from dataclasses import asdict, replace
from pathlib import Path

from verification.credibility.faults.catalogue import BLANKS, FAULTS
from verification.credibility.faults.trial import trial_to_json, try_fault
from verification.running.provenance import fingerprint
from verification.running.records import plain
from verification.running.store import write_checked


def main(name: str, clean: str, path: str) -> None:
    """Try the fault named ``name`` against the clean run in ``clean`` and store its trial at ``path``."""
    made_by = fingerprint()  # before anything is planted
    fault = (FAULTS | BLANKS)[name]
    trial = try_fault(fault, Path(clean))
    trial = replace(trial, seconds=time.process_time())  # with the loading of every module
    write_checked(
        Path(path), {"made_by": made_by, "fault": plain(asdict(fault)), "trial": trial_to_json(trial)}
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
