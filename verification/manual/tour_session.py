"""The commands that a designer gives one after another, what they printed and took, from their record."""

import json
import textwrap
from pathlib import Path
from typing import Any

from verification.manual.markdown_text import table

RECORD = Path(__file__).parent / "source" / "_static" / "tour_session.json"
PROBLEM = (
    'solve --ball "10 mm, 210 GPa, 0.3" --load "20 N" --friction 0.15 --coating "DLC 2 um, 230 GPa, 0.22" '
    '--coating "Cr 0.2 um, 279 GPa, 0.21" --substrate "100Cr6 210 GPa, 0.3"'
)
# With whether the page shows what it printed.
COMMANDS = {
    PROBLEM: False,
    f"{PROBLEM} --check": True,
    f"{PROBLEM} --plot stresses.png": False,
    "study init thickness": False,
    "study thickness my_thickness.toml": True,
    "study init load": False,
    "study init stiffness": False,
}


def read_session() -> dict[str, Any]:
    """``when``, ``commit``, ``machine``, then ``commands``: ``words``, processor ``seconds``, ``printed``."""
    session: dict[str, Any] = json.loads(RECORD.read_text(encoding="utf-8"))
    return session


def tour_session() -> str:
    """Processor times of all commands, then what those printed that ``COMMANDS`` names."""
    record = read_session()
    rows = [
        [f"`coatcheck {one['words'].replace(PROBLEM, 'solve …')}`", f"{one['seconds']:.1f} s"]
        for one in record["commands"]
    ]
    made = f"Recorded {record['when']}, commit {record['commit']}, on {record['machine']}."
    parts = [table(["command", "processor time"], rows, 1), made]
    for one in record["commands"]:
        if COMMANDS[one["words"]]:
            words = textwrap.wrap(f"$ coatcheck {one['words']}", 86, subsequent_indent="    ")
            parts.append("\n".join(["```text", *(" \\\n".join(words)).splitlines(), one["printed"], "```"]))
    return "\n\n".join(parts)
