"""Checkout of another commit, that this one is measured over."""

import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from bench.turns import HERE
from verification.running.provenance import commit

__all__ = ["checkout"]


@contextmanager
def checkout(against: str) -> Iterator[tuple[str, Path]]:
    """Short name and folder of ``against``: a checkout as it is, or a commit of this repository.

    A commit is checked out into a temporary folder by a clone that shares this repository's objects: it
    leaves nothing behind in the repository, however the program ends.
    Raises ValueError where ``against`` is neither.
    """
    folder = Path(against)
    if (folder / "semianalytic").is_dir():
        found = commit(folder) or folder.resolve().name
        yield found[:7] + "+" * found.endswith("+"), folder.resolve()
        return
    whole = _git(HERE, "rev-parse", "--verify", "--end-of-options", f"{against}^{{commit}}")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as place:
        _git(HERE, "clone", "--quiet", "--shared", "--no-checkout", str(HERE), place)
        _git(Path(place), "checkout", "--quiet", whole)
        yield whole[:7], Path(place)


def _git(folder: Path, *words: str) -> str:
    try:
        done = subprocess.run(["git", "-C", str(folder), *words], capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        message = str(getattr(error, "stderr", "") or error).strip().splitlines()[-1]
        raise ValueError(f"neither a checkout nor a commit of this repository ({message})") from None
    return done.stdout.strip()
