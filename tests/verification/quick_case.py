"""A case of two closed forms, solved in a moment, for tests of what stands around the solving."""

import contextlib
import io
import subprocess
import sys
from functools import cache
from pathlib import Path
from unittest import mock

import pytest

from verification.cli import main
from verification.commands import run
from verification.report import material

QUICK = """
title = "Quick"
[problem]
radius = 10e-3
load = 20
substrate = { E = 210e9, nu = 0.3 }
[[claim]]
quantity = "peak_pressure"
line = "contact"
between = ["integral_equation", "hertz"]
cap = 1e-6
why = "two references, no method"
"""
COMMAND = [sys.executable, "-m", "verification.cli"]


# What a run says of the program itself has tests of its own: measured once for all runs of a process.
_ONCE = [
    mock.patch.object(module, name, cache(getattr(module, name)))
    for module, name in ((material, "design_orders"), (material, "parts"), (run, "self_tests"))
]


def coatcheck(*words: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """Exit code, output and messages of the command line, run in this process in the folder ``cwd``."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.ExitStack() as around:
        for patch in (*_ONCE, mock.patch.object(sys, "argv", ["coatcheck", *words])):
            around.enter_context(patch)
        around.enter_context(contextlib.chdir(cwd))
        around.enter_context(contextlib.redirect_stdout(out))
        around.enter_context(contextlib.redirect_stderr(err))
        with pytest.raises(SystemExit) as ended:
            main()
    return subprocess.CompletedProcess(words, int(ended.value.code or 0), out.getvalue(), err.getvalue())


def coatcheck_process(*words: str, cwd: Path, **keywords) -> subprocess.CompletedProcess[str]:
    """The same in a process of its own."""
    return subprocess.run(
        [*COMMAND, *words], cwd=cwd, capture_output=True, text=True, timeout=300, check=False, **keywords
    )
