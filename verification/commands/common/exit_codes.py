"""Exit codes of the commands with the conditions that end one."""

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec

from verification.commands.common.terminal import print_error
from verification.judging.outcome import Outcome
from verification.regression.run_exit_codes import DRIFTED, EXIT, LESS, exit_code, run_code

__all__ = [
    "BAD_INPUT",
    "DRIFTED",
    "EXIT",
    "LESS",
    "STOPPED",
    "CommandError",
    "exit_code",
    "no_result",
    "run_code",
    "with_exit_code",
]

P = ParamSpec("P")

BAD_INPUT = 2
STOPPED = 130  # as a shell has it of SIGINT


class CommandError(Exception):
    """Ends a command with its message and ``code``; see ``with_exit_code``."""

    def __init__(self, message: str, code: int = BAD_INPUT) -> None:
        super().__init__(message)
        self.code = code


def no_result(message: str) -> CommandError:
    """Ends a command that could not get its result."""
    return CommandError(message, EXIT[Outcome.NO_RESULT])


def with_exit_code(command: Callable[P, int]) -> Callable[P, int]:
    """``command``, whose errors of input, of files and of the system become one message and an exit code."""

    @wraps(command)
    def wrapped(*args: P.args, **options: P.kwargs) -> int:
        from verification.cases.toml_file import CaseError
        from verification.running.checked_files import StoreError
        from verification.running.pool.pool_task import SchedulerError

        try:
            return command(*args, **options)
        except (CommandError, CaseError, StoreError, SchedulerError, OSError) as error:
            print_error(str(error))
            return error.code if isinstance(error, CommandError) else BAD_INPUT

    return wrapped
