"""PDF of a page through an installed Chromium."""

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from verification.running.store import StoreError, write_atomically

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
FLAGS = (
    "--headless",
    "--disable-gpu",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-pdf-header-footer",
)


class NoBrowser(Exception):
    """No browser is installed, or it fails to print."""


def browser() -> str | None:
    """Path of an installed Chromium or Chrome; None where there is none."""
    return next((path for path in map(shutil.which, BROWSERS) if path), None)


def printed(page: Path, path: Path, time_limit: float) -> Path:
    """Print ``page`` to ``path``, whole or not at all; returns it.

    time_limit : [s].   Raises NoBrowser, and StoreError where the file cannot be written.
    """
    found = browser()
    if found is None:
        raise NoBrowser(
            "--pdf needs Chromium or Chrome, and none is installed as chromium, chromium-browser or "
            f"google-chrome; {page} is written, and any browser prints it"
        )
    # As root Chromium runs only without its sandbox; the page is our own and loads nothing.
    sandbox = ("--no-sandbox",) if hasattr(os, "geteuid") and os.geteuid() == 0 else ()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        made = Path(folder) / "report.pdf"
        words = [found, *FLAGS, *sandbox, f"--user-data-dir={folder}/profile", f"--print-to-pdf={made}"]
        try:
            done = subprocess.run(
                [*words, page.resolve().as_uri()], capture_output=True, timeout=time_limit, check=False
            )
        except subprocess.TimeoutExpired:
            raise NoBrowser(
                f"{found} did not print {page} within {time_limit:g} s; raise --time-limit"
            ) from None
        except OSError as error:
            raise NoBrowser(f"{found} could not be started ({error.strerror or error})") from None
        if done.returncode != 0 or not made.exists():
            raise NoBrowser(f"{found} ended with code {done.returncode} and printed nothing of {page}")
        try:
            data = made.read_bytes()
        except OSError as error:
            raise StoreError(f"{made}: cannot be read ({error.strerror})") from None
        write_atomically(path, data)
    return path
