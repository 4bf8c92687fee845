"""Measure what the assumptions of the model cost, over its parameters."""

import datetime
import time
from dataclasses import replace

import numpy as np
from rich.console import Console
from rich.markup import escape

from assumption_maps_made.map_axes import MEASURED
from assumption_maps_made.measuring import assembled, measure, with_map
from verification.commands.common.command_error import CommandError
from verification.commands.common.exit_codes import with_exit_code
from verification.commands.common.known_folders import RECORDS, require_checkout
from verification.commands.common.shared_options import AsJson, Flag, Quiet, RecordsFolder
from verification.commands.common.task_progress import run_info
from verification.commands.common.terminal import did_you_mean, named_table, print_json, print_out
from verification.commands.common.terminal_bar import progress_bar
from verification.evidence.assumption_maps import (
    WORDS,
    AssumptionMap,
    AssumptionMaps,
    read_maps,
    write_maps,
)
from verification.running.json_records import encode


@with_exit_code
def assumptions(
    *names: str,
    record: Flag = False,
    records: RecordsFolder = RECORDS,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> int:
    """Measure the cost of each assumption that all sources share, by models that drop it one at a time.

    Args:
        names: Assumptions, of sphere, goodman and those of the table; all of them unless given.
        record: Store the maps in RECORDS/assumptions.json, beside those of the other assumptions.
    """
    for name in names:
        if name not in MEASURED:
            raise CommandError(f"{name!r} is no assumption with a model{did_you_mean(name, MEASURED)}")
    if record:
        require_checkout(records, "--records")
    made = AssumptionMaps(())
    for name in names or MEASURED:
        new = _measured(name, silent=quiet or as_json)
        made = with_map(made, new)
        if record:  # each as soon as it is made
            stored = write_maps(records, with_map(read_maps(records) or AssumptionMaps(()), new))
    if as_json:
        print_json(encode(made))
    elif not quiet:
        table = named_table("assumption", "quantity", "largest change", *WORDS.values())
        for one in made.maps:
            for i, quantity in enumerate(one.quantities):
                table.add_row(one.assumption, quantity, *_worst(one, i))
        print_out(table)
        if record:
            print_out(escape(f"recorded: {stored}"))
    return 0


def _measured(name: str, *, silent: bool) -> AssumptionMap:
    started, began = datetime.datetime.now(datetime.UTC), time.process_time()
    places = list(MEASURED[name].places())
    found = []
    with progress_bar(Console(stderr=True), silent=silent) as bar:
        task = bar.add_task(name, total=len(places))
        for place in places:
            found.append(measure(name, place))
            bar.update(task, advance=1)
    info = run_info(f"tests/tools assumptions {name}", started, 1)
    return assembled(name, found, replace(info, seconds=round(time.process_time() - began, 1)))


def _worst(one: AssumptionMap, quantity: int) -> tuple[str, ...]:
    """The largest change of a quantity with its place, "any" of what it is independent of."""
    size = np.abs(one.change[quantity])
    if np.isnan(size).all():
        return ("-",) * (1 + len(WORDS))
    where = np.unravel_index(int(np.nanargmax(size)), size.shape)
    at = {axis.name: f"{axis.values[i]:g}" for axis, i in zip(one.axes, where, strict=True)}
    return (f"{one.change[quantity][where]:+.2e}", *(at.get(name, "any") for name in WORDS))
