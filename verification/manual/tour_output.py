"""Output of coatcheck solve for the tour and for the worked examples, with the picture of the tour."""

import os
import re
import shlex
import subprocess
import sys
import tempfile
import textwrap
from collections.abc import Sequence
from functools import cache, partial
from pathlib import Path

SOURCE = Path(__file__).parent / "source"


def solved() -> str:
    """The text that the command of the tour prints, as a block of code."""
    return _run()[0]


def picture() -> bytes:
    """The picture that the command of the tour draws, as SVG."""
    return _run()[1]


@cache
def _run() -> tuple[str, bytes]:
    page = (SOURCE / "tour.md").read_text(encoding="utf-8")
    page = re.sub(r" \\\n +", " ", page)  # each command on one line
    found = re.search(r"^coatcheck (solve --ball .+)$", page, re.MULTILINE)
    assert found, "the tour has no line that begins with coatcheck solve --ball"
    words = [word.replace(".png", ".svg") for word in shlex.split(found[1])]
    with tempfile.TemporaryDirectory() as work:
        return transcript(words, Path(work)), (Path(work) / "stresses.svg").read_bytes()


def transcript(words: Sequence[str], work: Path, *before: str) -> str:
    """Output of ``coatcheck`` with these ``words`` in the folder ``work``, warnings first, as a block.

    before : lines above it.
    """
    done = subprocess.run(
        [sys.executable, "-m", "verification.cli", *words],
        cwd=work,
        env=variables(),
        capture_output=True,
        text=True,
        check=True,
    )
    lines = shown_lines(done.stderr, done.stdout)
    return "\n".join(["```text", *before, *lines, "```"])


def variables() -> dict[str, str]:
    """The environment of a command whose output a page shows."""
    path = os.pathsep.join([str(SOURCE.parents[2]), *filter(None, sys.path)])
    return {**os.environ, "PYTHONPATH": path, "COLUMNS": "100", "NO_COLOR": "1"}


def shown_lines(warned: str, printed: str) -> list[str]:
    """Lines of what a command printed, warnings first, wrapped for a page."""
    # Times by the clock of a busy machine tell nothing.
    printed = re.sub(r"^time: .*\n?", "", printed.strip(), flags=re.MULTILINE)
    printed = re.sub(r"( points) in [\d.]+ s:", r"\1:", printed)
    lines = [line.rstrip() for line in (*warned.splitlines(), *printed.splitlines())]
    return [textwrap.fill(line, 88) if len(line) > 88 else line for line in lines]


def worked(number: int) -> str:
    """Output for the file of this number, from 1."""
    page = (SOURCE / "examples.md").read_text(encoding="utf-8")
    files = re.findall(r"^```toml\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    with tempfile.TemporaryDirectory() as work:
        (Path(work) / "example.toml").write_text(files[number - 1], encoding="utf-8")
        return transcript(["solve", "example.toml"], Path(work), "$ coatcheck solve example.toml")


WORKED = {f"worked_{number}": partial(worked, number) for number in (1, 2, 3)}
