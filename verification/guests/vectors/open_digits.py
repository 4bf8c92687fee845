"""The open digits as a file: JSON with a schema, CSV, checksums."""

import gzip
import hashlib
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from verification.page.page_parts import written
from verification.problem.quantity import unit_of

FILE = Path(__file__).parents[1] / "shipped" / "vectors.json.gz"
README, SCHEMA = (Path(__file__).parent / name for name in ("README.md", "vectors.schema.json"))


def csv_texts(vectors: Sequence[dict[str, Any]]) -> dict[str, str]:
    """Texts of ``problems.csv`` and ``values.csv`` with the content of the JSON."""
    solids = [(v["problem"], v["problem"].get("ball")) for v in vectors]
    most, inside = (max(len(s["coatings"]) for s in of if s) for of in zip(*solids, strict=True))
    columns = [*_solid_columns("", most), *_solid_columns("ball ", inside)]
    heads = {"radius": "m", "radius_x": "m", "radius_y": "m", "load": "N"}
    heads |= {"pressure": "Pa", "load_radius": "m", "friction": ""}
    named = [f"{name} [{unit}]" if unit else name for name, unit in heads.items()]
    problems: list[list[Any]] = [["name", "group", *named, *columns]]
    values: list[list[Any]] = [
        ["problem", "quantity", "unit", "body", "x [m]", "y [m]", "z [m]", "layer", "value", "uncertainty"]
    ]
    for v in vectors:
        p = v["problem"]
        solid = _solid_numbers(p, most) + _solid_numbers(p.get("ball"), inside)
        problems.append([v["name"], v["group"], *(p.get(name, "") for name in heads), *solid])
        units = {q: "m" if q.startswith("half_axis") else unit_of(q) for q in v["contact"]}
        values += [
            [v["name"], q, units[q], "flat", 0.0, 0.0, 0.0, 0, *found] for q, found in v["contact"].items()
        ]
        for points in v["points"]:
            for q, found in points["values"].items():
                table = zip(*(points[c] for c in "xyz"), found, points["uncertainty"][q], strict=True)
                head = [v["name"], q, unit_of(q), points["body"]]
                values += [[*head, *at, points["layer"], value, U] for *at, value, U in table]
    return {"problems.csv": written(problems), "values.csv": written(values)}


def _solid_columns(of: str, count: int) -> list[str]:
    layers = [
        f"{of}{name}" for k in range(1, count + 1) for name in (f"E{k} [Pa]", f"nu{k}", f"thickness{k} [m]")
    ]
    return [f"{of}E [Pa]", f"{of}nu", *layers]


def _solid_numbers(solid: dict[str, Any] | None, count: int) -> list[Any]:
    """The numbers of ``_solid_columns``; empty cells where there is no such layer, or no solid."""
    if solid is None:
        return [""] * (2 + 3 * count)
    cells = [solid["substrate"][n] for n in ("E", "nu")]
    cells += [coating[n] for coating in solid["coatings"] for n in ("E", "nu", "thickness")]
    return cells + [""] * (2 + 3 * count - len(cells))


def shipped() -> dict[str, Any]:
    """The data set of the package."""
    found: dict[str, Any] = json.loads(gzip.decompress(FILE.read_bytes()))
    return found


def texts(content: dict[str, Any]) -> dict[str, str]:
    """Every file of the data set by its name."""
    files = {
        "vectors.json": json.dumps(content, separators=(",", ":")) + "\n",
        SCHEMA.name: SCHEMA.read_text(encoding="utf-8"),
        **csv_texts(content["problems"]),
        README.name: README.read_text(encoding="utf-8"),
    }
    sums = [f"{hashlib.sha256(text.encode()).hexdigest()}  {name}" for name, text in files.items()]
    return files | {"SHA256SUMS": "\n".join(sums) + "\n"}
