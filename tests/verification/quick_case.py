"""A case of two closed forms, solved in a moment, for tests of what stands around the solving."""

import subprocess
import sys
from pathlib import Path

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


def coatcheck(*words: str, cwd: Path, **keywords) -> subprocess.CompletedProcess[str]:
    """What the command line does in a process of its own, in the folder ``cwd``."""
    return subprocess.run(
        [*COMMAND, *words], cwd=cwd, capture_output=True, text=True, timeout=300, check=False, **keywords
    )
