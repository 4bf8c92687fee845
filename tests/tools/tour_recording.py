"""Record what the commands of the manual's tour print and take."""

import json
import os
import resource
import shlex
import subprocess
import sys
import tempfile
from datetime import UTC, datetime
from pathlib import Path

from verification.commands.common.terminal import print_out
from verification.manual.tour_output import shown_lines, variables
from verification.manual.tour_session import COMMANDS, RECORD
from verification.running.provenance import commit, hardware


def tour() -> int:
    """Give every command of the tour in an empty folder and store its record beside the manual."""
    found = []
    with tempfile.TemporaryDirectory() as work:
        for words in COMMANDS:
            begin = _processor_seconds()
            done = subprocess.run(
                [sys.executable, "-m", "verification.cli", *shlex.split(words)],
                cwd=work,
                env=variables() | {"OMP_NUM_THREADS": "1"},
                capture_output=True,
                text=True,
                check=True,
            )
            seconds = round(_processor_seconds() - begin, 1)
            printed = "\n".join(shown_lines(done.stderr, done.stdout)).replace(work, "")
            found.append({"words": words, "seconds": seconds, "printed": printed})
            print_out(f"{seconds:6.1f} s  coatcheck {words[-60:]}")
    when = datetime.now(UTC).date().isoformat()
    record = {"when": when, "commit": commit(), "machine": hardware(), "commands": found}
    Path(RECORD).write_text(json.dumps(record, indent=1, ensure_ascii=False) + os.linesep, encoding="utf-8")
    return 0


def _processor_seconds() -> float:
    """Of all processes that this one waited for."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
