"""Bound contacts of the enclosures by finite elements, from both sides."""

import time
from dataclasses import replace

from rich.markup import escape

from energy_bounds.approach_bounds import bound
from verification.commands.common.exit_codes import with_exit_code
from verification.commands.common.known_folders import RECORDS
from verification.commands.common.shared_options import Flag
from verification.commands.common.terminal import named_table, print_out
from verification.commands.credibility.certify import decimal
from verification.evidence.enclosure_record import Bounds, Enclosure, TwoSided, read_record, write_record
from verification.judging.outcome import Outcome
from verification.regression.run_exit_codes import EXIT
from verification.sources.enclosures.contact_enclosure import enclose

# soft and stiff, thin and thick, two coatings, nu = 0.45
NAMES = (
    "ratio_0.1_h_0.1",
    "ratio_0.25_h_1",
    "ratio_4_h_0.1",
    "ratio_10_h_1",
    "two_stiff_on_soft",
    "nu_0.45_in_both",
)


@with_exit_code
def bounds(*names: str, record: Flag = False) -> int:
    """Bound stiffness and approach at the enclosed contact radius of recorded problems, which takes a minute.

    Args:
        names: Names of problems of the record; six of them unless given.
        record: Store the bounds beside the enclosures, which every run reads.
    """
    stored = read_record(RECORDS)
    assert stored is not None
    found = {one.name: _bounded(one) for one in stored.enclosures if one.name in (names or NAMES)}
    table = named_table("problem", "width, stiffness", "width, approach", "enclosed values", "seconds")
    for name, two in found.items():
        held = "inside" if two.contained else "OUTSIDE"
        pairs = ((two.found.stiffness, two.stiffness), (two.found.approach, two.approach))
        widths = (f"{(high - low) / one.middle:.1e}" for (low, high), one in pairs)
        table.add_row(escape(name), *widths, held, f"{two.seconds:g}")
    print_out(table)
    if record:
        kept = tuple(replace(one, two_sided=found.get(one.name, one.two_sided)) for one in stored.enclosures)
        write_record(RECORDS, replace(stored, enclosures=kept))
    return EXIT[Outcome.AGREES if all(two.contained for two in found.values()) else Outcome.DISAGREES]


def _bounded(one: Enclosure) -> TwoSided:
    from flint import ctx

    ctx.prec = 128
    stiffness = Bounds("stiffness", "contact", *decimal(enclose(one.problem).stiffness))
    began = time.process_time()
    found = bound(one.problem, one.bounds[0].middle)
    return TwoSided(found, stiffness, one.bounds[1], round(time.process_time() - began, 2))
