"""The command that solves a case of a report again."""

import shlex
from pathlib import PurePath

from verification.cases.contact import shipped_cases
from verification.cases.published import published_cases

__all__ = ["again"]


def again(name: str, command: str) -> str:
    """What to type, quoted for a shell, to solve the case ``name`` again.

    command : that of the run, which tells where a file of the user's own was read from. Where it does not,
    as after a run that was stopped, the file is named alone.
    """
    try:
        words = shlex.split(command)[2:]
    except ValueError:
        words = []
    own = [word for word in words if PurePath(word).stem == name and PurePath(word).name != name]
    if own:
        word = own[0]
    elif name in words or name in shipped_cases() or name in published_cases():
        word = name
    else:
        word = f"{name}.toml"
    return f"coatcheck run {shlex.quote(f'./{word}' if word.startswith('-') else word)}"
