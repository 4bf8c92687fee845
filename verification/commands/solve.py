"""coatcheck solve: the answer to one problem, in units of its size."""

import math
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter
from rich.markup import escape
from rich.table import Column, Table
from threadpoolctl import threadpool_limits

from verification.cases.case_file import Case, default_cases, parse_case, read_case
from verification.cases.materials import SHIPPED as SHIPPED_MATERIALS
from verification.cases.plausibility import refused
from verification.cases.toml_file import NO_SOURCE, load_toml
from verification.cases.unit_numbers import is_of
from verification.commands.common.answer_words import planes_text, spread_text, value_text
from verification.commands.common.command_error import CommandError, no_result
from verification.commands.common.known_folders import require_format
from verification.commands.common.named_files import SHIPPED, path_of
from verification.commands.common.shared_options import AsJson, Flag, MaterialsFile, Strict
from verification.commands.common.terminal import (
    paragraph,
    print_error,
    print_json,
    print_out,
    print_warnings,
    with_exit_code,
)
from verification.commands.common.terminal_bar import progress_bar, require_gmsh
from verification.credibility.model_error import ModelError, model_error
from verification.desk.case_wording import case_text, metres
from verification.desk.contact_answer import (
    AnswerDifference,
    ContactAnswer,
    agreement,
    answer,
    differences,
    summary,
    symbol_and_unit,
    usual_seconds,
    with_slicing,
)
from verification.desk.layer_limits import (
    MODES,
    LayerMode,
    limit_warnings,
    modes_of,
    place_name,
    strain_warnings,
    unusual,
    verdict,
)
from verification.desk.many_layers import worst_of_each
from verification.desk.material_spread import Spread, ranges_of
from verification.desk.material_spread import spread as material_spread
from verification.desk.stack_text import body_label, described, outside_verified, stack, units_of
from verification.desk.table_file import FORMATS as TABLE_FORMATS
from verification.desk.table_file import answer_rows, write_cells
from verification.judging.outcome import Outcome
from verification.problem.display_units import prefixed
from verification.problem.point_answers import FLAT
from verification.regression.run_exit_codes import EXIT
from verification.running.case_result import describe, message_of
from verification.running.json_records import encode
from verification.sources.source_registry import METHODS

METHOD, SECOND = METHODS


