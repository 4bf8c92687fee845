"""coatcheck surface: a measured surface pressed on a coated body."""

from pathlib import Path
from typing import Annotated, Any

import numpy as np
from cyclopts import Parameter
from rich.markup import escape
from threadpoolctl import threadpool_limits

from semianalytic import NotConverged
from verification.cases.case_file import Case, parse_case
from verification.cases.materials import SHIPPED as SHIPPED_MATERIALS
from verification.commands.common.answer_words import spread_text, value_text
from verification.commands.common.command_error import CommandError, no_result
from verification.commands.common.known_folders import require_format
from verification.commands.common.shared_options import AsJson, Flag, MaterialsFile
from verification.commands.common.terminal import (
    named_table,
    print_json,
    print_out,
    print_warnings,
    with_exit_code,
)
from verification.desk.case_wording import case_text, metres
from verification.desk.layer_limits import layer_modes, strengths_of, verdict
from verification.desk.measured.surface_contact import SurfaceContact, pressed
from verification.desk.measured.surface_map import SurfaceMap, read_map
from verification.desk.stack_text import body_label, described, stack, units_of
from verification.problem.display_units import prefixed
from verification.running.case_result import message_of
from verification.running.json_records import encode

FEW = 30  # patches in contact, of which a pressure is hardly resolved


@with_exit_code
@threadpool_limits.wrap(limits=1)
def surface(
    file: Path,
    /,
    *,
    load: str,
    substrate: str,
    ball: str | None = None,
    coating: Annotated[list[str] | None, Parameter(negative="")] = None,
    friction: float = 0.0,
    unit: str | None = None,
    size: str | None = None,
    turn: Flag = False,
    materials: MaterialsFile = SHIPPED_MATERIALS,
    plot: Path | None = None,
    as_json: AsJson = False,
) -> int:
    """Press a measured surface on a coated body: pressure, real area of contact, largest stresses.

    Args:
        file: A map of heights that SurfaceTopography reads: SDF, X3P, SUR, OPD, GWY, NPY and thirty more.
        load: "20 mN".
        substrate: "E, NU", or the name of a material, as of coatcheck solve.
        ball: Solid of the measured body, "100Cr6" or "210 GPa, 0.3"; rigid without. With a size, "100Cr6
            d = 6 mm", the map is the roughness of that ball.
        coating: As of coatcheck solve, from the surface down.
        friction: Coefficient f; the measured body slides in +x.
        unit: Of lengths and heights, where the file has none: um.
        size: "100 um", of the map's side along x, where the file has none.
        turn: Turn the map upside down: its low points are pressed.
        plot: Write heights and pressure as FILE.png, FILE.pdf or FILE.svg.
    """
    if plot is not None:
        from verification.desk.measured.surface_figure import write

        require_format(plot, "--plot")
    length = None if size is None else metres("--size", size)
    found = read_map(file, unit, length, turned=turn)
    case, radius = _problem(found, ball, load, substrate, coating or [], friction, materials)
    found = found if radius is None else found.on_ball(radius)
    if found.is_bowl:
        bend, share = found.curvature
        raise CommandError(
            f"{file}: is it upside down? {share:.0%} of its heights are a bowl of radius "
            f"{prefixed(-1 / bend, 'm', 3)}, whose rim would touch first; turn it over by --turn"
        )
    try:
        contact = pressed(found, case)
    except NotConverged as error:
        if "rim" in str(error):
            raise no_result(
                f'{file}: the contact reaches the rim of the map; give the ball below it, --ball "d = 6 mm", '
                "lower the load, or turn a map that is upside down by --turn"
            ) from None
        raise no_result(f"{file}: {message_of(error)}") from None
    except ValueError as error:
        raise no_result(f"{file}: {message_of(error)}") from None
    told = _warnings(found, contact)
    print_warnings(told, file.name, strict=False, silent=as_json)
    modes = layer_modes(case.problem, contact.answer, strengths_of(case.limits), loads=False)
    judged = [*filter(None, [verdict(case, modes)]), *(f"Remark: {line}." for line in case.remarks)]
    said = [*_orientation(found), "", sentence(found, case, contact), *judged]
    if plot is not None:
        write(found, contact, f"{file.name}: {stack(case)}", units_of(case.problem), plot)
    if as_json:
        area = dict(zip(("value", "uncertainty"), contact.area, strict=True))
        print_json({"said": said, "warnings": told, "real_area": area, "answer": encode(contact.answer)})
    else:
        _print(case, contact, said)
    return 0


