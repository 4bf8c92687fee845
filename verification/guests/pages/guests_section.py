"""Codes of others, examined as guests: how near each came to the exact solution."""

import json
from pathlib import Path
from typing import Any

import verification.guests
from verification.page.number_text import seconds
from verification.page.page_parts import Part, Section, Table, number, row, tally, words

RECORD = Path(verification.guests.__file__).parent / "shipped" / "guests.json"
# Kinds of a difference on record, with their headings.
COLUMNS = {
    "peak_pressure": "p0",
    "contact_radius": "a",
    "approach": "approach",
    "pressure": "p(r)",
    "displacement": "u_z under a square",
    "stress": "stresses",
}


def examined() -> list[dict[str, Any]]:
    """The examinations on record, as of ``verification.guests.pages.guest_page.summary``."""
    return json.loads(RECORD.read_text(encoding="utf-8"))


def section() -> Section:
    """The largest differences, time and memory of each code; the same for every run."""
    rows = []
    for one in examined():
        memory = one["memory"] and one["memory"] / 1e6
        rows.append(
            row(
                " ".join(filter(None, (one["guest"], one.get("version"), one.get("date")))),
                tally(one["agree"], one["answered"]),
                number(one["cases"], str),
                words(one["levels"]),
                *(number(one["differences"].get(name)) for name in COLUMNS),
                number(one["seconds"][1], seconds),
                number(memory, "{:.0f} MB".format),
            )
        )
    text = (
        "Answers of other contact codes to coatcheck guest run, through the adapters in "
        "verification/guests/examples. What a code does not support is not counted. Settings were chosen "
        "with the results in view: this is no blind test. python tests/tools guests records them."
    )
    caption = "Largest difference from the exact solution; longest time of the finest level, machine busy."
    heads = ["code", "agree", "problems", "levels", *COLUMNS.values(), "time", "memory"]
    return Section("guests", "Other codes", [Part(text, [Table(caption, heads, rows)])])
