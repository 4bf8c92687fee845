"""Make the open digits anew: every problem solved exactly, samples checked by both methods."""

from pathlib import Path

from rich.markup import escape

from open_digits_made.content import packed
from open_digits_made.making import make
from verification.commands.common.exit_codes import with_exit_code
from verification.commands.common.terminal import print_out
from verification.guests.vectors import open_digits
from verification.running.checked_files import write_atomically


@with_exit_code
def vectors(folder: Path = Path("vectors"), /, *, semianalytic: int = 250, elements: int = 60) -> int:
    """Solve every problem of the open digits and write the data set, which takes minutes.

    Args:
        folder: Directory to write to; each problem is kept in its folder work, so that a run can go on.
        semianalytic: How many problems the semi-analytical method checks.
        elements: How many problems the finite elements check.
    """
    samples = {"semianalytic": semianalytic, "fem_reference": elements}
    found = make(folder / "work", samples, lambda line: print_out(escape(line)))
    write_atomically(folder / open_digits.FILE.name, packed(found))
    return 0
