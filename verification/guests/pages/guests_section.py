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
    "displacement": "displacement",
    "stress": "stresses",
}


def examined() -> list[dict[str, Any]]:
    """The examinations on record, as of ``verification.guests.pages.guest_page.summary``."""
    return json.loads(RECORD.read_text(encoding="utf-8"))


def section() -> Section:
    """The largest differences, time and memory of each code; the same for every run."""
    text = (
        "Answers of other contact codes to coatcheck guest run, through the adapters in "
        "verification/guests/examples. What a code does not support is not counted. Settings were chosen "
        "with the results in view: this is no blind test. python tests/tools guests records them."
    )
    return Section("guests", "Other codes", [Part(text, [differences()])])


def differences() -> Table:
    """A row for each code: how near it came, in what time."""
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
    caption = "Largest difference from the exact solution; longest time of the finest level, machine busy."
    heads = ["code", "agree", "problems", "levels", *COLUMNS.values(), "time", "memory"]
    return Table(caption, heads, rows)


def refinement() -> Table:
    """A row for each quantity of each code: its largest error at each level."""
    rows = [
        row(one["guest"], words(one["levels"]), COLUMNS[name], *(number(e) for e in errors[-3:]))
        for one in examined()
        for name, errors in one.get("errors", {}).items()
        if name in COLUMNS
    ]
    caption = "Largest error over the case's largest value of its kind, at the last three levels."
    return Table(caption, ["code", "levels", "quantity", "coarse", "middle", "fine"], rows)


def notes() -> Table:
    """A row for each fact about a code that its adapter had to find out."""
    rows = [row(one["guest"], words(note)) for one in examined() for note in one.get("notes", ())]
    return Table("Axis, sign, weight, side, default: found by trying.", ["code", "what to know"], rows)
