"""coatcheck solve: the answer to one problem in MPa with places in um."""

import math
from collections.abc import Sequence
from pathlib import Path
from textwrap import wrap
from typing import Annotated, Any

from cyclopts import Parameter
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from verification.cases.case_file import Case, parse_case, read_case, shipped_cases
from verification.cases.plausibility import beyond_limits
from verification.commands.common.command_error import CommandError, no_result
from verification.commands.common.exit_codes import with_exit_code
from verification.commands.common.known_folders import require_format
from verification.commands.common.named_files import SHIPPED, path_of
from verification.commands.common.shared_options import AsJson, Flag, Strict
from verification.commands.common.task_progress import progress_bar, require_gmsh
from verification.commands.common.terminal import print_json, print_out, print_warnings
from verification.credibility.model.model_error import ModelError, model_error
from verification.desk.answer_summary import summary
from verification.desk.case_wording import case_text
from verification.desk.contact_answer import Answer, Difference, answer, differences
from verification.judging.outcome import Outcome
from verification.problem.coated_contact import BALL, FLAT
from verification.problem.quantity import QUANTITIES
from verification.regression.run_exit_codes import EXIT
from verification.running.case_result import describe, message_of
from verification.running.json_records import encode
from verification.sources.source_registry import METHODS

METHOD, SECOND = METHODS
COLUMNS = 79  # of the summary
DIGITS = 5  # of a value, unless its uncertainty ends before


@with_exit_code
def solve(
    file: str | None = None,
    /,
    *,
    ball: str | None = None,
    load: str | None = None,
    coating: Annotated[list[str] | None, Parameter(negative="")] = None,
    substrate: str | None = None,
    friction: float | None = None,
    ball_coating: Annotated[list[str] | None, Parameter(negative="")] = None,
    check: Flag = False,
    plot: Path | None = None,
    strict: Strict = False,
    as_json: AsJson = False,
) -> int:
    """Solve one problem: size of the contact, largest stresses in MPa, their places in um.

    The semi-analytical method answers. The exit code is 1 where --check finds a difference beyond both
    uncertainties.

    Args:
        file: A case file (.toml) or the name of a shipped case; or give the problem by options.
        ball: "RADIUS" of a rigid ball, "RADIUS, E, NU" of an elastic one: "10 mm, 210 GPa, 0.3".
        load: "20 N"; bare numbers are SI here and in all other options.
        coating: "THICKNESS, E, NU", such as "3 um, 450 GPa, 0.22"; once for each, from the surface down.
        substrate: "E, NU", such as "210 GPa, 0.3".
        friction: Coefficient f; the ball slides in +x, and the trailing edge is at x < 0.
        ball_coating: The same of a coating on the ball, from its surface inwards.
        check: Solve by finite elements too and show their difference.
        plot: Write a figure of the stresses along x, FILE.png, FILE.pdf or FILE.svg.
    """
    given = (ball, load, coating, substrate, friction, ball_coating)
    case = _from_file(file, given) if file is not None else _from_options(*given)
    if plot is not None:
        require_format(plot)
    beyond = model_error(case.problem)
    warnings = (*case.warnings, *beyond.warnings(told=case.warnings))
    print_warnings(warnings, case.name, strict=strict, silent=as_json)
    if check:
        require_gmsh()
    stages = 1 + check + bool(case.layers)
    bar = progress_bar(Console(stderr=True), silent=as_json)
    with bar:
        task = bar.add_task("semi-analytical", total=stages)
        first = _answer(case, METHOD)
        bar.update(task, advance=1, description="half of the sub-layers")
        halved = _halved(case, first)
        bar.update(task, advance=bool(case.layers), description="finite elements, ten times as long")
        second = _answer(case, SECOND) if check else None
    # Before the solve the peak pressure was that of Hertz.
    told = any(line.startswith("peak pressure") for line in case.warnings)
    late = () if told else beyond_limits(first.numbers["peak_pressure"][0], case.limits)
    print_warnings(late, case.name, strict=strict, silent=as_json)
    apart = differences(first, second) if second is not None else ()
    if plot is not None:
        from verification.desk.answer_figure import write

        write(first, case.title, plot)
    if as_json:
        print_json(_content(case, (*warnings, *late), beyond, first, second, apart, halved))
    else:
        _print(case, beyond, first, second, apart, halved)
    agree = all(difference.within for difference in apart)
    return EXIT[Outcome.AGREES if agree else Outcome.DISAGREES]


