"""What coatcheck solve prints for the files of the page of worked examples."""

import re
import subprocess
import sys
import tempfile
import textwrap
from pathlib import Path

from verification.manual.tour import environment

PAGE = Path(__file__).parent / "source" / "examples.md"


def worked_1() -> str:
    """Output for the first file."""
    return _printed(0)


def worked_2() -> str:
    """Output for the second file."""
    return _printed(1)


def worked_3() -> str:
    """Output for the third file."""
    return _printed(2)


def _printed(number: int) -> str:
    files = re.findall(r"^```toml\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    with tempfile.TemporaryDirectory() as work:
        (Path(work) / "example.toml").write_text(files[number], encoding="utf-8")
        done = subprocess.run(
            [sys.executable, "-m", "verification.cli", "solve", "example.toml"],
            cwd=work,
            env={**environment(), "COLUMNS": "100", "NO_COLOR": "1"},
            capture_output=True,
            text=True,
            check=True,
        )
    # The time of one solve on a busy machine tells nothing.
    printed = re.sub(r"; semi-analytical \S+ s$", "", done.stdout.strip(), flags=re.MULTILINE)
    lines = [line.rstrip() for line in (*done.stderr.splitlines(), *printed.splitlines())]
    wrapped = [textwrap.fill(line, 88) if len(line) > 88 else line for line in lines]
    return "```text\n$ coatcheck solve example.toml\n" + "\n".join(wrapped) + "\n```"
