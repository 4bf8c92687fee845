"""Answers of coatcheck solve: that of the tour, solved anew, those of a designer's questions, as stored."""

import os
import re
import shlex
import subprocess
import sys
import tempfile
import textwrap
from collections.abc import Iterator, Sequence
from functools import cache, partial
from pathlib import Path

SOURCE = Path(__file__).parent / "source"
STORED = SOURCE / "stored"  # what takes minutes to solve: `python tests/tools answers` makes it anew


def commands(page: str) -> list[list[str]]:
    """The words of each command on a page that solves a problem and ends with its ``--plot``."""
    text = re.sub(r" \\\n +", " ", (SOURCE / f"{page}.md").read_text(encoding="utf-8"))
    found = re.findall(r"^coatcheck (solve .+ --plot \S+)$", text, re.MULTILINE)
    return [shlex.split(line) for line in found]


def pictures() -> Iterator[tuple[str, bytes]]:
    """Name and content of the picture that each of these commands draws, as SVG."""
    yield "tour.svg", _tour()[1]
    for number in range(1, len(commands("examples")) + 1):
        yield f"question_{number}.svg", (STORED / f"question_{number}.svg").read_bytes()


def solved() -> str:
    """The text that the command of the tour prints, as a block of code."""
    return _tour()[0]


def question(number: int) -> str:
    """Answer to a designer's question as its command prints it, without the table of every largest stress."""
    table = re.compile(r"^largest .*?(?=^tension positive)", re.MULTILINE | re.DOTALL)
    return table.sub("", (STORED / f"question_{number}.txt").read_text(encoding="utf-8"))


@cache
def _tour() -> tuple[str, bytes]:
    return answered(commands("tour")[0])


def answered(words: Sequence[str]) -> tuple[str, bytes]:
    """Text and picture of a command of these pages, solved now."""
    with tempfile.TemporaryDirectory() as work:
        text = transcript([*words[:-1], "drawn.svg"], Path(work))
        return text, (Path(work) / "drawn.svg").read_bytes()


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


QUESTIONS = {f"question_{number}": partial(question, number) for number in range(1, 12)}
