"""coatcheck completion: what a shell needs to complete the command line."""

import sys
from typing import Literal

__all__ = ["completion"]


def completion(shell: Literal["bash", "zsh", "fish"], /) -> int:
    """Print the script that completes coatcheck in a shell.

    Parameters
    ----------
    shell
        bash, zsh or fish.
    """
    from verification.cli import app

    sys.stdout.write(app.generate_completion(prog_name="coatcheck", shell=shell))
    return 0
