"""What the command of the tour prints, with the picture that it draws."""

import os
import re
import shlex
import subprocess
import sys
import tempfile
import textwrap
from functools import cache
from pathlib import Path

PAGE = Path(__file__).parent / "source" / "tour.md"


def solved() -> str:
    """The text that the command of the tour prints, as a block of code."""
    # The time of one solve on a busy machine tells nothing.
    lines = re.sub(r"; semi-analytical \S+ s$", "", _run()[0].strip(), flags=re.MULTILINE).splitlines()
    wrapped = [textwrap.fill(line, 88) if len(line) > 88 else line for line in lines]
    return "```text\n" + "\n".join(wrapped) + "\n```"


def picture() -> bytes:
    """The picture that the command of the tour draws, as SVG."""
    return _run()[1]


@cache
def _run() -> tuple[str, bytes]:
    found = re.search(r"^coatcheck (solve --ball .+)$", _page(), re.MULTILINE)
    assert found, "the tour has no line that begins with coatcheck solve --ball"
    words = [word.replace(".png", ".svg") for word in shlex.split(found[1])]
    with tempfile.TemporaryDirectory() as work:
        done = subprocess.run(
            [sys.executable, "-m", "verification.cli", *words],
            cwd=work,
            env={**environment(), "COLUMNS": "100", "NO_COLOR": "1"},
            capture_output=True,
            text=True,
            check=True,
        )
        return done.stdout, (Path(work) / "stresses.svg").read_bytes()


def _page() -> str:
    """The page, each command on one line."""
    return re.sub(r" \\\n +", " ", PAGE.read_text(encoding="utf-8"))


def environment() -> dict[str, str]:
    """The environment, in which the package of this process is found from any directory."""
    return {**os.environ, "PYTHONPATH": os.pathsep.join([str(PAGE.parents[3]), *filter(None, sys.path)])}
