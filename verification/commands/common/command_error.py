"""The error that ends a command, with its exit code."""

from verification.judging.outcome import Outcome
from verification.regression.run_exit_codes import EXIT

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
