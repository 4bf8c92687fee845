"""Files of a run directory: written whole or not at all, read back only if their checksum holds."""

import hashlib
import json
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

__all__ = ["StoreError", "locked", "read_checked", "write_atomically", "write_checked"]

MAX_BYTES = 200_000_000


class StoreError(Exception):
    """A stored file that cannot be used or written; the message names it."""


def write_atomically(path: Path, content: str | bytes) -> None:
    """Write to a temporary file beside ``path``, flush it to disk, rename. Raises StoreError."""
    data = content.encode() if isinstance(content, str) else content
    temporary = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=path.parent, prefix=f".{path.name}.", delete=False) as file:
            temporary = Path(file.name)
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(0o644)
        temporary.replace(path)
    except OSError as error:
        if temporary is not None:
            temporary.unlink(missing_ok=True)
        raise StoreError(
            f"{path}: cannot be written ({error.strerror or error}); free space or choose --output"
        ) from None


def write_checked(path: Path, payload: dict[str, Any]) -> None:
    """Store ``payload`` as JSON beside its SHA-256."""
    body = json.dumps(payload, sort_keys=True, allow_nan=False)
    write_atomically(path, f'{{"sha256": "{_digest(body)}", "payload": {body}}}\n')


def read_checked(path: Path) -> dict[str, Any]:
    """The payload of ``path``. Raises StoreError where it is missing, damaged or cut short."""
    try:
        with path.open("rb") as file:
            raw = file.read(MAX_BYTES + 1)
        if len(raw) > MAX_BYTES:
            raise StoreError(f"{path}: larger than {MAX_BYTES} bytes; not a result of this program")
        text = raw.decode("utf-8")
        data = json.loads(text)
        stated, payload = data["sha256"], data["payload"]
        start = text.index('"payload": ') + len('"payload": ')
        if not text.endswith("}\n") or _digest(text[start:-2]) != stated or not isinstance(payload, dict):
            raise StoreError(f"{path}: its checksum does not hold; the file is damaged, run the case again")
    except OSError as error:
        raise StoreError(f"{path}: cannot be read ({error.strerror})") from None
    except (ValueError, KeyError, TypeError, RecursionError):
        raise StoreError(f"{path}: not a whole result file; it is damaged, run the case again") from None
    return payload


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold ``folder`` against a second writer. Raises StoreError where another run holds it."""
    import fcntl

    path = folder / ".lock"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = path.open("a+")
    except OSError as error:
        raise StoreError(
            f"{folder}: cannot be written ({error.strerror}); choose another directory with --output"
        ) from None
    with file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise StoreError(
                f"{folder}: another coatcheck run is writing here; wait for it or choose --output"
            ) from None
        yield


def _digest(body: str) -> str:
    return hashlib.sha256(body.encode()).hexdigest()
