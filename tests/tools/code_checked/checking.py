"""Checks of the code itself, recorded: orders on manufactured solutions, imports of each part."""

import datetime
import time

from code_checked.import_independence import parts
from code_checked.manufactured_solutions import design_orders
from verification.commands.common.known_folders import RECORDS
from verification.commands.common.shared_options import Flag
from verification.commands.common.task_progress import run_info
from verification.commands.common.terminal import named_table, print_out
from verification.evidence.code_record import CodeRecord, write_record
from verification.evidence.judged_source import source_hash


def code(*, record: Flag = False) -> int:
    """Measure the orders of the finite element operator and read the imports of each part of the program.

    Exit codes: 0 every order is that of the design and no import is forbidden; 1 not so.

    Args:
        record: Store both, for the credibility page of every report.
    """
    started, began = datetime.datetime.now(datetime.UTC), time.process_time()
    orders, read = design_orders(), parts()
    info = run_info("tests/tools code", started, 1)
    seconds = round(time.process_time() - began, 1)
    made = info.started, seconds, info.commit, info.machine, dict(info.versions)
    found = CodeRecord(orders, read, *made, source_hash("code"))
    table = named_table("elements of order", "harmonic", "order of u", "order of its gradient")
    for one in orders:
        table.add_row(str(one.order), str(one.harmonic), f"{one.displacement:.2f}", f"{one.gradient:.2f}")
    print_out(table)
    for part in read:
        bad = "; ".join((*part.forbidden, *part.hidden)) or "none forbidden"
        print_out(f"{part.name}: {part.statements} imports in {part.files} files, {bad}")
    if record:
        print_out(f"recorded: {write_record(RECORDS, found)}")
    return 0 if all(one.as_designed for one in orders) and all(part.passed for part in read) else 1
