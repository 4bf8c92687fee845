"""Proven enclosures of contacts, by ball arithmetic."""

import datetime
import time
from dataclasses import asdict
from importlib.metadata import version
from typing import TYPE_CHECKING

from rich.markup import escape

from enclosures_made.enclosed_problems import problems, profile_radii
from verification.commands.common.command_error import CommandError, no_result
from verification.commands.common.known_folders import RECORDS, require_checkout
from verification.commands.common.shared_options import AsJson, Flag, Quiet, RecordsFolder
from verification.commands.common.task_progress import run_info
from verification.commands.common.terminal import (
    did_you_mean,
    named_table,
    print_json,
    print_out,
    with_exit_code,
)
from verification.evidence.enclosure_record import (
    LOWER,
    SURFACE,
    UPPER,
    WIDTH,
    Bounds,
    Enclosure,
    EnclosureRecord,
    Ring,
    read_record,
    write_record,
)
from verification.judging.outcome import Outcome
from verification.problem.coated_contact import CoatedContact
from verification.regression.run_exit_codes import EXIT
from verification.running.json_records import plain

if TYPE_CHECKING:
    from flint import arb

DIGITS = 24


@with_exit_code
def certify(
    *names: str,
    record: Flag = False,
    records: RecordsFolder = RECORDS,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> int:
    """Enclose contact radius, approach, pressure and sigma_xx on the axis between proven bounds.

    Requires the extra certify: pip install 'coatcheck[certify]'. All problems need a few minutes of one core.

    Args:
        names: Names of the problems, as the record lists them; all of them unless given.
        record: Store the enclosures in RECORDS/enclosures.json, which every run reads.
    """
    try:
        from flint import ctx
    except ModuleNotFoundError:
        raise CommandError("ball arithmetic is missing; pip install 'coatcheck[certify]'") from None
    known = problems()
    for name in names:
        if name not in known:
            raise CommandError(f"{name!r} is no problem of certify{did_you_mean(name, known)}")
    if record:
        require_checkout(records, "--records")
    ctx.prec = 128
    started, found = datetime.datetime.now(datetime.UTC), []
    for name in names or known:
        try:
            one = _certified(name, known[name])
        except ValueError as error:
            raise no_result(f"{name}: {error}") from None
        found.append(one)
        if not quiet and not as_json:
            print_out(escape(f"{name}: {one.bounds[2].middle:.15g} Pa, {one.seconds:g} s"))
    stored = None
    if record:
        kept = read_record(records)
        others = {one.name: one for one in kept.enclosures} if kept and names else {}
        merged = others | {one.name: one for one in found}
        info = run_info("tests/tools certify", started, 1)
        content = EnclosureRecord(
            tuple(merged.values()),
            info.started,
            round(sum(one.seconds for one in merged.values()), 1),
            info.commit,
            info.machine,
            dict(info.versions) | {"python-flint": version("python-flint")},
        )
        stored = write_record(records, content)
    widest = max(bounds.width for one in found for bounds in one.bounds)
    if as_json:
        print_json(plain([asdict(one) for one in found]))
    elif not quiet:
        table = named_table("problem", "largest relative width", "seconds")
        for one in found:
            table.add_row(escape(one.name), f"{max(b.width for b in one.bounds):.1e}", f"{one.seconds:g}")
        print_out(table, f"widest of all: {widest:.1e}; required: {WIDTH:g}")
        if stored is not None:
            print_out(escape(f"recorded: {stored}"))
    return 0 if widest <= WIDTH else EXIT[Outcome.INCONCLUSIVE]


def _certified(name: str, problem: CoatedContact) -> Enclosure:
    """The enclosure of a problem. Raises ValueError where a bound cannot be proven."""
    from enclosures_made.contact_enclosure import enclose

    began, radii = time.process_time(), profile_radii(name)
    balls = enclose(problem, radii)
    values = [
        ("contact_radius", "contact", balls.contact_radius),
        ("approach", "contact", balls.approach),
        ("pressure", SURFACE, balls.pressure),
        ("sigma_xx", SURFACE, balls.surface),
        *(("sigma_xx", *side) for side in zip((UPPER, LOWER), balls.interface or (), strict=False)),
    ]
    bounds = tuple(Bounds(quantity, line, *decimal(ball)) for quantity, line, ball in values)
    seconds = round(time.process_time() - began, 2)
    return Enclosure(
        name,
        problem.radius,
        problem.load,
        problem.coatings,
        problem.substrate,
        bounds,
        seconds,
        balls.bits,
        balls.terms,
        tuple(Ring(r, *decimal(ball)) for r, ball in zip(radii, balls.profile, strict=True)),
    )


def decimal(ball: "arb") -> tuple[str, str]:
    """Decimal numbers that enclose ``ball``, exact as they are written."""
    middle, radius, exponent = ball.mid_rad_10exp(DIGITS)
    return f"{int(middle - radius)}e{int(exponent)}", f"{int(middle + radius)}e{int(exponent)}"
