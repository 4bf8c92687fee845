"""The command line of coatcheck."""

import gc
import re
import sys
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

from cyclopts import App, CycloptsError

from verification.commands.common.command_error import BAD_INPUT, STOPPED
from verification.commands.common.terminal import print_error
from verification.judging.outcome import Outcome
from verification.regression.run_exit_codes import EXIT

CODES = (
    "Exit codes: 0 all agree, 1 disagreement, 2 bad input, 3 no result, 4 inconclusive, 5 all agree but a "
    "number is not that of the baseline, 6 all agree but less is judged than the manifest records, 130 "
    "stopped by Ctrl-C."
)


# Read as data, so that the module of a command is imported only when it is called.
COMMANDS = tomllib.loads((Path(__file__).parent / "commands" / "commands.toml").read_text(encoding="utf-8"))


def _epilogue(examples: Sequence[str]) -> str:
    """The text below the options of a command: examples, exit codes."""
    return "Examples:\n\n" + "\n".join(f"    {example}" for example in examples) + f"\n\n{CODES}"


def _version() -> str:
    from importlib.metadata import version

    return version("coatcheck")


def _group(name: str, summary: str) -> App:
    """The commands whose names begin with ``name``."""
    examples = [
        line for key, entry in COMMANDS.items() if key.startswith(f"{name} ") for line in entry["examples"]
    ]
    return App(name=name, help=summary, help_epilogue=_epilogue([*dict.fromkeys(examples)]))


app = App(
    name="coatcheck",
    help="Verify coated point contact: two independent methods, Hertz and an exact reference in one report.",
    help_epilogue=_epilogue(["coatcheck run", "coatcheck run --help"]),
    version=_version,
    help_format="markdown",
)
groups = {
    "": app,
    "baseline": _group("baseline", "The stored numbers that every run is compared with."),
    "guest": _group("guest", "Examine a contact code of your own, in any language."),
    "study": _group("study", "Sweep a parameter with both methods behind every number."),
}
for key, entry in COMMANDS.items():
    group, _, name = key.rpartition(" ")
    place, epilogue = f"verification.commands.{entry['place']}", _epilogue(entry["examples"])
    groups[group].command(place, name=name, help=entry["summary"], help_epilogue=epilogue)
app.command(groups["baseline"])
app.command(groups["guest"])
app.command(groups["study"])


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

    Args:
        shell: bash, zsh or fish.
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


def _with_remedy(text: str, command: Sequence[str]) -> str:
    """The ``text`` of an error with advice in the words of a ``command``."""
    meant = COMMANDS[command[0]].get("meant", {}) if command and command[0] in COMMANDS else {}
    unknown = re.search(r"--?(\w+)", text)
    if text.startswith("Unknown option") and unknown and unknown[1] in meant:
        return f"{text.partition(' Did you mean')[0]} Try: {meant[unknown[1]]}"
    if "requires an argument" in text:
        option = re.search(r"--[\w-]+", text)
        return (
            f"{text} Give its value; one that begins with - needs an equals sign, "
            f"{option[0] if option else ''}=..."
        )
    if re.search(r"\d ?%", text):
        return f"{text} Write a share without %, such as 0.15."
    if re.search(r"\d,\d", text):
        return f"{text} Write decimals with a point, such as 0.15."
    return f"{text} Try: coatcheck {' '.join([*(one for one in command if one in COMMANDS), '--help'])}"


# Packages that the base installation lacks, by the name that Python imports, with the extra that brings them.
EXTRAS = {
    "skfem": "fem",
    "gmsh": "fem",
    "meshio": "fields",
    "pyvista": "fields",
    "matplotlib": "report",
    "pyarrow": "report",
    "SurfaceTopography": "surfaces",
}


def _missing_extra(error: BaseException | None) -> str | None:
    """The package of an extra whose absence caused an ``error``; None if it had another cause."""
    while error is not None:
        if isinstance(error, ModuleNotFoundError) and (error.name or "").partition(".")[0] in EXTRAS:
            return (error.name or "").partition(".")[0]
        error = error.__cause__ or error.__context__
    return None


def _joined(words: Sequence[str]) -> list[str]:
    """``words`` with a negative value joined to its option, "--load=-20 N": alone it looks like an option."""
    found: list[str] = []
    for word in words:
        if re.match(r"-\.?\d", word) and found and re.fullmatch(r"--[\w-]+", found[-1]):
            word = f"{found.pop()}={word}"
        found.append(word)
    return found


def main() -> None:
    """Entry of the ``coatcheck`` command."""
    gc.disable()  # until the command begins: what its modules define stays
    try:
        words = _joined(sys.argv[1:])
        code = app(words, exit_on_error=False, print_error=False, result_action="return_value")
    except CycloptsError as error:
        text = " ".join(str(error).split())
        print_error(_with_remedy(text, sys.argv[1:2]))
        code = BAD_INPUT
    except ImportError as error:
        package = _missing_extra(error)
        if package is None:
            raise
        extra = EXTRAS[package]
        print_error(f"{package} is needed here and not installed. Try: pip install 'coatcheck[{extra}]'")
        code = EXIT[Outcome.NO_RESULT]
    except KeyboardInterrupt:
        sys.stderr.write("\ncoatcheck: stopped; finished cases are kept, go on with --resume\n")
        code = STOPPED
    gc.enable()
    sys.exit(code)


if __name__ == "__main__":
    main()
