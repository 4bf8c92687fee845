"""coatcheck completion: what a shell needs to complete the command line."""

import re
import sys
from typing import Literal

__all__ = ["completion"]

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
    from verification.cli import app

    script = app.generate_completion(prog_name="coatcheck", shell=shell)
    # A word that no command or option begins with may be a case file; fish tries files by itself.
    if shell == "bash":
        script = re.sub(r"^complete -F", "complete -o bashdefault -o default -F", script, flags=re.MULTILINE)
    elif shell == "zsh":
        script = re.sub(r"^( +'(?:\*|\d):[^':]+)'", r"\1:_files'", script, flags=re.MULTILINE) + ZSH_END
    sys.stdout.write(script)
    return 0
