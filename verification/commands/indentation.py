"""coatcheck indentation: the modulus of a film from a measured curve."""

import re
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter
from rich.markup import escape
from threadpoolctl import threadpool_limits

from verification.cases.case_file import Case, parse_case
from verification.cases.materials import SHIPPED as SHIPPED_MATERIALS
from verification.cases.plausibility import beyond_limits
from verification.cases.unit_numbers import in_si
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
from verification.desk.case_wording import case_text
from verification.desk.indented.film_modulus import KINDS, FilmFit, film_modulus
from verification.desk.indented.indentation_curve import IndentationCurve, read_curve
from verification.problem.display_units import prefixed
from verification.running.case_result import message_of

UNKNOWN = re.compile(r"(,\s*)\?(?=\s*(?:,|$))")


@with_exit_code
@threadpool_limits.wrap(limits=1)
def indentation(
    file: Path,
    /,
    *,
    ball: str,
    coating: Annotated[list[str], Parameter(negative="")],
    substrate: str,
    by: Literal["depth", "stiffness", "radius", "punch"] | None = None,
    depths: str | None = None,
    zero: Flag = False,
    beta: float = 1.0,
    materials: MaterialsFile = SHIPPED_MATERIALS,
    plot: Path | None = None,
    as_json: AsJson = False,
) -> int:
    """Find the modulus of a film from load and depth, stiffness or contact radius: elastic part only.

    Args:
        file: CSV or XLSX whose heads name quantity and unit: "load [mN]", "depth [nm]", "stiffness [N/m]",
            "contact radius [nm]"; "sd depth [nm]" and the like are standard deviations.
        ball: The tip, as of coatcheck solve: "diamond 5 um, 1141 GPa, 0.07".
        coating: As of coatcheck solve, from the surface down; the modulus to be found is a question mark:
            "film 1 um, ?, 0.25".
        substrate: "E, NU", or the name of a material.
        by: What is fitted over the load, by default the first that the file has; "punch" is the stiffness
            over the contact radius, whatever the shape of the tip (a Berkovich tip's imprint too).
        depths: Rows to use, "12 nm, 100 nm": beyond the rounded tip, short of yielding.
        zero: Fit the depth of first contact too.
        beta: Factor of the stiffness of a tip that is not round, 1.034 of Berkovich.
        plot: Write a figure of curve and fit, FILE.png, FILE.pdf or FILE.svg.
    """
    if plot is not None:
        from verification.desk.indented.indentation_figure import write

        require_format(plot, "--plot")
    curve = read_curve(file, _depths(depths))
    kind: str = by or next((one for one in KINDS if set(KINDS[one]) <= curve.values.keys()), "depth")
    if zero and kind != "depth":
        raise CommandError(f"--zero is that of the depth: leave it out where the {KINDS[kind][0]} is fitted")
    if missing := set(KINDS[kind]) - curve.values.keys():
        raise CommandError(f"{file}: --by {kind} requires the column {' and '.join(sorted(missing))}")
    load = float(curve.values["load"].max()) if "load" in curve.values else 1e-3
    case, film = _problem(ball, coating, substrate, load, materials)
    try:
        fit = film_modulus(case.problem, film, curve, kind, beta, zero=zero)
    except (ValueError, ArithmeticError) as error:
        raise no_result(f"{file}: {message_of(error)}") from None
    told = _warnings(case, film, curve, fit)
    print_warnings(told, file.name, strict=False, silent=as_json)
    if plot is not None:
        write(fit, sentence(case, film, fit), plot)
    if as_json:
        numbers = ("kind", "E", "low", "high", "rms", "zero", "inputs", "correlation", "radius", "peak")
        content = {name: getattr(fit, name) for name in numbers} | {"rows": fit.x.size, "warnings": told}
        print_json({key: None if value != value else value for key, value in content.items()})
    else:
        _print(case, film, curve, fit)
    return 0


def _depths(given: str | None) -> tuple[float, float]:
    """The range of depths [m]."""
    if given is None:
        return 0.0, float("inf")
    try:
        low, high = (in_si(part.strip(), "m") for part in given.split(","))
    except ValueError as error:
        raise CommandError(
            f'--depths "{given}": give two with their units, "12 nm, 100 nm" ({error})'
        ) from None
    if not low < high:
        raise CommandError(f'--depths "{given}": the first has to be below the second')
    return low, high


