"""A case of two closed forms, solved in a moment, for tests of what stands around the solving."""

import contextlib
import io
import subprocess
import sys
from pathlib import Path
from unittest import mock

import pytest
from case_texts import case_text

from verification.cli import main
from verification.commands.common import task_progress
from verification.running.checked_files import read_checked

QUICK = case_text(
    title="Quick",
    tables="""[[claim]]
quantity = "peak_pressure"
line = "contact"
between = ["integral_equation", "hertz"]
cap = 1e-6
why = "two references, no method"
""",
)
COMMAND = [sys.executable, "-m", "verification.cli"]


def solved_here(
    tasks, *, started=lambda name: None, finished=lambda name, result: None, meanwhile=lambda: None, **_
):
    """As ``run_tasks``, but in this process: for tests of what stands around the solving."""
    meanwhile()
    results = []
    for task in tasks:
        started(task.name)
        task.work()
        results.append(task.read(read_checked(task.path)))
        finished(task.name, results[-1])
    return results


def coatcheck(*words: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """Exit code, output and messages of the command line, all in this process in the folder ``cwd``."""
    out, err = io.StringIO(), io.StringIO()
    with (
        contextlib.chdir(cwd),
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
        mock.patch.object(sys, "argv", ["coatcheck", *words]),
        mock.patch.object(task_progress, "run_tasks", solved_here),
        pytest.raises(SystemExit) as ended,
    ):
        main()
    return subprocess.CompletedProcess(words, int(ended.value.code or 0), out.getvalue(), err.getvalue())


def coatcheck_process(*words: str, cwd: Path, **keywords) -> subprocess.CompletedProcess[str]:
    """The same in a process of its own, which starts others to solve."""
    return subprocess.run(
        [*COMMAND, *words], cwd=cwd, capture_output=True, text=True, timeout=300, check=False, **keywords
    )
