"""TOML files of users: bounded reading, checks by a schema, error messages in one line."""

import tomllib
from pathlib import Path
from typing import Annotated, Any, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError

Checked = TypeVar("Checked", bound=BaseModel)

MAX_BYTES = 250_000
# Python's TOML reader takes time and memory with the square of the parts of a dotted key: 100,000 of them, in
# 200 kB, exhaust 20 GB. A line of a case file has a few dots.
MAX_DOTS = 250
MAX_NAME = 100
NO_SOURCE = "no source stated"


class CaseError(ValueError):
    """A case file that cannot be used; the message names file and key."""


class Strict(BaseModel):
    """A part of a case file: no unknown keys, no text where a number belongs."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


Positive = Annotated[float, Field(gt=0)]


def _compressible(nu: float) -> float:
    if nu == 0.5:
        raise ValueError("must be below 0.5, where the material is incompressible; use 0.49")
    return nu


Poisson = Annotated[float, Field(gt=-1, le=0.5), AfterValidator(_compressible)]
Friction = Annotated[float, Field(ge=0, le=2)]
Text = Annotated[str, Field(min_length=1, max_length=500)]


def read_bounded(path: Path, kind: str, holds: str) -> bytes:
    """The content of a .toml file of a ``kind``; ``holds`` names its content. Raises CaseError."""
    # The name goes into file names, terminals and tables.
    if len(path.stem) > MAX_NAME or not path.stem.isprintable():
        rule = f"give the file a name of at most {MAX_NAME} printable characters"
        raise CaseError(f"{path.name[:MAX_NAME]!r}: {rule}")
    try:
        if not path.is_file():
            what = "is a directory" if path.is_dir() else "there is no such file"
            raise CaseError(f"{path}: {what}; give the path of a .toml {kind} file")
        with path.open("rb") as file:
            raw = file.read(MAX_BYTES + 1)
    except OSError as error:
        raise CaseError(f"{path}: {error.strerror or error}; give the path of a .toml {kind} file") from None
    if len(raw) > MAX_BYTES:
        raise CaseError(f"{path}: larger than {MAX_BYTES} bytes; a {kind} file holds {holds}")
    return raw


def load_toml(raw: bytes) -> tuple[str, dict[str, Any]]:
    """The text of a TOML file with its content. Raises ValueError where it is not TOML."""
    try:
        text = raw.decode("utf-8")
    except UnicodeDecodeError:
        raise ValueError("not UTF-8 text; a case file is TOML") from None
    for number, line in enumerate(text.split("\n"), start=1):  # as TOML breaks lines
        if line.count(".") > MAX_DOTS:
            raise ValueError(f"line {number} has more than {MAX_DOTS} dots; break it into several")
    try:
        return text, tomllib.loads(text)
    except RecursionError:
        raise ValueError("not TOML: nested too deeply") from None
    except ValueError as error:  # TOMLDecodeError, or a number of thousands of digits
        raise ValueError(f"not TOML: {error}") from None


def read_toml(raw: bytes, path: Path, model: type[Checked], *, listed: int = 1) -> tuple[str, Checked]:
    """The text of a TOML file with its content checked against ``model``. Raises CaseError.

    listed : errors that the message names at most.
    """
    try:
        text, content = load_toml(raw)
        return text, model.model_validate(content)
    except ValidationError as error:
        raise CaseError(f"{path}: {first_error(error, listed)}") from None
    except ValueError as error:
        raise CaseError(f"{path}: {error}") from None


def first_error(error: ValidationError, listed: int = 1) -> str:
    """The first errors of a case file with key and value, at most ``listed``, in one line."""
    told = [_told(one) for one in error.errors(include_url=False)[:listed]]
    more = error.error_count() - len(told)
    return "; ".join(told) + (f" (and {more} more)" if more else "")


def _told(first: Any) -> str:
    key = ".".join(_shortened(str(part)) for part in first["loc"]) or "top level"
    message = first["msg"].removeprefix("Value error, ")
    text = {
        "missing": "is missing",
        "extra_forbidden": "is an unknown key",
        "finite_number": "must be a finite number",
        "float_type": "must be a number",
        "int_type": "must be a whole number",
        "string_type": "must be text",
        "greater_than": f"must be above {first.get('ctx', {}).get('gt')}",
        "greater_than_equal": f"must be at least {first.get('ctx', {}).get('ge')}",
        "less_than": f"must be below {first.get('ctx', {}).get('lt')}",
        "less_than_equal": f"must be at most {first.get('ctx', {}).get('le')}",
    }.get(first["type"], message[0].lower() + message[1:])
    if first["type"] not in ("missing", "extra_forbidden") and not isinstance(first["input"], dict | list):
        text += f", not {_shown(first['input'])}"
    return f"{key} {text}"


def _shown(value: object) -> str:
    # An integer of thousands of digits is one that Python refuses to print.
    whole = isinstance(value, int) and abs(value) >= 10**60
    return "a whole number of more than 60 digits" if whole else _shortened(repr(value))


def _shortened(text: str) -> str:
    return text if len(text) <= 60 else text[:57] + "..."
