"""coatcheck vectors: exact values of many problems, for everybody."""

from pathlib import Path

from rich.markup import escape

from verification.commands.common.exit_codes import with_exit_code
from verification.commands.common.shared_options import AsJson, Output
from verification.commands.common.terminal import print_json, print_out
from verification.running.checked_files import write_atomically


@with_exit_code
def vectors(
    *,
    output: Output = Path("vectors"),
    as_json: AsJson = False,
) -> int:
    """Write the open digits: exact values of 500 problems as JSON with a schema and as CSV, licence CC0.

    Args:
        output: Directory to write to.
    """
    from verification.guests.vectors import open_digits

    found = open_digits.shipped()
    for name, text in open_digits.texts(found).items():
        write_atomically(output / name, text)
    wide = sorted(open_digits.uncertain(found))
    summary = {
        "folder": str(output),
        "problems": len(found["problems"]),
        "values": open_digits.value_count(found),
        "ten_digits": sum(U <= 1e-10 for U in wide) / len(wide),
        "largest_uncertainty": wide[-1],
        "checked": found["checked"],
    }
    if as_json:
        print_json(summary)
        return 0
    most = f"{summary['largest_uncertainty']:.1e}"
    print_out(
        f"{summary['problems']} problems, {summary['values']} values in {escape(str(output))}; "
        f"uncertainty at most 1e-10 of the scale for {summary['ten_digits']:.1%}, {most} at most"
    )
    for one in found["checked"]:
        counts = f"{one['within']} of {one['values']} values of {one['problems']} problems"
        most = one["largest_share_of_U"]
        print_out(
            f"{one['method']}: {counts} within the uncertainties of both, the largest at {most:.2f} of them"
        )
    return 0
