"""coatcheck assumptions: what the assumptions of the model cost, over its parameters."""

import datetime
import time

import numpy as np
from rich.markup import escape

from verification.commands.common.exits import with_exit_code
from verification.commands.common.folders import RECORDS, require_checkout
from verification.commands.common.options import AsJson, Flag, Quiet, RecordsFolder
from verification.commands.common.solving import run_info
from verification.commands.common.terminal import named_table, print_json, print_out
from verification.credibility.model.error import KNOWN
from verification.credibility.model.maps import (
    QUANTITIES,
    AssumptionMaps,
    Entry,
    measure,
    places,
    write_maps,
)
from verification.running.records import encode


@with_exit_code
def assumptions(
    *,
    record: Flag = False,
    records: RecordsFolder = RECORDS,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> int:
    """Measure the cost of each assumption that all sources share, by models that drop it one at a time.

    A few minutes of one core.

    Args:
        record: Store the maps in RECORDS/assumptions.json.
    """
    if record:
        require_checkout(records, "--records")
    started, began = datetime.datetime.now(datetime.UTC), time.process_time()
    entries = tuple(measure(name, place) for name in KNOWN for place in places(name))
    info = run_info("coatcheck assumptions", started, 1)
    seconds = round(time.process_time() - began, 1)
    maps = AssumptionMaps(entries, info.started, seconds, info.commit, info.machine, dict(info.versions))
    stored = write_maps(records, maps) if record else None
    if as_json:
        print_json(encode(maps))
    elif not quiet:
        table = named_table("assumption", "quantity", "largest change", "E1/E2", "h/a_h", "nu", "a_h/R", "f")
        for name in KNOWN:
            of = [entry for entry in entries if entry.assumption == name]
            for i, quantity in enumerate(QUANTITIES):
                worst = of[int(np.argmax([abs(entry.change[i]) for entry in of]))]
                table.add_row(escape(name), quantity, f"{worst.change[i]:+.2e}", *_place(worst))
        print_out(table)
        if stored is not None:
            print_out(escape(f"recorded: {stored}"))
    return 0


def _place(entry: Entry) -> tuple[str, ...]:
    at = entry.place
    return tuple(f"{value:g}" for value in (at.ratio, at.thickness, at.nu, at.width, at.friction))