def _from_file(file: str, given: Sequence[Any]) -> Case:
    if any(one is not None for one in given):
        raise CommandError(f"{file}: give a file or the options of a problem, not both")
    return read_case(path_of(file, shipped_cases(), SHIPPED))


def _from_options(
    ball: str | None,
    load: str | None,
    coating: list[str] | None,
    substrate: str | None,
    friction: float | None,
    ball_coating: list[str] | None,
) -> Case:
    if ball is None or load is None or substrate is None:
        raise CommandError("give a case file, or --ball, --load and --substrate; see coatcheck solve --help")
    try:
        text = case_text(ball, load, substrate, coating or [], friction or 0.0, ball_coating or [])
    except ValueError as error:
        raise CommandError(str(error)) from None
    return parse_case(text.encode("utf-8", errors="replace"), Path("options"))


def _answer(case: Case, source: str) -> Answer:
    try:
        return answer(case.problem, source, case.numerics.get(source), case.residual, case.layers)
    except Exception as error:  # as of any solve
        raise no_result(f"{case.name}: {source}: {message_of(error)}") from None


def _halved(case: Case, first: Answer) -> tuple[Difference, ...]:
    """Differences by half of the sub-layers of graded coatings, which shows their error; () without."""
    if not case.layers:
        return ()
    half = parse_case(case.text.encode(), Path(case.name), over=2)
    return differences(first, _answer(half, METHOD))


def _content(
    case: Case,
    warnings: Sequence[str],
    beyond: ModelError,
    first: Answer,
    second: Answer | None,
    apart: Sequence[Difference],
    halved: Sequence[Difference],
) -> dict[str, Any]:
    """Everything, in SI; NaN of a place that does not exist as text."""
    return {
        "title": case.title,
        "source": case.source,
        "problem": describe(case.problem),
        "residual_stress": case.residual,
        "case_file": case.text,
        "warnings": list(warnings),
        "model_error": {"message": beyond.message(), **encode(beyond)},
        "answer": encode(first),
        "check": None if second is None else encode(second),
        "differences": [encode(one) for one in apart],
        "half_of_the_sublayers": [encode(one) for one in halved],
    }


