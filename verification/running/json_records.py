"""Records as JSON: any frozen dataclass of the project as plain content, with the exact inverse."""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np

from verification.running.checked_files import StoreError, read_checked, write_checked

T = TypeVar("T")


def encode(record: Any) -> Any:
    """``record`` as strict JSON holds it: arrays as nested lists, NaN and infinity as text."""
    return plain(asdict(record))


def decode(kind: type[T], content: Any) -> T:
    """The inverse of ``encode``. Raises ValueError naming the first field that does not fit ``kind``.

    The content may be untrusted: every part is converted to its type, nothing in it is looked up or called.
    """
    from pydantic import ValidationError

    try:
        found: T = _adapter(kind).validate_python(content)  # type: ignore[arg-type]
        return found
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(map(str, first["loc"]))
        raise ValueError(
            f"not a {kind.__name__} of this program ({where}: {first['msg']}); compute it again"
        ) from None


@cache
def _adapter(kind: Any) -> Any:
    from pydantic import TypeAdapter

    return TypeAdapter(kind)


def plain(value: Any) -> Any:
    """``value`` as strict JSON holds it: containers and numbers of Python, NaN and infinity as text."""
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        finite = value.dtype.kind in "biuf" and np.isfinite(value).all()
        return value.tolist() if finite else plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float) and not np.isfinite(value):
        return repr(value)
    if value is None or isinstance(value, bool | int | float | str):
        return value
    return str(value)


@dataclass(frozen=True)
class RecordFile(Generic[T]):
    """The checked file ``name`` of a folder, which holds a record of ``kind``.

    schemas : that of what is written, then the others that this version reads.
    what, remedy : of the message of StoreError.
    more : what the file holds beside the record, for other readers.
    """

    kind: type[T]
    name: str
    schemas: tuple[str, ...]
    what: str
    remedy: str
    more: Callable[[T], dict[str, Any]] = lambda record: {}

    def to_json(self, record: T) -> dict[str, Any]:
        """Content of the file, as strict JSON."""
        return {"schema": self.schemas[0], **encode(record), **plain(self.more(record))}

    def path_in(self, folder: Path) -> Path:
        """Path of the record in ``folder``."""
        return folder / self.name

    def write(self, folder: Path, record: T) -> Path:
        """Store ``record`` in ``folder``, whole or not at all. Raises StoreError."""
        path = self.path_in(folder)
        write_checked(path, self.to_json(record))
        return path

    def read(self, folder: Path) -> T | None:
        """The record in ``folder``, None where there is none.

        Raises StoreError where it is damaged, has another schema, or does not fit ``kind``.
        """
        path = self.path_in(folder)
        if not path.exists():
            return None
        data = read_checked(path)
        if data.get("schema") not in self.schemas:
            raise StoreError(f"{path}: not a record of {self.what} that this version reads; {self.remedy}")
        try:
            return decode(self.kind, data)
        except ValueError as error:
            raise StoreError(f"{path}: not a record of {self.what} ({error}); {self.remedy}") from None