def _problem(
    found: SurfaceMap,
    ball: str | None,
    load: str,
    substrate: str,
    coatings: list[str],
    friction: float,
    materials: Path,
) -> tuple[Case, float | None]:
    """The bodies and the load as a case, and the radius of the ball that carries the map, if it has one."""
    words: dict[str, Any] = {"coatings": coatings, "friction": friction, "materials": materials}
    # a body without a size has that of the ball which spans the map, for the scales of what is shown
    spanned = float(found.half_width**2 / (2 * np.ptp(found.heights)))
    bends = f"{spanned!r}, {spanned!r}"
    tried: list[tuple[str, dict[str, Any]]]
    tried = [(ball, {"radii": bends}), (ball, {})] if ball else [(repr(spanned), {})]
    told = []
    for body, sized in tried:
        try:
            text = case_text(body, load, substrate, **words, **sized)
            case = parse_case(text.encode("utf-8", errors="replace"), Path("options"))
        except ValueError as error:
            told.append(str(error))
        else:
            return case, None if sized or not ball else case.problem.radius
    raise CommandError(told[0] if ball and not any(map(str.isdigit, ball)) else told[-1])


def _orientation(found: SurfaceMap) -> list[str]:
    """The map as it is pressed, in words and as characters."""
    bend, share = found.curvature
    i, j = divmod(int(found.heights.argmax()), found.heights.shape[1])
    place = f"x = {found.x[i] / 1e-6:.4g} um, y = {found.y[j] / 1e-6:.4g} um of its middle"
    sides = " x ".join(prefixed(float(n[-1] - n[0] + n[1] - n[0]), "m", 4) for n in (found.x, found.y))
    shape = (
        f"; {share:.0%} of it is a hill of radius {prefixed(1 / bend, 'm', 3)}"
        if share > 0.5 and bend > 0
        else ""
    )
    return [
        f"map of {found.x.size} x {found.y.size} points, {sides}, unit of the file {found.unit}; a plane of "
        f"{found.tilt / 1e-6:.3g} um was taken off",
        f"heights count out of the measured body: the highest (@) touch first, at {place}; from lowest to "
        f"highest {prefixed(float(np.ptp(found.heights)), 'm', 3)}, skewness "
        f"{found.skewness:.2g}{shape}",
        *found.shades(),
    ]


def sentence(found: SurfaceMap, case: Case, contact: SurfaceContact) -> str:
    """Peak pressure, real area and the largest stresses in words."""
    units = units_of(case.problem)
    p0, U = contact.answer.numbers["peak_pressure"]
    assert U is not None
    area, U_area = contact.area
    share = area / (2 * found.half_width) ** 2
    square = units.metre**2
    worst = {}
    for quantity, name in (("sigma_1", "Largest tension"), ("von_mises", "Largest von Mises stress")):
        at = max(
            (one for one in contact.answer.extremes if one.quantity == quantity), key=lambda one: one.value
        )
        where = body_label(case.problem, at.body, at.where)
        worst[name] = (
            f"{name}: {units.shown_stress(at.value)} ± {units.shown_stress(at.uncertainty)}, in {where}."
        )
    return (
        f"Peak pressure {units.shown_stress(p0)} ± {units.shown_stress(U)}. Real area of contact "
        f"{area / square:.4g} ± {U_area / square:.2g} {units.length}², {share:.2%} of the map, "
        f"{contact.solution.diagnostics.patches} patches. " + " ".join(worst.values())
    )


def _warnings(found: SurfaceMap, contact: SurfaceContact) -> list[str]:
    patches, side = contact.solution.diagnostics.patches, contact.solution.diagnostics.patches_per_side
    told = []
    if found.filled:
        told.append(f"{found.filled} points without data have the height of their nearest neighbour")
    if side < min(found.heights.shape):
        told.append(
            f"solved on {side} x {side} patches, coarser than the map; crop it to see its finest asperities"
        )
    if found.x.size != found.y.size:
        told.append(f"a square of {prefixed(2 * found.half_width, 'm', 4)} about the middle is pressed")
    if patches < FEW:
        told.append(f"{patches} patches are in contact: give a higher load, or a finer map")
    return told


def _print(case: Case, contact: SurfaceContact, said: list[str]) -> None:
    units = units_of(case.problem)
    table = named_table(
        "largest", "place", units.stress, f"± {units.stress}", *(f"{c} {units.length}" for c in "xyz")
    )
    for at in contact.answer.extremes:
        places = (f"{value / units.metre:.3g}" for value in (at.x, at.y, at.z))
        shown = value_text(at.value / units.pascal, at.uncertainty / units.pascal)
        where = body_label(case.problem, at.body, at.where)
        table.add_row(at.quantity, where, shown, spread_text(at.uncertainty, units.pascal), *places)
    print_out(escape(stack(case)), "", *map(escape, said), "", *map(escape, described(case)[1:]), "", table)
    print_out("", f"tension positive, z into each body; time: {contact.answer.seconds:.1f} s")