@with_exit_code
@threadpool_limits.wrap(limits=1)  # the matrices are small: more threads wait for each other
def solve(
    file: str | None = None,
    /,
    *,
    ball: str | None = None,
    radii: str | None = None,
    roller: str | None = None,
    against: str | None = None,
    load: str | None = None,
    approach: str | None = None,
    coating: Annotated[list[str] | None, Parameter(negative="")] = None,
    substrate: str | None = None,
    friction: float | None = None,
    ball_coating: Annotated[list[str] | None, Parameter(negative="")] = None,
    check: Flag = False,
    every: Annotated[bool, Parameter(name="--all", negative="")] = False,
    materials: MaterialsFile = SHIPPED_MATERIALS,
    spread: Flag = False,
    thickness_of_sample: str | None = None,
    temperature_change: float | None = None,
    plot: Path | None = None,
    csv: Path | None = None,
    force: Flag = False,
    strict: Strict = False,
    as_json: AsJson = False,
) -> int:
    """Solve one problem: size of the contact, largest stresses, their places.

    The semi-analytical method answers. The exit code is 1 where --check finds a difference beyond both
    uncertainties, and 3 where nothing is solved or the finite elements refuse to check the answer shown.

    Args:
        file: A case file (.toml) or the name of a shipped case; or give the problem by options.
        ball: "RADIUS" of a rigid ball, "RADIUS, E, NU" of an elastic one: "10 mm, 210 GPa, 0.3"; the size may
            also be "d = DIAMETER".
        radii: "R_X, R_Y" of a body that is no ball, such as "3.8 mm, 183 mm"; --ball then is its solid alone,
            "210 GPa, 0.3" or "100Cr6". A concave surface has a negative radius.
        roller: "R = 5 mm, crown 2 m" of a roller that rolls along x, in place of --radii "5 mm, 2 m"; --ball
            is its solid likewise.
        against: "R_X, R_Y" of the body with the substrate where it is not flat: "18 mm, -4.9 mm" of a race
            with its groove; "flat" along an axis without curvature.
        load: "20 N"; bare numbers are SI here and in all other options.
        approach: "0.5 um" in place of the load: of distant points of both bodies.
        coating: "THICKNESS, E, NU", such as "3 um, 450 GPa, 0.22"; once for each, from the surface down. A
            name may come first, strengths may follow: "TiN 3 um, 450 GPa, 0.25, strength 2 GPa,
            residual -1.5 GPa, adhesion 400 MPa, yield 9 GPa". Many layers: "10 x (A 100 nm, ... / B ...)".
        substrate: "E, NU", such as "210 GPa, 0.3" or "steel 210 GPa, 0.3, yield 2 GPa"; likewise a ball.
        friction: Coefficient f; the ball slides in +x, and the trailing edge is at x < 0.
        ball_coating: The same of a coating on the ball, from its surface inwards.
        check: Solve by finite elements too and show their difference.
        every: Show every layer of a stack of many, not the worst of each material alone.
        spread: Show how far the answer moves over the ranges of the materials given by name.
        thickness_of_sample: "5 mm", coatings included: what half-spaces cost is told for it, not for a disc
            as thick as the radius of the ball.
        temperature_change: Since deposition [K], -400 after cooling; with "expansion 9e-6" [1/K] of coating
            and substrate it gives the stress of their mismatch, which adds to a residual stress of growth.
        plot: Write a figure of the stresses, FILE.png, FILE.pdf or FILE.svg.
        csv: Write every number of the answer in SI units, FILE.csv or FILE.xlsx.
        force: Solve although a number looks like a slip of its unit.
    """
    begin = time.perf_counter()
    given = {
        "ball": ball,
        "radii": radii,
        "roller": roller,
        "against": against,
        "load": load,
        "approach": approach,
        "coatings": coating,
        "substrate": substrate,
        "friction": friction,
        "on_ball": ball_coating,
        "temperature_change": temperature_change,
    }
    if force and file is not None and is_of("N", file):
        raise CommandError(f'--force takes no value, it confirms implausible numbers; give --load "{file}"')
    case = _from_file(file, given) if file is not None else _from_options(given, materials)
    if plot is not None:
        from verification.desk.answer_figure import write

        require_format(plot, "--plot")
    if csv is not None:
        require_format(csv, "--csv", TABLE_FORMATS)
    sample = _sample(case, thickness_of_sample)
    ranges = ranges_of(case, materials)
    if spread and not ranges:
        raise CommandError(
            f"{case.name}: --spread: no material given by name has a range in {materials}; copy that file, "
            "give the material low and high beside E, and name the copy with --materials"
        )
    if not force:
        for line in refused(case.problem):
            raise CommandError(f"{case.name}: {line}; correct it, or solve it as it is with --force")
    print_warnings(case.warnings, case.name, strict=strict, silent=as_json)
    if check:
        require_gmsh()
    with _working("semi-analytical", as_json):
        first = _answer(case, METHOD)
    fewer = [parse_case(case.text.encode(), Path(case.name), over) for over in (2, 4) if case.layers]
    with _working("fewer sub-layers", as_json or not fewer):
        coarser = tuple(_answer(one, METHOD) for one in fewer)
    halved = differences(first, coarser[0]) if coarser else ()
    stated = with_slicing(first, coarser)
    second, refusal = None, ""
    if check:
        if not as_json:
            print_error(f"finite elements: about {usual_seconds(case.problem):.0f} s of processor time")
        with _working("finite elements", as_json):
            try:
                second = _answer(case, SECOND)
            except CommandError as error:
                why = str(error).removeprefix(f"{case.name}: {SECOND}: ")
                refusal = f"Not checked, as the finite elements refuse this contact: {why}"
        if refusal:
            print_error(f"{case.name}: {refusal}")
    with _working("loads at which something fails", as_json or not case.limits):
        modes = modes_of(case, first)
    late = [*limit_warnings(case, first, modes), *strain_warnings(case, first)]
    print_warnings(late, case.name, strict=strict, silent=as_json)
    spreaded = None
    if spread:
        with _working("ranges of the materials", as_json):
            spreaded = material_spread(case, first, ranges, case.numerics.get(METHOD, {}))
    with _working("error of the model", as_json):
        beyond = model_error(case.problem, sample=sample)
    costs = beyond.warnings(told=case.warnings)
    print_warnings(costs, case.name, strict=strict, silent=as_json)
    apart = differences(first, second) if second is not None else ()
    remarks = [*case.remarks, *unusual(case, first)]
    if ranges and not spread:
        remarks.append(f"{', '.join(one.words for one in ranges)}: see what follows with --spread")
    if csv is not None:
        write_cells(csv, answer_rows(case, stated, spreaded))
    if plot is not None:
        write(case, stated, plot)
    if as_json:
        content = {  # NaN of a place that does not exist as text
            "title": case.title,
            "units": {"length": "m", "stress": "Pa", "force": "N"},
            "given": "load" if case.approach is None else {"approach": case.approach},
            "source": case.source,
            "problem": describe(case.problem),
            "residual_stress": case.residual,
            "case_file": case.text,
            "warnings": [*case.warnings, *late, *costs],
            "remarks": remarks,
            "model_error": {"message": beyond.message(), **encode(beyond)},
            "spread": spreaded and spreaded.as_json,
            "answer": encode(stated),
            "verdict": verdict(case, modes),
            "modes": [encode(one) | {"utilisation": one.utilisation} for one in modes],
            "check": second and encode(second),
            "check_refused": refusal,
            "differences": [encode(one) for one in apart],
            "half_of_the_sublayers": [encode(one) for one in halved],
        }
        print_json(content)
    else:
        told = (
            *(f"Remark: {line}." for line in remarks),
            agreement(stated, apart),
            refusal and f"{refusal}.",
        )
        _print(case, stated, apart, halved, modes, told, spreaded, every=every)
        hint = "; compared here by --check" if second else "" if check else "; try --check"
        _print_model(case, beyond, hint, checked=check)
        elements = f", finite elements {second.seconds:.1f} s" if second else ""
        total = time.perf_counter() - begin
        print_out(f"time: semi-analytical {first.seconds:.1f} s{elements}; in all {total:.1f} s")
    if refusal:
        return EXIT[Outcome.NO_RESULT]
    agree = all(difference.within for difference in apart)
    return EXIT[Outcome.AGREES if agree else Outcome.DISAGREES]


