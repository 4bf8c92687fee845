"""python tests/tools guests: examinations of other codes taken into the record that every report shows."""

import json
from pathlib import Path

from verification.guests.pages.guests_section import RECORD


def guests(*reports: Path) -> int:
    """Take report.json of coatcheck guest run into the record, in place of an earlier one of that guest.

    Args:
        reports: report.json of each guest.
    """
    record = {one["guest"]: one for one in json.loads(RECORD.read_text(encoding="utf-8"))}
    for path in reports:
        found = json.loads(path.read_text(encoding="utf-8"))
        date = str(found["run"]["started"])[:10]
        record[found["guest"]] = {k: v for k, v in found.items() if k not in ("schema", "run", "results")} | {
            "date": date
        }
    RECORD.write_text(json.dumps(list(record.values()), indent=1) + "\n", encoding="utf-8")
    return 0
