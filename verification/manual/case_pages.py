"""Pages of the shipped cases, generated from case files with the numbers of the baseline."""

from collections.abc import Iterator, Sequence

import numpy as np

from verification.cases.case_file import Case, read_case, shipped_cases
from verification.cases.published_file import PublishedCase, published_cases, read_published
from verification.manual import case_figures
from verification.manual.baseline_numbers import Pair, baseline, pairs, values
from verification.manual.markdown_text import symbol, table, text
from verification.page.number_text import engineering, plain, scientific, with_uncertainty
from verification.problem.coated_contact import CoatedContact, PrescribedLoad
from verification.problem.quantity import QUANTITIES
from verification.sources.source_registry import SOURCES

SEEN = {
    "primary": "in the source",
    "second source": "in a second source",
    "quoted": "quoted elsewhere",
    "recomputed": "recomputed",
}


def contact_pages() -> Iterator[tuple[str, str | bytes]]:
    """Path with content of the page and the figure of every contact case, then their list."""
    cases = [read_case(path) for path in shipped_cases().values()]
    for case in cases:
        yield f"cases/{case.name}.svg", case_figures.of_case(case)
        yield f"cases/{case.name}.md", _contact_page(case)
    names = "\n".join(case.name for case in cases)
    yield "cases/index.md", _index("Cases of the default run", CONTACTS, names)


def published_pages() -> Iterator[tuple[str, str | bytes]]:
    """Path with content of the page and the figure of every published case, then their list."""
    cases = [read_published(path) for path in published_cases().values()]
    for case in cases:
        rows = [(_column(line), found) for line, found in _by_column(pairs(case.name)).items()]
        yield f"published/{case.name}.svg", case_figures.of_published(case.name, rows)
        yield f"published/{case.name}.md", _published_page(case)
    names = "\n".join(case.name for case in cases)
    yield "published/index.md", _index("Published cases", PUBLISHED, names)


CONTACTS = """
`coatcheck run` solves these cases by both methods and every reference that supports them. The numbers on
these pages are those of the baseline of this version; `coatcheck run NAME` computes them anew.

```{generated} headline
```
"""
PUBLISHED = """
`coatcheck run published` compares both methods and the exact integral equation with published tables. A value
is met when the difference is within the uncertainty of the method plus that of the published value: half of
its last digit, unless a digitisation uncertainty is stated. A published value that is off by more is a
departure: it is listed with its size in the table's file, compared after correction, and not counted. Values
that were recomputed from formulas are compared and not counted either.

```{generated} published_counts
```
"""


def _index(title: str, text: str, names: str) -> str:
    return f"# {title}\n{text}\n```{{toctree}}\n:maxdepth: 1\n\n{names}\n```\n"


def _layers(
    coatings: Sequence[Sequence[float]],
    substrate: Sequence[float],
    length: float,
    over: str = "a_h",
    last: str = "substrate",
) -> str:
    """Table of the layers, thicknesses over a ``length`` called ``over`` too; ``last``: the half-space."""
    rows = [
        [f"coating {i + 1}", engineering(E, "Pa"), plain(nu), engineering(h, "m"), plain(h / length, 3)]
        for i, (E, nu, h) in enumerate(coatings)
    ]
    rows.append([last, engineering(substrate[0], "Pa"), plain(substrate[1]), "", ""])
    return table(["layer, from the surface", "$E$", r"$\nu$", "$h$", f"$h/{over}$"], rows, 1)


def _problem(problem: CoatedContact) -> str:
    scales = table(
        ["$R$", "$W$", "$f$", "$a_h$", "$p_h$", r"$\delta_h$", "$E^*$", r"Dundurs' $\beta$"],
        [
            [
                engineering(problem.radius, "m"),
                engineering(problem.load, "N"),
                plain(problem.friction),
                engineering(problem.a_h, "m"),
                engineering(problem.p_h, "Pa"),
                engineering(problem.delta_h, "m"),
                engineering(problem.E_star, "Pa"),
                plain(problem.dundurs_beta, 3),
            ]
        ],
        0,
    )
    parts = [scales, _layers(problem.coatings, problem.substrate, problem.a_h)]
    if problem.ball is not None:
        E, nu, coatings = problem.ball
        parts += [
            "The ball is elastic:",
            _layers(coatings, (E, nu), problem.a_h, last="ball"),
        ]
    return "\n\n".join(parts)


