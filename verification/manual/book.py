"""The manual as one PDF, through an installed Chromium."""

import tempfile
from pathlib import Path

from verification.manual.build import build
from verification.report.pdf import printed


def print_manual(path: Path, time_limit: float) -> Path:
    """Print the whole manual to ``path``; returns it.

    time_limit : [s] of each printing.   Raises ManualError, NoBrowser, StoreError.
    """
    with tempfile.TemporaryDirectory() as work:
        page = build(Path(work) / "one", "singlehtml")
        return printed(page, path, time_limit)
