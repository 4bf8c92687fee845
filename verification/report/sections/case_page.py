"""Page of one case: problem, numbers of the contact, figures, all comparisons, statements of its sources."""

import shlex
from pathlib import PurePath
from typing import Any

from verification.cases.case_file import default_cases
from verification.cases.published_file import published_cases
from verification.judging.verdict import Outcome
from verification.page.number_text import scientific
from verification.page.source_labels import OUTCOMES, pair_style, source_label, source_style, symbol_of
from verification.page.symbol_text import typeset
from verification.problem.point_answers import BALL
from verification.report.figures.field_pictures import pictures
from verification.report.figures.line_panels import case_figures
from verification.report.figures.problem_sketch import sketch
from verification.report.figures.verdict_strips import case_strips, items_of, ordered
from verification.report.report_material import ReportMaterial
from verification.report.report_words import stated
from verification.report.sections import invariants_section, published_section
from verification.report.tables.case_lookup import contact_radius, divisor, layers, scale, slug
from verification.report.tables.case_tables import (
    budget_table,
    comparison_table,
    contact_tables,
    diagnostics_table,
    facts,
    failing_table,
    layer_table,
    stress_table,
)
from verification.report.tables.line_csv import line_csv
from verification.running.case_result import CaseResult


def contents(material: ReportMaterial, result: CaseResult, anchor: str) -> dict[str, Any]:
    """Content of the template of a case under its ``anchor``."""
    problem, verdicts, file = result.problem, result.verdicts, slug(result.name)
    a_h, p_h = scale(problem, "a_h"), scale(problem, "p_h")
    radius, ball = contact_radius(result), layers(problem, BALL)
    common = {
        "anchor": anchor,
        "result": result,
        "outcome": OUTCOMES[result.outcome],
        "summary": summary(result),
        "command": rerun_command(result.name, material.info.command),
        "facts": facts(problem),
        "failures": [(source_label(s.source), s.failure) for s in result.sources if s.failure is not None],
        "layers": [layer_table(result), *([layer_table(result, BALL)] if ball else [])],
        "failing": failing_table(verdicts, a_h),
        "budget": budget_table(result),
        "diagnostics": diagnostics_table(result.sources),
    }
    if result.published:
        tables = published_section.tables(result)
        return common | {"tables": tables, "comparisons": comparison_table(verdicts)}
    designed = material.evidence.designed.get(result.name)
    broken = [one for one in result.invariants if one.outcome is not Outcome.AGREES]
    return common | {
        "file": file,
        "contact": contact_tables(result),
        "strips": case_strips(items_of(verdicts), anchor),
        "sketch": sketch(problem, radius),
        "pictures": pictures(material.planes.get(result.name), a_h, p_h, result.name),
        "figures": case_figures(result),
        "beyond": material.evidence.beyond.get(result.name, ()),
        "maps": material.evidence.maps is not None,
        "model": material.evidence.models.get(result.name),
        "residual": bool(result.stated.get("residual")),
        "designed": designed,
        "stresses": stress_table(result, designed) if designed else None,
        "files": [
            (line, line_csv(result.profiles, line), f"{file}-{slug(line)}.csv")
            for line in dict.fromkeys(profile.line for profile in result.profiles)
        ],
        "broken": invariants_section.invariant_table(broken),
        "invariants": invariants_section.invariant_table(result.invariants),
    }


def rerun_command(name: str, command: str) -> str:
    """The command, quoted for a shell, that solves the case ``name`` again.

    command : that of the run, which tells where a file of the user's own was read from. Where it does not,
    as after a run that was stopped, the file is named alone.
    """
    try:
        words = shlex.split(command)[2:]
    except ValueError:
        words = []
    own = [word for word in words if PurePath(word).stem == name and PurePath(word).name != name]
    if own:
        word = own[0]
    elif name in words or name in default_cases() or name in published_cases():
        word = name
    else:
        word = f"{name}.toml"
    return f"coatcheck run {shlex.quote(f'./{word}' if word.startswith('-') else word)}"


def summary(result: CaseResult) -> str:
    """The outcome of a case in one or two sentences."""
    verdicts, gaps = [v for _, v in result.verdicts], [v.difference for _, v in result.verdicts]
    return stated(
        "summary",
        bad=sum(one.outcome is not Outcome.AGREES for one in verdicts),
        total=len(verdicts),
        broken=sum(one.outcome is not Outcome.AGREES for one in result.invariants),
        count=len(result.invariants),
        gap=scientific(max((gap for gap in gaps if gap is not None), default=None)),
    )


def data(material: ReportMaterial) -> dict[str, Any]:
    """The comparisons as the script of the page reads them: names once, then rows of indices and numbers."""
    quantities: dict[str, int] = {}
    lines: dict[str, int] = {}
    pairs: dict[tuple[str, str], int] = {}
    cases = {}
    for result in material.contacts:
        rows = [
            [
                quantities.setdefault(item.claim.quantity, len(quantities)),
                lines.setdefault(item.claim.line, len(lines)),
                pairs.setdefault(item.claim.between, len(pairs)),
                _short(item.difference),
                _short(item.uncertainty),
                item.claim.cap,
                list(OUTCOMES).index(item.verdict.outcome),
            ]
            for item in ordered(items_of(result.verdicts))
        ]
        scales = [float(scale(result.problem, name)) for name in ("a_h", "p_h", "delta_h")]
        scales += [float(divisor(result, name, 1.0)) for name in ("sigma_xx", "u_x")]
        scales.append(float(contact_radius(result) or scales[0]))
        cases[material.anchors[result]] = {"rows": rows, "scales": [_short(v, 9) for v in scales]}
    sources = dict.fromkeys(p.source for result in material.contacts for p in result.profiles)
    return {
        "sources": {
            name: [source_label(name), source_style(name).colour, source_style(name).width > 3]
            for name in sources
        },
        "quantities": [[name, typeset(symbol_of(name))] for name in quantities],
        "lines": list(lines),
        "pairs": [[*pair, pair_style(pair).colour] for pair in pairs],
        "agrees": list(OUTCOMES).index(Outcome.AGREES),
        "outcomes": [f"{style.mark} {style.word}" for style in OUTCOMES.values()],
        "cases": cases,
    }


def _short(value: float | None, digits: int = 3) -> float | None:
    if value is None or not abs(value) < float("inf"):
        return None
    return float(f"{value:.{digits}g}")
