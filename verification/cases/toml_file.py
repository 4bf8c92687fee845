"""TOML files of users: bounded reading, checks by a schema, error messages in one line."""

import re
import tomllib
from collections.abc import Iterator, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import Annotated, Any, TypeVar, get_args

from pydantic import BaseModel, ConfigDict, Field, ValidationError

Checked = TypeVar("Checked", bound=BaseModel)

MAX_BYTES = 250_000
# Python's TOML reader takes time and memory with the square of the parts of a dotted key: 100,000 of them, in
# 200 kB, exhaust 20 GB. A line of a case file has a few dots.
MAX_DOTS = 250
MAX_NAME = 100
NO_SOURCE = "no source stated"
LISTED = 20  # errors of a file in one message; a file of a thousand is not one with slips
# What people write for a key; as ``meant`` of an option in commands.toml.
_SYNONYMS = {
    "young": "E",
    "youngs_modulus": "E",
    "modulus": "E",
    "poisson": "nu",
    "poisson_ratio": "nu",
    "mu": "friction",
    "cof": "friction",
    "force": "load",
    "h": "thickness",
}
KINDS = {"value", "course", "table", "list", "range"}  # kinds of a value, in errors after its key


class CaseError(ValueError):
    """A case file that cannot be used; the message names file and key."""


