"""coatcheck validation: the methods held against measurements."""

import time
from datetime import datetime
from pathlib import Path

from rich.markup import escape

from verification.commands.common.shared_options import AsJson, Output
from verification.commands.common.terminal import print_json, print_out, with_exit_code
from verification.running.checked_files import write_atomically
from verification.running.provenance import commit

ELEMENTS = 3  # rows of each admissible set that the finite elements solve too


@with_exit_code
def validation(*, output: Output = Path("validation"), as_json: AsJson = False) -> int:
    """Compute every measurement at hand again and write the page: reported, not judged.

    Args:
        output: Directory of validation.html and validation.json.
    """
    from verification.evidence.judged_source import source_hash
    from verification.validation import validation_page as pages
    from verification.validation.measured_modulus import data_sets
    from verification.validation.validation_metric import RECORD, ValidationRecord, validated

    begun, used = datetime.now(), time.process_time()
    sets = tuple(validated(one, 0 if one.reason else ELEMENTS) for one in data_sets())
    seconds = round(time.process_time() - used, 1)
    started = begun.isoformat(timespec="seconds")
    found = ValidationRecord(sets, started, commit(), seconds, source_hash("validation"))
    write_atomically(output / "validation.html", pages.page(found))
    stored = RECORD.write(output, found)
    if as_json:
        print_json(RECORD.to_json(found))
    else:
        for one in sets:
            not_compared = f" Not admissible: {one.measured.reason}." if one.measured.reason else ""
            print_out(escape(pages.answer(one) + not_compared), "")
        print_out(escape(f"{output / 'validation.html'}, {stored}"))
    return 0