@contextmanager
def _working(what: str, silent: bool) -> Iterator[None]:
    """A bar with the time that ``what`` takes."""
    with progress_bar(silent=silent) as bar:
        bar.add_task(what, total=1)
        yield


def _from_file(file: str, given: Mapping[str, Any]) -> Case:
    if any(one is not None for one in given.values()):
        both = f"{file}: give a file or the options of a problem, not both"
        quote = '; quote what belongs to one option, as in --radii "3.8 mm, 183 mm"'
        raise CommandError(both if Path(file).exists() else both + quote)
    case = read_case(path_of(file, default_cases(), SHIPPED))
    if case.problem.indenter is not None and not case.problem.elliptical:
        raise CommandError(
            f"{file}: problem.indenter: solve answers for balls and ellipsoids; try coatcheck run {file}"
        )
    return case


def _from_options(given: Mapping[str, Any], materials: Path) -> Case:
    needed = {
        "--ball, --radii or --roller": ("ball", "radii", "roller"),
        "--load or --approach": ("load", "approach"),
        "--substrate": ("substrate",),
    }
    missing = [options for options, keys in needed.items() if not any(given[key] for key in keys)]
    if missing:
        asked = ", ".join([*missing[:-1], f"and {missing[-1]}" if missing[1:] else missing[-1]])
        raise CommandError(f"give {asked}, or a case file alone; see coatcheck solve --help")
    stated = {key: one for key, one in given.items() if one is not None}
    try:
        text = case_text(**{"ball": None, "load": None, **stated}, materials=materials)
    except ValueError as error:
        raise CommandError(str(error)) from None
    return parse_case(text.encode("utf-8", errors="replace"), Path("options"))


def _sample(case: Case, thickness: str | None) -> float | None:
    """The thickness of the sample [m]."""
    if thickness is None:
        return None
    value = metres("--thickness-of-sample", thickness)
    coated = sum(h for *_, h in case.problem.coatings)
    if not coated < value < math.inf:
        shown = prefixed(coated, "m") if coated else "0"
        raise CommandError(
            f"--thickness-of-sample = {thickness}; it has to be above {shown}, its coatings included"
        )
    return value


def _answer(case: Case, source: str) -> ContactAnswer:
    try:
        return answer(case.problem, source, case.numerics.get(source), case.residual, case.layers)
    except Exception as error:  # as of any solve
        raise no_result(f"{case.name}: {source}: {message_of(error)}") from None


def _limits(case: Case, modes: Sequence[LayerMode]) -> Table:
    """How near each place that has a strength is to failing."""
    units = units_of(case.problem)
    heads = (units.stress, f"strength {units.stress}", "used", "safety", f"from {units.force}")
    table = _table(("limit",), heads)
    for one in sorted(modes, key=lambda one: -one.utilisation):
        begins = "-" if one.load is None else f"{one.load / units.newton:.3g}"
        stresses = (f"{stress / units.pascal:.4g}" for stress in (one.stress, one.strength))
        style = "bold red" if one.utilisation > 1 else ""
        name = escape(f"{place_name(case, one)} {MODES[one.quantity][0]}")
        table.add_row(name, *stresses, f"{one.utilisation:.0%}", f"{one.safety:.3g}", begins, style=style)
    return table


def _table(words: Sequence[str], figures: Sequence[str]) -> Table:
    """A table with columns of ``words`` and of right-aligned ``figures``."""
    right = (Column(head, justify="right", no_wrap=True) for head in figures)
    return Table(*words, *right, box=None, header_style="bold", pad_edge=False)


