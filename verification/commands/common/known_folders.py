"""Places that the commands read or write."""

from collections.abc import Sequence
from pathlib import Path

import verification
from verification.commands.common.command_error import CommandError
from verification.commands.common.terminal import did_you_mean

PACKAGE = Path(verification.__file__).parent
BASELINE = PACKAGE / "regression" / "shipped"
RECORDS = PACKAGE / "evidence" / "shipped"


def nearest_run(path: Path) -> str:
    """The run directories that a path of no directory may have meant, as ``did_you_mean``."""
    if path.exists() or not path.parent.is_dir():
        return ""
    runs = {folder.name: str(folder) for folder in path.parent.iterdir() if (folder / "report.json").exists()}
    return did_you_mean(path.name, runs)


def within_package(folder: Path) -> str:
    """``folder`` as a report names it: the package's own without the place where it is installed."""
    return str(folder.relative_to(PACKAGE.parent) if folder.is_relative_to(PACKAGE) else folder)


def require_checkout(folder: Path, option: str) -> None:
    """Raises CommandError where ``folder`` is the package's own and not of a source checkout."""
    from verification.running.provenance import commit

    if folder in (BASELINE, RECORDS) and commit() is None:
        raise CommandError(
            f"this coatcheck is installed, not a source checkout; name a directory with {option}"
        )


FIGURES = (".png", ".pdf", ".svg")


def require_format(path: Path, option: str, formats: Sequence[str] = FIGURES) -> None:
    """Raises CommandError where a file of an option has no name of one of its ``formats``, or no folder."""
    if path.suffix.lower() not in formats:
        raise CommandError(f"{option} = {path}; the name has to end in {', '.join(formats)}")
    if not path.parent.is_dir():
        raise CommandError(f"{option} = {path}; there is no folder {path.parent}; create it, or name another")
