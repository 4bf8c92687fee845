"""The command line of coatcheck.

Exit codes: 0 all agree, 1 a disagreement, 2 bad input, 3 a missing result, 4 inconclusive, 5 all agree but
a number is not that of the baseline.
"""

import sys
from importlib.metadata import version

from cyclopts import App, CycloptsError

from verification.commands.common import complain

__all__ = ["app", "main"]

app = App(
    name="coatcheck",
    help="Verify coated point contact: two independent methods, Hertz and an exact reference in one report.",
    help_epilogue="Exit codes: 0 all agree, 1 disagreement, 2 bad input, 3 no result, 4 inconclusive, 5 all "
    "agree but a number is not that of the baseline.",
    version=lambda: version("coatcheck"),
    help_format="plaintext",
)
# Named as text, so that a command loads only what it needs.
for name, place, said in (
    ("run", "run:run", "Solve cases by every method and reference, judge every claim, write the report."),
    ("list", "list_cases:list_cases", "List the shipped cases and published results with their sources."),
    (
        "report",
        "report:report",
        "Write the report of a stored run again, nothing solved; print it with --pdf.",
    ),
    ("view", "view:view", "Look at the fields of a case, in a window or as a picture."),
    ("study", "study:study", "Sweep a parameter with both methods behind every number."),
    ("bench", "bench:bench", "Time the semi-analytical contact beside its peers; ratios first."),
    ("compare", "compare:compare", "Show two runs side by side: verdicts, numbers, versions, times."),
    (
        "faults",
        "faults:faults",
        "Plant one mistake at a time; report which checks of the default run catch it.",
    ),
    ("alarms", "alarms:alarms", "Solve clean random problems; count the verdicts that are not AGREES."),
):
    app.command(f"verification.commands.{place}", name=name, help=said)

baseline = App(name="baseline", help="The stored numbers that every run is held against.")
for name, said in (
    ("update", "Make a stored default run the baseline, with the reason why."),
    ("show", "Show what the baseline holds and every update it has seen."),
):
    baseline.command(f"verification.commands.baseline:{name}", name=name, help=said)
app.command(baseline)


def main() -> None:
    """Entry of the ``coatcheck`` command."""
    try:
        code = app(exit_on_error=False, print_error=False, result_action="return_value")
    except CycloptsError as error:
        code = complain(" ".join(str(error).split()) + " Try: coatcheck --help")
    except KeyboardInterrupt:
        sys.stderr.write("\ncoatcheck: stopped; finished cases are kept, go on with --resume\n")
        code = 130
    sys.exit(code)


if __name__ == "__main__":
    main()