def _problem(ball: str, coating: list[str], substrate: str, load: float, materials: Path) -> tuple[Case, int]:
    """The problem at the largest load with the substrate's modulus as that of the film; the film's number."""
    unknown = [i for i, one in enumerate(coating) if UNKNOWN.search(one)]
    if len(unknown) != 1 or len(UNKNOWN.findall(coating[unknown[0]])) != 1 or "(" in coating[unknown[0]]:
        raise CommandError(
            '--coating: give one film with a question mark for its modulus, "film 1 um, ?, 0.25"'
        )
    try:
        bare = parse_case(
            case_text(ball, f"{load!r}", substrate, materials=materials).encode(), Path("options")
        )
        E = f"{bare.problem.substrate[0]!r}"
        words = [UNKNOWN.sub(rf"\g<1>{E}", one) for one in coating]
        text = case_text(ball, f"{load!r}", substrate, words, materials=materials)
    except ValueError as error:
        raise CommandError(str(error)) from None
    case = parse_case(text.encode(), Path("options"))
    if len(case.problem.coatings) != len(coating):
        raise CommandError("--coating: give each layer by itself, without repeats")
    return case, unknown[0]


def _name(case: Case, film: int) -> str:
    return case.names["flat"][film] or f"coating {film + 1}"


def sentence(case: Case, film: int, fit: FilmFit) -> str:
    """The modulus with its interval in words."""
    nu = case.problem.coatings[film][1]
    if not fit.determined:
        return (
            f"The curve does not determine E of {_name(case, film)}: anything from "
            f"{prefixed(fit.low, 'Pa', 3)} to {prefixed(fit.high, 'Pa', 3)} fits."
        )
    ends = " to ".join(prefixed(one, "Pa", 4) for one in (fit.low, fit.high))
    plane = prefixed(fit.E / (1 - nu**2), "Pa", 4)
    return (
        f"E of {_name(case, film)}: {prefixed(fit.E, 'Pa', 4)}, 95 % interval {ends} by the scatter of "
        f"{fit.x.size} rows, with nu = {nu:g}; E/(1 - nu^2) = {plane}."
    )


def _warnings(case: Case, film: int, curve: IndentationCurve, fit: FilmFit) -> list[str]:
    """Warnings on what casts doubt on the fit, a line each."""
    found = [line for line in case.warnings if line.startswith("contact radius") and fit.kind != "punch"]
    if fit.peak == fit.peak:
        found += beyond_limits(fit.peak, case.limits)
    if fit.correlation > 0.5:
        more = ", or fit the first contact by --zero" if fit.kind == "depth" and not fit.zero else ""
        found.append(
            f"the residuals follow each other (correlation {fit.correlation:.2f}): the model misses the "
            f"curve's course; look at --plot, choose elastic rows by --depths{more}"
        )
    if not fit.determined:
        found.append("press until the contact is about as wide as the film is thick, or measure more rows")
    if curve.unused:
        found.append(f"columns not used: {', '.join(curve.unused)}")
    return found


def _print(case: Case, film: int, curve: IndentationCurve, fit: FilmFit) -> None:
    h = case.problem.coatings[film][2]
    of = KINDS[fit.kind][0]
    what = "stiffness over contact radius" if fit.kind == "punch" else f"{of} over load"
    share = fit.rms / float(abs(fit.y).mean())
    out = f", {curve.left_out} rows left out" if curve.left_out else ""
    unit = {"stiffness": "N/m"}.get(of, "m")
    lines = [
        sentence(case, film, fit),
        f"Fitted: {what}; residuals {prefixed(fit.rms, unit, 3)} rms, {share:.2%} of the mean{out}.",
        f"At the last row: a = {prefixed(fit.radius, 'm', 3)}, {fit.radius / h:.2g} of the film's thickness"
        + (f"; p0 = {prefixed(fit.peak, 'Pa', 3)}." if fit.peak == fit.peak else "."),
    ]
    if fit.zero:
        lines.append(f"First contact at a depth of {fit.zero / 1e-9:.3g} nm of the file.")
    table = named_table("1 % more of", "changes E by")
    for name, change in sorted(fit.inputs.items(), key=lambda pair: -abs(pair[1])):
        table.add_row(name, f"{100 * change:+.2f} %")
    elastic = "elastic part only: yielding, pile-up or adhesion bias E; the interval has the scatter alone"
    print_out(*map(escape, lines), "", table, "", elastic)
