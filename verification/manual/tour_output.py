"""Answers of coatcheck solve for the tour and for the questions of a designer: texts and pictures."""

import os
import re
import shlex
import subprocess
import sys
import tempfile
import textwrap
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from pathlib import Path

SOURCE = Path(__file__).parent / "source"


def commands(page: str) -> list[list[str]]:
    """The words of each command on a page that solves a problem and ends with its ``--plot``."""
    text = re.sub(r" \\\n +", " ", (SOURCE / f"{page}.md").read_text(encoding="utf-8"))
    found = re.findall(r"^coatcheck (solve .+ --plot \S+)$", text, re.MULTILINE)
    return [shlex.split(line) for line in found]


def pictures() -> Iterator[tuple[str, bytes]]:
    """Name and content of the picture that each of these commands draws, as SVG."""
    yield "tour.svg", _answers()["tour", 1][1]
    for number in range(1, len(commands("examples")) + 1):
        yield f"question_{number}.svg", _answers()["examples", number][1]


def solved() -> str:
    """The text that the command of the tour prints, as a block of code."""
    return _answers()["tour", 1][0]


def question(number: int) -> str:
    """Answer to a designer's question as its command prints it, without the table of every largest stress."""
    table = re.compile(r"^largest .*?(?=^tension positive)", re.MULTILINE | re.DOTALL)
    return table.sub("", _answers()["examples", number][0])


@cache
def _answers() -> dict[tuple[str, int], tuple[str, bytes]]:
    """Text and picture of every command of both pages, two solved at a time."""
    asked = {
        (page, number): words
        for page in ("tour", "examples")
        for number, words in enumerate(commands(page), start=1)
    }
    with ThreadPoolExecutor(2) as pool:
        return dict(zip(asked, pool.map(_answered, asked.values()), strict=True))


def _answered(words: Sequence[str]) -> tuple[str, bytes]:
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