def _contact_page(case: Case) -> str:
    known, found = values(case.name), pairs(case.name)
    sources = [s for s in baseline().manifests[case.name].sources if s in SOURCES]
    rows = []
    for name in (
        "peak_pressure",
        "contact_radius",
        "approach",
        "stiffness",
        "largest_tension",
        "tension_place",
    ):
        cells = []
        for source in sources:
            n = known.get((source, name, "contact"))
            unit = QUANTITIES[name].unit
            U = None if n is None or n.uncertainty is None else n.uncertainty[0]
            cells.append("" if n is None else with_uncertainty(n.value[0], U, unit))
        rows.append([symbol(name), *cells])
    head = ["", *(SOURCES[s].label for s in sources)]
    manifest = baseline().manifests[case.name]
    agreed = sum(p.agrees for p in found)
    judged = (
        f"{len(found)} comparisons at {sum(len(p.position) for p in found)} points, "
        f"{len(manifest.invariants)} invariants; {agreed} of {len(found)} comparisons agree."
    )
    return "\n\n".join(
        [
            f"# {text(case.title)}",
            f"Case `{case.name}`. Source of the problem: {text(case.source)}.",
            f"    coatcheck run {case.name}",
            f"```{{figure}} {case.name}.svg\n:alt: section, stresses, differences of {case.name}\n\n"
            "Section of the problem; pressure and stresses of every source; the largest difference of each "
            "group of comparisons as a dot, the uncertainty of both sides as a bar, the cap dashed.\n```",
            "## Problem",
            _problem(case.problem),
            "## Results",
            table(head, rows, 1),
            judged,
            _worst_table(found),
            "## Case file",
            f"```toml\n{case.text.strip()}\n```\n",
        ]
    )


def _worst_table(found: Sequence[Pair]) -> str:
    """For each quantity the largest difference of each pair, with U at that point and the cap."""
    sets = list(dict.fromkeys(p.between for p in found))
    rows = []
    for name in dict.fromkeys(p.quantity for p in found):
        cells, of_name = [], [p for p in found if p.quantity == name]
        for between in sets:
            one = max((p for p in of_name if p.between == between), key=lambda p: p.worst, default=None)
            if one is None:
                cells += ["", ""]
                continue
            at = int(np.argmax(one.difference))
            cells += [scientific(one.difference[at]), scientific(one.uncertainty[at])]
        rows.append([symbol(name), *cells, scientific(min(p.cap for p in of_name), 1)])
    head = ["quantity"]
    for between in sets:
        head += [" – ".join(SOURCES[name].label for name in between), "$U$"]
    intro = (
        "The largest difference of each pair of sources on all lines, over the scale of the comparison:\n\n"
    )
    return intro + table([*head, "cap"], rows, 1)


def _by_column(found: Sequence[Pair]) -> dict[str, list[Pair]]:
    columns: dict[str, list[Pair]] = {}
    for one in found:
        columns.setdefault(", ".join(one.line.rsplit(", ", 2)[-2:]) + "|" + one.quantity, []).append(one)
    return columns


def _column(key: str) -> str:
    place, _, quantity = key.partition("|")
    file, _, column = place.partition(", ")
    return f"{column.removeprefix('column ')} ({QUANTITIES[quantity].symbol}) of {file}"


def _published_page(case: PublishedCase) -> str:
    parts = [
        f"# {text(case.title)}",
        f"Case `{case.name}`, {case.citation['year']}. Source: {text(case.source)}.",
        text(case.citation["remark"] or ""),
        f"    coatcheck run {case.name}",
        f"```{{figure}} {case.name}.svg\n:alt: differences from the published values of {case.name}\n\n"
        "The largest difference of each column from each source, over the scale of the comparison.\n```",
        "## Problem",
    ]
    problem = case.problem
    if isinstance(problem, CoatedContact):
        parts.append(_problem(problem))
    elif isinstance(problem, PrescribedLoad):
        pressure, a = engineering(problem.pressure, "Pa"), problem.load_radius
        parts.append(f"A uniform pressure of {pressure} on a disc of radius {engineering(a, 'm')}:")
        parts.append(_layers(problem.coatings, problem.substrate, a, "a"))
    else:
        R = problem.radius
        parts.append(f"A sphere of radius {engineering(R, 'm')}, loaded step by step:")
        parts.append(_layers(problem.coatings, problem.substrate, R, "R"))
    rows = []
    for item in case.columns:
        departed = int(np.count_nonzero(item.departure))
        rows.append(
            [
                text(item.column),
                symbol(item.profile.quantity),
                text(item.profile.line.rsplit(", ", 2)[0]),
                str(len(item.text)),
                str(int(item.counted.sum())),
                str(departed),
                scientific(float(np.abs(item.departure).max()) / item.scale) if departed else "",
                SEEN.get(item.seen, item.seen),
            ]
        )
    head = ["column", "quantity", "line", "values", "counted", "departures", "largest, over scale", "seen"]
    tables = [
        f"- `{entry['file']}`, {SEEN.get(entry['seen'], entry['seen'])}: {text(entry['read'])}."
        for entry in case.citation["tables"]
    ]
    parts += ["## Tables", "\n".join(dict.fromkeys(tables)), table(head, rows, 3)]
    parts += ["## Results", _worst_table(pairs(case.name))]
    return "\n\n".join(part for part in parts if part) + "\n"
