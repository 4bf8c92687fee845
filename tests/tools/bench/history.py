"""History of the benchmark: a file with a line of JSON for each run."""

import json
from dataclasses import dataclass
from pathlib import Path

from bench.figures import Figure
from verification.running.checked_files import MAX_BYTES, StoreError, read_bounded, write_atomically
from verification.running.json_records import decode, encode

__all__ = ["BenchRun", "append", "read"]


@dataclass(frozen=True)
class BenchRun:
    """The figures of one run with its provenance; ``date`` in ISO 8601."""

    commit: str | None
    date: str
    machine: str
    versions: dict[str, str]
    figures: tuple[Figure, ...]

    @property
    def short(self) -> str:
        """The commit in eight characters at most, "-" where there is none."""
        name = self.commit or "-"
        return name[:7] + "+" * name.endswith("+")

    def figure(self, like: Figure) -> Figure | None:
        """The figure of that name over the same; None where it was not measured."""
        key = (like.name, like.over)
        return next((one for one in self.figures if (one.name, one.over) == key), None)

    def median(self, like: Figure) -> float | None:
        """The median of ``figure``."""
        found = self.figure(like)
        return None if found is None else found.median


def read(path: Path) -> tuple[BenchRun, ...]:
    """The runs of a file, from the earliest; none where there is no file yet.

    Raises StoreError where a line is not of this program.
    """
    if not path.exists():
        return ()
    lines = read_bounded(path, MAX_BYTES).decode(errors="replace").splitlines()
    runs = []
    for number, line in enumerate(lines, 1):
        try:
            runs.append(decode(BenchRun, json.loads(line)))
        except (ValueError, RecursionError) as error:
            raise StoreError(f"{path}: line {number}: {error}") from None
    return tuple(runs)


def append(path: Path, run: BenchRun) -> tuple[BenchRun, ...]:
    """Add a line; returns all runs of the file. Raises StoreError as ``read``."""
    runs = (*read(path), run)
    write_atomically(path, "".join(f"{json.dumps(encode(one))}\n" for one in runs))
    return runs