def _print(
    case: Case,
    beyond: ModelError,
    first: Answer,
    second: Answer | None,
    apart: Sequence[Difference],
    halved: Sequence[Difference],
) -> None:
    gap = {difference.key: difference for difference in apart}
    coarser = {difference.key: difference for difference in halved}

    def checked(key: tuple[str, ...], unit: float) -> list[str]:
        cells = []
        if second:
            shown = f"{gap[key].value / unit:+.1e}"
            cells.append(shown if gap[key].within else f"[bold red]{shown}[/]")
        return cells + ([f"{coarser[key].value / unit:+.1e}"] if coarser else [])

    numbers = Table(box=None, header_style="bold", pad_edge=False)
    table = Table(box=None, header_style="bold", pad_edge=False)
    for head in ("contact", ""):
        numbers.add_column(head)
    for head in ("largest", "place"):
        table.add_column(head)
    more = ["elements − this"] * (second is not None) + ["half the sub-layers − this"] * bool(halved)
    for head in ("value", "±", *more):
        numbers.add_column(head, justify="right", no_wrap=True)
    for head in ("MPa", "±", "x um", "z um", *more):
        table.add_column(head, justify="right", no_wrap=True)
    for name, (value, stated) in first.numbers.items():
        unit, scale = ("MPa", 1e6) if QUANTITIES[name].unit == "Pa" else ("um", 1e-6)
        cells = [_value(value / scale, stated and stated / scale), _spread(stated, scale)]
        numbers.add_row(QUANTITIES[name].symbol, unit, *cells, *checked((name,), scale))
    body = FLAT
    for at in first.extremes:
        if at.body != body:
            table.add_row("")
            body = at.body
        where = at.where if body == FLAT else f"{body}, {at.where}"
        key = (at.body, at.quantity, at.where)
        places = ["-", "-"] if math.isnan(at.x) else [f"{at.x * 1e6:.2f}", f"{at.z * 1e6:.2f}"]
        shown = [_value(at.value / 1e6, at.uncertainty / 1e6), _spread(at.uncertainty, 1e6)]
        table.add_row(at.quantity, where, *shown, *places, *checked(key, 1e6))
    seconds = f"semi-analytical {first.seconds:.1f} s" + (
        f", finite elements {second.seconds:.1f} s" if second else ""
    )
    print_out(
        f"[bold]{escape(case.title)}[/]",
        *(escape(line) for line in _given(case)),
        "",
        *map(escape, wrap(summary(case.problem, first), COLUMNS)),
        "",
        numbers,
        "",
        table,
        "",
        f"tension positive, in the plane y = 0, x along sliding, z into each body; {seconds}",
    )
    head = "the model itself is good to" if beyond.parts else beyond.message()
    print_out(*map(escape, (head, *(f"  {part}" for part in beyond.parts), *beyond.notes)))
    if case.residual:
        print_out(
            "with residual stress; the shear of an interface near a free edge of its coating is not covered"
        )
    outside = [difference for difference in apart if not difference.within]
    if second is not None:
        total = f"{len(apart) - len(outside)} of {len(apart)} numbers of the finite elements"
        print_out(f"{total} are within both uncertainties")


def _given(case: Case) -> list[str]:
    """The problem, a line for each body, load and coating."""
    problem = case.problem

    def solid(E: float, nu: float) -> str:
        return f"E = {E / 1e9:.4g} GPa, nu = {nu:g}"

    kind = "rigid" if problem.ball is None else solid(*problem.ball[:2])
    size = f"R = {problem.radius * 1e3:.4g} mm, {kind}"
    lines = [f"ball        {size}; W = {problem.load:.4g} N, f = {problem.friction:g}"]
    for body in problem.bodies:
        seen, begin = problem.seen_from(body), 0
        for i, n in enumerate(case.layers.get(body) or (1,) * len(seen.coatings), start=1):
            layers, on = seen.coatings[begin : begin + n], "coating" if body == FLAT else f"on the {BALL}"
            stress = sorted(case.residual[body][begin : begin + n]) if case.residual else [0.0]
            (E, nu, _), last = layers[0], layers[-1][0]
            course = f", E to {last / 1e9:.4g} GPa in {n} sub-layers" if n > 1 else ""
            more = f", residual stress {_range(stress[0] / 1e6, stress[-1] / 1e6)} MPa" if any(stress) else ""
            lines.append(
                f"{on} {i}   "[:12]
                + f"{sum(h for *_, h in layers) * 1e6:.4g} um, {solid(E, nu)}{course}{more}"
            )
            begin += n
        if body == FLAT:
            lines.append(f"substrate   {solid(*seen.substrate)}")
    return lines


def _range(low: float, high: float) -> str:
    return f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"


def _value(value: float, spread: float | None) -> str:
    """``value`` in at most DIGITS digits, and in none beyond the first of its uncertainty."""
    if value == 0:
        return "0"
    decimals = DIGITS - 1 - math.floor(math.log10(abs(value)))
    if spread and math.isfinite(spread):
        decimals = min(decimals, -math.floor(math.log10(spread)))
    return f"{value:.{max(decimals, 0)}f}"


def _spread(stated: float | None, scale: float) -> str:
    return "-" if stated is None or math.isnan(stated) else f"{stated / scale:.0e}"
