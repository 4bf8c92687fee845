"""The exit code of a command, also of one that ends with an error."""

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec

from verification.commands.common.command_error import BAD_INPUT, CommandError
from verification.commands.common.terminal import print_error

P = ParamSpec("P")


def with_exit_code(command: Callable[P, int]) -> Callable[P, int]:
    """``command``, whose errors of input, of files and of the system become one message and an exit code."""

    @wraps(command)
    def wrapped(*args: P.args, **options: P.kwargs) -> int:
        from verification.cases.toml_file import CaseError
        from verification.running.checked_files import StoreError

        try:
            return command(*args, **options)
        except (CommandError, CaseError, StoreError, OSError) as error:
            print_error(str(error))
            return error.code if isinstance(error, CommandError) else BAD_INPUT

    return wrapped
