"""Exit codes of the commands with the conditions that end one."""

from collections.abc import Callable, Sequence
from functools import wraps
from typing import TYPE_CHECKING, ParamSpec

from verification.commands.common.terminal import print_error
from verification.judging.outcome import Outcome

if TYPE_CHECKING:
    from verification.running.result import CaseResult

P = ParamSpec("P")

BAD_INPUT = 2
STOPPED = 130  # as a shell has it of SIGINT
DRIFTED = 5  # all agree, but not with the digits of the baseline
EXIT = {Outcome.DISAGREES: 1, Outcome.NO_RESULT: 3, Outcome.INCONCLUSIVE: 4, Outcome.AGREES: 0}


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
        from verification.cases.toml import CaseError
        from verification.running.store import StoreError

        try:
            return command(*args, **options)
        except (CommandError, CaseError, StoreError, OSError) as error:
            print_error(str(error))
            return error.code if isinstance(error, CommandError) else BAD_INPUT

    return wrapped


def exit_code(results: Sequence["CaseResult"]) -> int:
    """The code of the worst outcome: disagreement before a missing result before inconclusive."""
    found = {result.outcome for result in results}
    for outcome in (Outcome.DISAGREES, Outcome.NO_RESULT, Outcome.INCONCLUSIVE):
        if outcome in found:
            return EXIT[outcome]
    return EXIT[Outcome.AGREES] if found else EXIT[Outcome.NO_RESULT]
