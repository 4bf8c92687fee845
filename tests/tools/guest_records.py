"""python tests/tools guests: examinations of other codes taken into the record that every report shows."""

import hashlib
import json
import tomllib
from pathlib import Path

from verification.guests.pages.guests_section import RECORD


def adapters() -> dict[str, Path]:
    """The folder of each guest among the examples."""
    folders = RECORD.parents[1] / "examples"
    return {
        tomllib.loads(p.read_text(encoding="utf-8"))["name"]: p.parent for p in folders.glob("*/guest.toml")
    }


def digest(folder: Path) -> str:
    """Checksum of an adapter: a record is that of these files."""
    files = sorted(p for p in folder.iterdir() if p.is_file())
    return hashlib.sha256(b"".join(p.name.encode() + p.read_bytes() for p in files)).hexdigest()


def guests(*reports: Path) -> int:
    """Take report.json of coatcheck guest run into the record, in place of an earlier one of that guest.

    Args:
        reports: report.json of each guest.
    """
    record = {one["guest"]: one for one in json.loads(RECORD.read_text(encoding="utf-8"))}
    for path in reports:
        found = json.loads(path.read_text(encoding="utf-8"))
        date = str(found["run"]["started"])[:10]
        kept = {k: v for k, v in found.items() if k not in ("schema", "run", "results")}
        record[found["guest"]] = kept | {"date": date, "sha256": digest(adapters()[found["guest"]])}
    RECORD.write_text(json.dumps(list(record.values()), indent=1) + "\n", encoding="utf-8")
    return 0
