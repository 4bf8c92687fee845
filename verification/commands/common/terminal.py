"""Terminal output of the commands.

The command line imports this for each command, so numpy and rich are imported where they are used.
"""

import gc
import json
import os
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from difflib import get_close_matches
from functools import wraps
from pathlib import Path
from shutil import get_terminal_size
from textwrap import wrap
from typing import TYPE_CHECKING, Any, ParamSpec

from verification.commands.common.command_error import BAD_INPUT, CommandError
from verification.judging.outcome import Outcome

if TYPE_CHECKING:
    from rich.table import Table

P = ParamSpec("P")
UNBROKEN = 100_000  # columns of a file or pipe
SHORT = 12  # characters of a cell that is never broken
STYLE = {
    Outcome.AGREES: "green",
    Outcome.DISAGREES: "bold red",
    Outcome.NO_RESULT: "bold red",
    Outcome.INCONCLUSIVE: "yellow",
    Outcome.UNSUPPORTED: "dim",
}


def with_exit_code(command: Callable[P, int]) -> Callable[P, int]:
    """``command``, whose errors of input, of files and of the system become one message and an exit code."""

    @wraps(command)
    def wrapped(*args: P.args, **options: P.kwargs) -> int:
        from verification.cases.toml_file import CaseError
        from verification.running.checked_files import StoreError

        gc.enable()  # which ``cli.main`` disables while it loads a command
        try:
            return command(*args, **options)
        except (CommandError, CaseError, StoreError, OSError) as error:
            print_error(str(error))
            return error.code if isinstance(error, CommandError) else BAD_INPUT

    return wrapped


def print_error(message: str) -> None:
    """Print ``message`` on standard error, in one line."""
    sys.stderr.write(f"coatcheck: {one_line(message)}\n")


def print_warnings(warnings: Iterable[str], name: str, *, strict: bool, silent: bool = False) -> None:
    """Print each of the ``warnings`` of ``name`` on standard error in a line, unless ``silent``.

    strict : raise CommandError with the first instead.
    """
    for message in warnings:
        if strict:
            raise CommandError(f"{name}: {message}")
        if not silent:
            print_error(f"warning: {name}: {message}")


@contextmanager
def while_read() -> Iterator[None]:
    """Standard output, dropped from where the reader of a pipe has gone, as head does.

    The command goes on: its files are still to be written, and its exit code is its own.
    """
    try:
        yield
        sys.stdout.flush()
    except (BrokenPipeError, SystemExit):  # rich ends the program
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@while_read()
def print_json(content: Any) -> None:
    """Print ``content`` on standard output as JSON."""
    sys.stdout.write(json.dumps(content, indent=2) + "\n")


@while_read()
def print_files(files: Iterable[Path], *, as_json: bool, quiet: bool) -> None:
    """Print the paths of written ``files`` on standard output, as JSON or in lines, none if ``quiet``."""
    if as_json:
        print_json({"files": [str(file) for file in files]})
    elif not quiet:
        sys.stdout.write("".join(f"{file}\n" for file in files))


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """ "; did you mean ...?" with the names nearest to a mistyped ``name``; "" where none is near."""
    near = get_close_matches(name.casefold(), list(known), n=2)
    return f"; did you mean {' or '.join(near)}?" if near else ""


def named_table(*heads: str) -> "Table":
    """A table for ``print_out``; its first column holds names that users type."""
    from rich.table import Column, Table

    columns = (Column(head, overflow="fold") for head in heads)
    return Table(*columns, box=None, header_style="bold", pad_edge=False)


@while_read()
def print_out(*items: "Table | str") -> None:
    """Print tables with lines of markup. Names in a first column are never cut, in a file or pipe no line."""
    from rich.console import Console
    from rich.table import Table

    console = Console(highlight=False)
    if not console.is_terminal:
        console = Console(highlight=False, width=UNBROKEN)
    for item in items:
        if isinstance(item, Table):
            # Numbers never give way, names only where there is no room for the words beside them.
            names, *others = (max(len(str(one)) for one in (c.header, *c.cells)) for c in item.columns)
            for column, longest in zip(item.columns[1:], others, strict=True):
                column.no_wrap = column.no_wrap or longest <= SHORT
            beside = sum(2 + min(longest, SHORT) for longest in others)
            item.columns[0].no_wrap = names + beside <= console.width
        console.print(item)


def paragraph(text: str, most: int = 79) -> list[str]:
    """``text`` in lines of at most ``most`` characters, fewer in a narrower terminal."""
    return wrap(text, min(most, get_terminal_size().columns))


def one_line(message: str, most: int = 1000) -> str:
    """``message`` in one line without control characters, which an untrusted file may hold."""
    shown = "".join(c if c.isprintable() else repr(c)[1:-1] for c in message)
    return shown if len(shown) <= most else f"{shown[: most - 3]}..."