def _print(
    case: Case,
    first: ContactAnswer,
    apart: Sequence[AnswerDifference],
    halved: Sequence[AnswerDifference],
    modes: tuple[LayerMode, ...],
    told: Sequence[str],
    spread: Spread | None,
    *,
    every: bool,
) -> None:
    besides = {"elements − this": apart, "half the sub-layers − this": halved}
    more = {head: {one.key: one for one in found} for head, found in besides.items() if found}
    units = units_of(case.problem)
    decimals = max(2, 3 - math.floor(math.log10(first.numbers["contact_radius"][0] / units.metre)))

    def beside(key: tuple[str, ...], unit: float) -> list[str]:
        shown = {head: f"{found[key].value / unit:+.1e}" for head, found in more.items()}
        beyond = apart and not more["elements − this"][key].within
        return [f"[bold red]{s}[/]" if beyond and h.startswith("elements") else s for h, s in shown.items()]

    extremes = first.extremes if every else worst_of_each(case, first.extremes)
    fewer = len(extremes) < len(first.extremes)
    between = ("lowest", "highest") if spread else ()
    numbers = _table(("contact", "unit"), ("value", "±", *more, *between))
    axes = "xyz" if case.problem.elliptical else "xz"
    along = (f"{axis} {units.length}" for axis in axes)
    shown_in = (units.stress, f"± {units.stress}", *along, *between)
    table = _table(("largest", "place"), (*shown_in, *(f"{head} {units.stress}" for head in more)))
    for name, (value, stated) in first.numbers.items():
        symbol, si = symbol_and_unit(name)
        unit, scale = (units.stress, units.pascal) if si == "Pa" else (units.length, units.metre)
        cells = [value_text(value / scale, stated and stated / scale), spread_text(stated, scale)]
        ends = [f"{end / scale:.4g}" for end in spread.ends[name,]] if spread else []
        numbers.add_row(symbol, unit, *cells, *beside((name,), scale), *ends)
    body = FLAT
    for at in extremes:
        if at.body != body:
            table.add_row("")
            body = at.body
        where = body_label(case.problem, at.body, at.where)
        key = (at.body, at.quantity, at.where)
        rounded = (round(getattr(at, axis) / units.metre, decimals) + 0.0 for axis in axes)  # no -0
        places = ["-" if math.isnan(at.x) else f"{s:.{decimals}f}" for s in rounded]
        shown = [value_text(at.value / units.pascal, at.uncertainty / units.pascal)]
        shown.append(spread_text(at.uncertainty, units.pascal))
        ends = [f"{end / units.pascal:.4g}" for end in spread.ends[key]] if spread else []
        table.add_row(at.quantity, where, *shown, *places, *ends, *beside(key, units.pascal))
    said = (
        summary(case.problem, first, case.names),
        verdict(case, modes),
        spread.sentence(case, modes) if spread else "",
        *told,
    )
    print_out(
        f"[bold]{escape(case.title)}[/]",
        escape(stack(case)),
        "",
        *(escape(line) for text in said for line in paragraph(text)),
        "",
        *(escape(line) for line in described(case, every=every)),
        "",
        numbers,
        "",
        table,
        "",
        f"tension positive, in the plane{planes_text(case.problem)}, z into each body",
        *(["the worst of each material and interface; all with --all"] if fewer else []),
    )
    if modes:
        print_out("", _limits(case, modes if every else worst_of_each(case, modes)), "")
    if halved:
        print_out("± contains the slicing: at least the change by half the sub-layers, in the plane thrice")


def _print_model(case: Case, beyond: ModelError, hint: str, *, checked: bool) -> None:
    """Prints what the answer is good for: error of the model, range of the verification; then its source."""
    given = load_toml(case.text.encode())[1]
    if beyond.parts:
        head = "the model itself is good to"
        print_out(*map(escape, (head, *(f"  {part}" for part in beyond.parts), *beyond.notes)))
    else:
        reasons = ", ".join(dict.fromkeys(reason for _, reason in beyond.missing))
        print_out(escape(f"{beyond.message()}: {reasons}"))
    if outside := outside_verified(case):
        print_out(escape(f"beyond the range in which both methods were compared: {outside}{hint}"))
    used = (METHOD, SECOND) if checked else (METHOD,)
    unused = [key for key in ("claim", "resolve", *METHODS) if key in given and key not in used]
    if unused:
        print_out(escape(f"for coatcheck run: {', '.join(unused)}"))
    if case.residual:
        print_out(
            "with residual stress; the shear of an interface near a free edge of its coating is not covered"
        )
    if case.source != NO_SOURCE:
        print_out(*map(escape, paragraph(f"source: {case.source}")))
