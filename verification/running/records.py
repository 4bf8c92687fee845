"""Records as JSON: any frozen dataclass of the project as plain content, with the exact inverse."""

from collections.abc import Collection
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from verification.running.store import StoreError, read_checked

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


def read_stored(kind: type[T], path: Path, schemas: Collection[str], what: str, remedy: str) -> T | None:
    """The record of ``kind`` stored at ``path``, None where there is none.

    schemas : that this version reads.   what, remedy : of the message of StoreError, raised where the file is
    damaged, has another schema, or does not fit ``kind``.
    """
    if not path.exists():
        return None
    data = read_checked(path)
    if data.get("schema") not in schemas:
        raise StoreError(f"{path}: not a record of {what} that this version reads; {remedy}")
    try:
        return decode(kind, data)
    except ValueError as error:
        raise StoreError(f"{path}: not a record of {what} ({error}); {remedy}") from None


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
