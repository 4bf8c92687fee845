"""A bar that counts on the terminal; the check for gmsh before a command that takes long."""

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.progress import Task as RichTask
from rich.table import Column
from rich.text import Text

from verification.commands.common.command_error import no_result

NARROW = 60  # columns
# On Debian and Ubuntu: what the gmsh wheel opens and pip cannot bring.
GMSH_REMEDY = (
    "apt-get install libglu1-mesa libgl1 libxrender1 libxcursor1 libxfixes3 libxft2 libxinerama1 "
    "libfontconfig1 libgomp1"
)


def require_gmsh() -> None:
    """Raises CommandError with the packages to install where gmsh cannot be loaded."""
    try:
        import gmsh  # noqa: F401
    except OSError:
        raise no_result(f"gmsh lacks system libraries here; install them with: {GMSH_REMEDY}") from None


class _Description(ProgressColumn):
    """Names of the tasks at work, in one line."""

    def render(self, task: RichTask) -> Text:
        return Text(task.description, no_wrap=True, overflow="ellipsis")


def progress_bar(console: Console | None = None, *, silent: bool = False) -> Progress:
    """A bar that counts, with time gone and left, on standard error; nothing where that is no terminal."""
    console = console or Console(stderr=True)
    return Progress(
        # Words and bar give way where the terminal is narrow; counts and times stay whole.
        _Description(table_column=Column(no_wrap=False)),
        *([BarColumn(table_column=Column(no_wrap=False))] if console.width >= NARROW else []),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=console,
        transient=True,
        disable=silent or not console.is_terminal,
    )
