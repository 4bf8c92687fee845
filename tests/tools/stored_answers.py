"""Answers of the manual that take minutes to solve: a designer's questions, the limit of line contact."""

from verification.commands.common.terminal import print_out
from verification.manual.line_limit import solved_limit
from verification.manual.tour_output import STORED, answered, commands


def answers(*numbers: int) -> int:
    """Solve a designer's questions of the manual and store what their commands print and draw.

    Parameters
    ----------
    numbers
        Of the questions; all of them unless given, and the table of the limit of line contact.
    """
    asked = commands("examples")
    for number in numbers or range(1, len(asked) + 1):
        text, picture = answered(asked[number - 1])
        (STORED / f"question_{number}.txt").write_text(text, encoding="utf-8")
        (STORED / f"question_{number}.svg").write_bytes(picture)
        print_out(f"question {number}")
    if not numbers:
        (STORED / "line_limit.txt").write_text(solved_limit(), encoding="utf-8")
    return 0