class Strict(BaseModel):
    """A part of a case file: no unknown keys, no text where a number belongs."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


Positive = Annotated[float, Field(gt=0)]


Poisson = Annotated[float, Field(gt=-1, le=0.5)]
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
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise ValueError("not UTF-8 text; a case file is TOML, save it as UTF-8") from None
    lines = text.split("\n")  # as TOML breaks lines
    for number, line in enumerate(lines, start=1):
        if line.count(".") > MAX_DOTS:
            raise ValueError(f"line {number} has more than {MAX_DOTS} dots; break it into several")
    try:
        return text, tomllib.loads(text)
    except RecursionError:
        raise ValueError("not TOML: nested too deeply") from None
    except ValueError as error:  # TOMLDecodeError, or a number of thousands of digits
        raise ValueError(f"not TOML: {error}{_remedy(str(error), lines)}") from None


def _remedy(error: str, lines: Sequence[str]) -> str:
    """The slip of the line that an error of the TOML reader names, where it is a common one."""
    found = re.search(r"at line (\d+)", error)
    line = lines[int(found[1]) - 1] if found and int(found[1]) <= len(lines) else ""
    if "Cannot overwrite" in error:
        return "; the key is given twice, leave one out"
    if re.search(r"=\s*[+-]?\d+,\d", line):
        return "; write decimals with a point, such as 0.15"
    if re.search(r"=\s*[+-]?[\d.]+(?:[eE][+-]?\d+)?\s*[^\W\d_]", line):
        return '; a number with a unit is a text in quotation marks, such as "20 N"'
    if re.search("[\u201c\u201d\u201e]", line):
        return '; replace the curly quotation marks by "'
    return ""


def read_toml(raw: bytes, path: Path, model: type[Checked]) -> tuple[str, Checked]:
    """The text of a TOML file with its content checked against ``model``. Raises CaseError."""
    try:
        text, content = load_toml(raw)
        _refuse_other_kind(content, model)
        return text, model.model_validate(content)
    except ValidationError as error:
        raise CaseError(f"{path}: {listed_errors(error, model)}") from None
    except ValueError as error:
        raise CaseError(f"{path}: {error}") from None


def _refuse_other_kind(content: dict[str, Any], model: type[BaseModel]) -> None:
    """Raises ValueError where a case is given for a study, or a study for anything else."""
    asked = "sweep" in model.model_fields
    if asked and "sweep" not in content:
        raise ValueError(
            "the file has no sweep, which a study has and a case has not: try coatcheck solve or coatcheck "
            "run with it, or change the study that coatcheck study init thickness writes"
        )
    if "sweep" in content and not asked:
        raise ValueError(
            "the file has a sweep, which is that of a study: try coatcheck study thickness with it"
        )


def listed_errors(error: ValidationError, model: type[BaseModel]) -> str:
    """All errors of a file in one line, LISTED at most, with place and value; what a key was meant for."""
    told: list[str] = []
    explained: set[str] = set()
    found = error.errors(include_url=False)
    for one in found:
        if one["type"] == "extra_forbidden":
            *above, key = one["loc"]
            near = _meant(str(key), _fields_at(model, above))
            told.append(
                f"{place(*one['loc'])} is an unknown key" + (f"; did you mean {near}?" if near else "")
            )
            explained.add(place(*above, near))
    rest = [
        one
        for one in found
        if one["type"] != "extra_forbidden"
        and not (one["type"] == "missing" and place(*one["loc"]) in explained)
    ]
    # The coatings that a repeat writes out have the same faults.
    kinds = [repr(([key for key in one["loc"] if isinstance(key, str)], one["input"])) for one in rest]
    for i, (one, kind) in enumerate(zip(rest, kinds, strict=True)):
        if kind not in kinds[:i]:
            again = f" (and {kinds.count(kind) - 1} more of the same)" if kinds.count(kind) > 1 else ""
            told.append(f"{place(*one['loc'])} {worded(one)}{again}")
    more = len(told) - LISTED
    return "; ".join(told[:LISTED]).replace("?; ", "? ") + (f"; and {more} more" if more > 0 else "")


def place(*keys: str | int) -> str:
    """A place in a file as a reader names it: problem.coatings.0.E is "coating 1, E"."""
    words: list[str] = []
    for before, key in zip((None, *keys), keys, strict=False):
        text = _shortened(str(key))
        if text.isdecimal():
            if words and before in ("coatings", "claim", "table", "column"):
                words[-1] = f"{str(before).removesuffix('s')} {int(text) + 1}"
            else:
                words.append(f"value {int(text) + 1}")
        elif not (key in KINDS and before in ("E", "thickness", "thickness_over_a_h", "load")):
            words.append(text)
    return ", ".join(words[1:] if len(words) > 1 and words[0] == "problem" else words) or "the file"


def spoken(key: str) -> str:
    """The place of a dotted ``key``, see ``place``."""
    return place(*key.split("."))


def _fields_at(model: type[BaseModel], keys: Sequence[str | int]) -> tuple[str, ...]:
    """The keys that a schema knows at a place."""
    models = [model]
    for key in keys:
        below = [
            one
            for m in models
            for n, f in m.model_fields.items()
            if key in (n, f.alias)
            for one in _within(f.annotation)
        ]
        # A number of an entry, or the kind of a value, is no key.
        models = below or models
    return tuple(dict.fromkeys(f.alias or name for one in models for name, f in one.model_fields.items()))


def _within(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for part in get_args(annotation):
        yield from _within(part)


def _meant(key: str, known: Sequence[str]) -> str:
    """The known key that is most like ``key``, or stands for it; "" for none."""
    folded = {one.casefold(): one for one in known}
    if _SYNONYMS.get(key.casefold()) in known:
        return _SYNONYMS[key.casefold()]
    near = get_close_matches(key[:MAX_NAME].casefold(), folded, n=1, cutoff=0.7)
    return folded[near[0]] if near else ""


def worded(one: Any, *, shown: bool = True) -> str:
    """Fault of a value, with that value if ``shown``, from an error of pydantic."""
    message, kind, limits = one["msg"].removeprefix("Value error, "), one["type"], one.get("ctx", {})
    text = {
        "missing": "is missing",
        "finite_number": "must be a finite number",
        "float_type": "must be a number",
        "int_type": "must be a whole number",
        "string_type": "must be text",
        "list_type": "must be a list: [ ... ], or a table in [[double brackets]] for each",
        "model_type": "must be a table { key = value, ... }",
        "dict_type": "must be a table { key = value, ... }",
        "greater_than": f"must be above {limits.get('gt', 0):g}",
        "greater_than_equal": f"must be at least {limits.get('ge', 0):g}",
        "less_than": f"must be below {limits.get('lt', 0):g}",
        "less_than_equal": f"must be at most {limits.get('le', 0):g}",
    }.get(kind, message[0].lower() + message[1:])
    if kind == "missing" or not shown or isinstance(one["input"], dict | list):
        return text
    given = one["input"]
    if kind == "float_type" and isinstance(given, str):
        if re.fullmatch(r"\s*[+-]?\d*,\d+\s*", given):
            text += "; write decimals with a point, without quotation marks"
        elif given.strip().endswith("%"):
            text += "; 10 % is 0.1"
        elif is_number(given):
            text += "; leave out the quotation marks"
        elif re.match(r"\s*[+-]?[\d.]+", given):
            text += " without a unit"
    what, *hints = text.split("; ")
    return "; ".join([f"{what}, not {_shown(given)}", *hints])


def is_number(text: str) -> bool:
    """Whether a text is a bare number."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def _shown(value: object) -> str:
    # An integer of thousands of digits is one that Python refuses to print.
    whole = isinstance(value, int) and abs(value) >= 10**60
    return "a whole number of more than 60 digits" if whole else _shortened(repr(value))


def _shortened(text: str) -> str:
    return text if len(text) <= 60 else text[:57] + "..."
