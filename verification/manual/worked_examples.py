"""What coatcheck solve prints for the files of the page of worked examples."""

import re
import tempfile
from functools import partial
from pathlib import Path

from verification.manual.tour_output import transcript

PAGE = Path(__file__).parent / "source" / "examples.md"


def worked(number: int) -> str:
    """Output for the file of this number, from 1."""
    files = re.findall(r"^```toml\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    with tempfile.TemporaryDirectory() as work:
        (Path(work) / "example.toml").write_text(files[number - 1], encoding="utf-8")
        return transcript(["solve", "example.toml"], Path(work), "$ coatcheck solve example.toml")


WORKED = {f"worked_{number}": partial(worked, number) for number in (1, 2, 3)}
