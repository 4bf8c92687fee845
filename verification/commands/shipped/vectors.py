"""coatcheck vectors: exact values of many problems, for everybody."""

from pathlib import Path

from rich.markup import escape

from verification.commands.common.shared_options import AsJson, Output
from verification.commands.common.terminal import print_json, print_out, with_exit_code
from verification.running.checked_files import write_atomically


@with_exit_code
def vectors(*, output: Output = Path("vectors"), as_json: AsJson = False) -> int:
    """Write the open digits: exact values of 500 problems as JSON with a schema and as CSV, licence CC0.

    Args:
        output: Directory to write to.
    """
    from verification.guests.vectors import open_digits

    found = open_digits.shipped()
    texts = open_digits.texts(found)
    for name, text in texts.items():
        write_atomically(output / name, text)
    summary = {
        "folder": str(output),
        "problems": len(found["problems"]),
        "values": texts["values.csv"].count("\n") - 1,
        "checked": found["checked"],
    }
    if as_json:
        print_json(summary)
    else:
        print_out(f"{summary['problems']} problems, {summary['values']} values in {escape(str(output))}")
    return 0
