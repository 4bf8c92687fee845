"""The command line of coatcheck."""

import re
import sys
from collections.abc import Sequence
from typing import Literal, NamedTuple

from cyclopts import App, CycloptsError

from verification.commands.common.exits import BAD_INPUT, STOPPED
from verification.commands.common.terminal import print_error

CODES = (
    "Exit codes: 0 all agree, 1 disagreement, 2 bad input, 3 no result, 4 inconclusive, 5 all agree but a "
    "number is not that of the baseline, 130 stopped by Ctrl-C."
)


class Command(NamedTuple):
    """A command: ``place`` is its module:function, as text, so that only one is loaded.

    That of a command "x" is x:x unless given.
    """

    name: str
    summary: str
    examples: tuple[str, ...]
    place: str = ""


COMMANDS = (
    Command(
        "run",
        "Solve cases by every method and reference, judge every claim, write the report.",
        (
            "coatcheck run",
            "coatcheck run 05_ratio_4 my_coating.toml --output reports/mine --fields",
            "coatcheck run published",
            "coatcheck run --resume -v",
        ),
    ),
    Command(
        "list",
        "List the shipped cases and published results with their sources.",
        ("coatcheck list", "coatcheck list --json"),
        "list_cases:list_cases",
    ),
    Command(
        "report",
        "Write the report of a stored run again, nothing solved; print it with --pdf.",
        ("coatcheck report", "coatcheck report reports/mine --pdf"),
    ),
    Command(
        "view",
        "Look at the fields of a case, in a window or as a picture.",
        (
            "coatcheck run 05_ratio_4 --fields",
            "coatcheck view 05_ratio_4",
            "coatcheck view 05_ratio_4 --quantity sigma_xx --screenshot sigma_xx.png",
        ),
    ),
    Command(
        "compare",
        "Show two runs side by side: verdicts, numbers, versions, times.",
        ("coatcheck compare reports reports/mine --output compared.html",),
    ),
    Command(
        "faults",
        "Plant one mistake at a time; report which checks of the default run catch it.",
        ("coatcheck faults", "coatcheck faults --group stress", "coatcheck faults --list"),
    ),
    Command(
        "alarms",
        "Solve clean random problems; count the verdicts that are not AGREES.",
        ("coatcheck alarms", "coatcheck alarms --count 5 --seed 7"),
    ),
    Command(
        "bench",
        "Time the semi-analytical contact beside its peers; ratios first.",
        ("coatcheck bench", "coatcheck bench --sizes 128 256 --threads 1"),
    ),
)
STUDY = (
    Command(
        "thickness",
        "Which thickness? Stresses of a coating against thickness, stiffness and friction, cross-checked.",
        (
            "coatcheck study thickness",
            "coatcheck study thickness dlc_on_steel --output reports/dlc",
            "coatcheck study thickness my_coating.toml --scheduler tcp://host:8786",
            "coatcheck study thickness --no-cross-check --limit 30",
        ),
        "study:thickness",
    ),
)
BASELINE = (
    Command(
        "update",
        "Make a stored default run the baseline, with the reason why.",
        ('coatcheck baseline update --why "finer default grid"',),
        "baseline:update",
    ),
    Command(
        "show",
        "Show what the baseline holds and every update it has seen.",
        ("coatcheck baseline show",),
        "baseline:show",
    ),
)


def _epilogue(examples: Sequence[str]) -> str:
    """The text below the options of a command: examples, exit codes."""
    return "Examples:\n\n" + "\n".join(f"    {example}" for example in examples) + f"\n\n{CODES}"


def _version() -> str:
    from importlib.metadata import version

    return version("coatcheck")


app = App(
    name="coatcheck",
    help="Verify coated point contact: two independent methods, Hertz and an exact reference in one report.",
    help_epilogue=_epilogue(["coatcheck run", "coatcheck run --help"]),
    version=_version,
    help_format="plaintext",
)
baseline = App(
    name="baseline",
    help="The stored numbers that every run is compared with.",
    help_epilogue=_epilogue([example for entry in BASELINE for example in entry.examples]),
)
study = App(
    name="study",
    help="Sweep a parameter with both methods behind every number.",
    help_epilogue=_epilogue([example for entry in STUDY for example in entry.examples]),
)
for parent, entries in ((app, COMMANDS), (baseline, BASELINE), (study, STUDY)):
    for entry in entries:
        epilogue, place = (
            _epilogue(entry.examples),
            f"verification.commands.{entry.place or f'{entry.name}:{entry.name}'}",
        )
        parent.command(place, name=entry.name, help=entry.summary, help_epilogue=epilogue)
app.command(baseline)
app.command(study)


# The generated function alone does nothing: zsh has to call it where the file lies in a directory of $fpath,
# and to be told of it where the text is evaluated.
ZSH_END = """
if [[ ${zsh_eval_context[-1]} == loadautofunc ]]; then
  _cyclopts_coatcheck "$@"
else
  compdef _cyclopts_coatcheck coatcheck
fi
"""


def completion(shell: Literal["bash", "zsh", "fish"], /) -> int:
    """Print the script that completes coatcheck in a shell.

    Parameters
    ----------
    shell
        bash, zsh or fish.
    """
    script = app.generate_completion(prog_name="coatcheck", shell=shell)
    # A word that no command or option begins with may be a case file; fish tries files by itself.
    if shell == "bash":
        script = re.sub(r"^complete -F", "complete -o bashdefault -o default -F", script, flags=re.MULTILINE)
    elif shell == "zsh":
        script = re.sub(r"^( +'(?:\*|\d):[^':]+)'", r"\1:_files'", script, flags=re.MULTILINE) + ZSH_END
    sys.stdout.write(script)
    return 0


app.command(
    completion,
    help="Print the script that completes commands and options in a shell.",
    help_epilogue=_epilogue(
        [
            'eval "$(coatcheck completion bash)"',
            'eval "$(coatcheck completion zsh)"',
            "coatcheck completion fish > ~/.config/fish/completions/coatcheck.fish",
        ]
    ),
)


def main() -> None:
    """Entry of the ``coatcheck`` command."""
    try:
        code = app(sys.argv[1:], exit_on_error=False, print_error=False, result_action="return_value")
    except CycloptsError as error:
        print_error(" ".join(str(error).split()) + " Try: coatcheck --help")
        code = BAD_INPUT
    except KeyboardInterrupt:
        sys.stderr.write("\ncoatcheck: stopped; finished cases are kept, go on with --resume\n")
        code = STOPPED
    sys.exit(code)


if __name__ == "__main__":
    main()
