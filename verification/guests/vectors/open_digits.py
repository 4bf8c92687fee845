"""The open digits as a file: JSON with a schema, CSV, checksums."""

import csv
import gzip
import hashlib
import io
import json
from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from verification.problem.quantity import unit_of

VERSION: Literal["coatcheck-vectors/1"] = "coatcheck-vectors/1"
FILE = Path(__file__).parents[1] / "shipped" / "vectors.json.gz"
README = Path(__file__).parent / "README.md"
LICENCE: Literal["CC0-1.0"] = "CC0-1.0"


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class Material(_Strict):
    """Young's modulus [Pa], Poisson's ratio, thickness [m] of a coating."""

    E: float
    nu: float
    thickness: float | None = None


class Entry(_Strict):
    """The problem: radius [m] and load [N] of a sphere, or pressure [Pa] on a disc of load_radius [m]."""

    radius: float | None = None
    load: float | None = None
    pressure: float | None = None
    load_radius: float | None = None
    friction: float = 0.0
    coatings: list[Material]
    substrate: Material


class Points(_Strict):
    """Values at points of the plane y = 0 in one layer; as many of each as x and z."""

    layer: int
    x: list[float]
    z: list[float]
    values: dict[str, list[float]]
    uncertainty: dict[str, list[float]]


class Vector(_Strict):
    """One problem with its values: numbers of the contact as [value, uncertainty], then points."""

    name: str
    group: str
    problem: Entry
    contact: dict[str, tuple[float, float]]
    points: list[Points]


class Checked(_Strict):
    """How many ``values`` of how many ``problems`` a ``method`` gave, and how many lie ``within`` both U."""

    method: str
    problems: int
    values: int
    within: int
    largest_share_of_U: float
    refused: list[str] = Field(default_factory=list)


class VectorSet(_Strict):
    """The whole data set; ``sha256`` are the checksums of the CSV files of the same content."""

    schema_: Literal["coatcheck-vectors/1"] = Field(alias="schema")
    licence: Literal["CC0-1.0"]
    cite: str
    conventions: dict[str, str]
    made_by: dict[str, str]
    checked: list[Checked]
    sha256: dict[str, str]
    problems: list[Vector]


def csv_texts(vectors: Sequence[dict[str, Any]]) -> dict[str, str]:
    """The same content as ``problems.csv`` and ``values.csv``."""
    most = max(len(v["problem"]["coatings"]) for v in vectors)
    layers = [name for k in range(1, most + 1) for name in (f"E{k} [Pa]", f"nu{k}", f"thickness{k} [m]")]
    heads = {"radius": "m", "load": "N", "pressure": "Pa", "load_radius": "m", "friction": ""}
    named = [f"{name} [{unit}]" if unit else name for name, unit in heads.items()]
    problems: list[list[Any]] = [["name", "group", *named, "E [Pa]", "nu", *layers]]
    values: list[list[Any]] = [
        ["problem", "quantity", "unit", "x [m]", "z [m]", "layer", "value", "uncertainty"]
    ]
    for v in vectors:
        p = v["problem"]
        row = [
            v["name"],
            v["group"],
            *(p.get(name, "") for name in heads),
            p["substrate"]["E"],
            p["substrate"]["nu"],
        ]
        for coating in p["coatings"]:
            row += [coating["E"], coating["nu"], coating["thickness"]]
        problems.append(row + [""] * (len(problems[0]) - len(row)))
        values += [[v["name"], q, unit_of(q), 0.0, 0.0, 0, *found] for q, found in v["contact"].items()]
        for points in v["points"]:
            for q, found in points["values"].items():
                places = zip(points["x"], points["z"], found, points["uncertainty"][q], strict=True)
                values += [
                    [v["name"], q, unit_of(q), x, z, points["layer"], value, U] for x, z, value, U in places
                ]
    return {"problems.csv": _csv(problems), "values.csv": _csv(values)}


def _csv(rows: list[list[Any]]) -> str:
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows(rows)
    return out.getvalue()


def shipped() -> dict[str, Any]:
    """The data set of the package."""
    found: dict[str, Any] = json.loads(gzip.decompress(FILE.read_bytes()))
    return found


def texts(content: dict[str, Any]) -> dict[str, str]:
    """Every file of the data set by its name."""
    files = {
        "vectors.json": json.dumps(content, separators=(",", ":")) + "\n",
        "vectors.schema.json": json.dumps(VectorSet.model_json_schema(), indent=1) + "\n",
        **csv_texts(content["problems"]),
        "README.md": README.read_text(encoding="utf-8"),
    }
    sums = [f"{hashlib.sha256(text.encode()).hexdigest()}  {name}" for name, text in files.items()]
    return files | {"SHA256SUMS": "\n".join(sums) + "\n"}


def value_count(content: dict[str, Any]) -> int:
    """How many values the data set holds."""
    return sum(1 for v in content["problems"] for _ in _values(v))


def uncertain(content: dict[str, Any]) -> Iterator[float]:
    """The uncertainty of every value: of a number over itself, of a profile over its largest magnitude."""
    for v in content["problems"]:
        yield from (U / abs(value) for value, U in v["contact"].values())
        for _, found in groupby(sorted(_fields(v)), key=lambda item: item[0]):
            rows = list(found)
            scale = max(abs(value) for _, value, _ in rows)
            yield from (U / scale if scale else 0.0 for _, _, U in rows)


def _fields(v: dict[str, Any]) -> Iterator[tuple[str, float, float]]:
    for points in v["points"]:
        for q, found in points["values"].items():
            yield from ((q, value, U) for value, U in zip(found, points["uncertainty"][q], strict=True))


def _values(v: dict[str, Any]) -> Iterator[float]:
    yield from (value for value, _ in v["contact"].values())
    yield from (value for _, value, _ in _fields(v))
