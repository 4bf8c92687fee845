"""Files of a run directory: written whole or not at all, read back only if their checksum holds."""

import csv
import hashlib
import io
import json
import lzma
import os
import re
import stat
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

# A result of this program takes up to 3 MB; what is larger was not written by it.
MAX_BYTES = 50_000_000
PART = ".coatcheck-part"  # how the name of a file ends that is still being written
# Whatever the commands of this program make below a directory of theirs.
FOLDERS = ("cases", "planes", "fields", "problems", "answers", "clean", "trials", "cache", "figures")
_DECIMAL_COMMA = re.compile(r"^(\s*[+-]?\d*),(\d+(?:[eE][+-]?\d+)?\s*)$")
_HEAD = re.compile(r'\{"sha256": "([0-9a-f]{64})", "payload": ')


class StoreError(Exception):
    """A stored file that cannot be used or written; the message names it."""


def write_atomically(path: Path, content: str | bytes) -> None:
    """Write to a temporary file beside ``path``, flush it to disk, rename. Raises StoreError.

    A link at ``path`` is replaced, never followed.
    """
    data = content.encode() if isinstance(content, str) else content
    _write_all(path.parent, {path.name: data}, f"{path}: cannot", "free space or choose --output")


def write_together(folder: Path, texts: Mapping[str, str]) -> None:
    """Write ``texts`` by their names into ``folder``; each replaces its predecessor once all are written.

    An error leaves the earlier files as they were. Raises StoreError where the folder cannot be written.
    """
    # A lone surrogate in an untrusted title must not cost the whole report.
    data = {name: text.encode("utf-8", errors="replace") for name, text in texts.items()}
    remedy = "free space, then continue with --resume"
    _write_all(folder, data, f"{folder}: the report cannot", remedy)


def _write_all(folder: Path, contents: Mapping[str, bytes], what: str, remedy: str) -> None:
    ready: dict[Path, Path] = {}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, data in contents.items():
            handle, path = tempfile.mkstemp(prefix=f".{name[:80]}.", suffix=PART, dir=folder)
            ready[Path(path)] = folder / name
            with os.fdopen(handle, "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            os.chmod(path, 0o644)
        for temporary, final in ready.items():
            temporary.replace(final)
    except OSError as error:
        raise StoreError(f"{what} be written ({error.strerror or error}); {remedy}") from None
    finally:
        for temporary in ready:
            with suppress(OSError):
                temporary.unlink(missing_ok=True)


def write_checked(path: Path, payload: dict[str, Any]) -> None:
    """Store ``payload`` as JSON beside its SHA-256; compressed where the name ends in .xz."""
    body = json.dumps(payload, sort_keys=True, allow_nan=False)
    content = f'{{"sha256": "{_digest(body)}", "payload": {body}}}\n'
    write_atomically(path, lzma.compress(content.encode()) if path.suffix == ".xz" else content)


def read_checked(path: Path) -> dict[str, Any]:
    """The payload of ``path``. Raises StoreError where it is missing, damaged or cut short."""
    try:
        raw = read_bounded(path, MAX_BYTES)
        if path.suffix == ".xz":
            raw = lzma.LZMADecompressor().decompress(raw, MAX_BYTES)
        text = raw.decode("utf-8")
        head = _HEAD.match(text)
        # The checksum comes first: nothing is parsed that this program did not write.
        if head is None or not text.endswith("}\n"):
            raise ValueError
        body = text[head.end() : -2]
        if _digest(body) != head[1]:
            raise StoreError(f"{path}: its checksum does not hold; the file is damaged, run the case again")
        payload = json.loads(body)
        if not isinstance(payload, dict):
            raise ValueError
    except (ValueError, RecursionError, lzma.LZMAError, EOFError):
        raise StoreError(f"{path}: not a whole result file; it is damaged, run the case again") from None
    return payload


def read_bounded(path: Path, most: int) -> bytes:
    """The content of a regular file of at most ``most`` bytes. Raises StoreError for any other.

    Neither a pipe nor a device can hold the reader up.
    """
    try:
        handle = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
        with open(handle, "rb") as file:
            if not stat.S_ISREG(os.fstat(handle).st_mode):
                raise StoreError(f"{path}: not a regular file; it cannot be read")
            raw = file.read(most + 1)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise StoreError(f"{path}: cannot be read ({reason})") from None
    if len(raw) > most:
        raise StoreError(f"{path}: larger than {most} bytes; not a file of this program")
    return raw


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold ``folder`` against a second writer; what a killed one left half-written is cleared away.

    Raises StoreError where another run holds it, where it cannot be written, and where a link in it leads
    out of it.
    """
    import fcntl

    path = folder / ".lock"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for place in (folder / name for name in FOLDERS):
            if place.is_symlink():
                what = f"a link that may lead out of {folder}; remove it or choose another --output"
                raise StoreError(f"{place}: {what}")
        # Neither a link nor a pipe in the place of the lock is followed or waited for.
        flags = os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC
        file = os.fdopen(os.open(path, flags, 0o644), "r+b", buffering=0)
    except OSError as error:
        raise StoreError(
            f"{folder}: cannot be written ({error.strerror}); choose another directory with --output"
        ) from None
    with file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise StoreError(
                f"{folder}: another coatcheck run is writing here; wait for it or choose --output"
            ) from None
        except OSError as error:
            raise StoreError(
                f"{folder}: cannot be locked ({error.strerror}); choose a local directory with --output"
            ) from None
        for place in (folder, *(folder / name for name in FOLDERS)):
            for left in place.glob(f".*{PART}"):
                with suppress(OSError):
                    left.unlink()
        yield


def _digest(body: str) -> str:
    return hashlib.sha256(body.encode()).hexdigest()


def rows_of_csv(text: str) -> list[list[str]]:
    """Rows of a CSV text, separated by semicolons, tabs or commas, whichever the first line has most of.

    Where commas do not separate they may be decimal; such numbers get a point. Raises csv.Error.
    """
    separator = max(";\t,", key=text.partition("\n")[0].count)
    rows = csv.reader(io.StringIO(text), delimiter=separator)
    if separator == ",":
        return list(rows)
    return [[_DECIMAL_COMMA.sub(r"\1.\2", cell) for cell in row] for row in rows]
