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
    most = max(len(v["problem"]["coatings"]) for v in vectors)
    layers = [name for k in range(1, most + 1) for name in (f"E{k} [Pa]", f"nu{k}", f"thickness{k} [m]")]
    heads = {"radius": "m", "radius_x": "m", "radius_y": "m", "load": "N"}
    heads |= {"pressure": "Pa", "load_radius": "m", "friction": ""}
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
        units = {q: "m" if q.startswith("half_axis") else unit_of(q) for q in v["contact"]}
        values += [[v["name"], q, units[q], 0.0, 0.0, 0, *found] for q, found in v["contact"].items()]
        for points in v["points"]:
            for q, found in points["values"].items():
                places = zip(points["x"], points["z"], found, points["uncertainty"][q], strict=True)
                values += [
                    [v["name"], q, unit_of(q), x, z, points["layer"], value, U] for x, z, value, U in places
                ]
    return {"problems.csv": written(problems), "values.csv": written(values)}


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
