"""Pages of the shipped cases, generated from case files with the numbers of the baseline."""

from collections.abc import Iterator

import numpy as np

from verification.cases.case_file import default_cases
from verification.cases.published_file import PublishedCase, published_cases, read_published
from verification.judging.verdict import Outcome
from verification.manual.baseline_numbers import baseline, points, stored
from verification.manual.markdown_text import shown, symbol, table, text, typeset
from verification.page.number_text import scientific
from verification.page.source_labels import pair_label
from verification.problem.point_answers import BALL
from verification.report.tables.case_lookup import layers
from verification.report.tables.case_tables import contact_tables, facts, layer_table
from verification.running.case_result import CaseResult

SEEN = {
    "primary": "in the source",
    "second source": "in a second source",
    "quoted": "quoted elsewhere",
    "recomputed": "recomputed",
}
WORST = (
    "The largest difference of each pair of sources on all lines, over the scale of the comparison, with the "
    "largest $U$ on that line:"
)


def case_pages() -> Iterator[tuple[str, str]]:
    """Path with content of the page of every contact case and of every published case."""
    for name in default_cases():
        yield f"cases/{name}.md", _contact_page(stored(name))
    for name, path in published_cases().items():
        yield f"published/{name}.md", _published_page(read_published(path))


def _problem(result: CaseResult) -> list[str]:
    """The parameters and scales of a problem, then its layers, body by body."""
    heads, values = zip(*facts(result.problem), strict=True)
    tables = [table([typeset(head) for head in heads], [values], 0), shown(layer_table(result))]
    return [*tables, *([shown(layer_table(result, BALL))] if layers(result.problem, BALL) else [])]


def _contact_page(result: CaseResult) -> str:
    name, verdicts = result.name, [verdict for _, verdict in result.verdicts]
    agreed = sum(verdict.outcome is Outcome.AGREES for verdict in verdicts)
    return "\n\n".join(
        [
            f"# {text(result.title)}",
            f"Case `{name}`. Source of the problem: {text(result.source)}.",
            f"    coatcheck run {name}",
            "## Problem",
            *_problem(result),
            "## Results",
            *map(shown, contact_tables(result)),
            f"{len(verdicts)} comparisons at {points(name)} points, "
            f"{len(baseline().cases[name].manifest.invariants)} invariants; {agreed} of {len(verdicts)} "
            "comparisons agree.",
            _worst_table(result),
            "## Case file",
            f"```toml\n{result.text.strip()}\n```\n",
        ]
    )


def _worst_table(result: CaseResult) -> str:
    """For each quantity the largest difference of each pair, the largest U, and the cap."""
    pairs = list(dict.fromkeys(claim.between for claim, _ in result.verdicts))
    rows = []
    for name in dict.fromkeys(claim.quantity for claim, _ in result.verdicts):
        found = [(claim, verdict) for claim, verdict in result.verdicts if claim.quantity == name]
        cells: list[str] = []
        for pair in pairs:
            mine = [verdict for claim, verdict in found if claim.between == pair]
            worst = max(mine, key=lambda verdict: verdict.difference or 0.0, default=None)
            cells += ["", ""] if worst is None else map(scientific, (worst.difference, worst.uncertainty))
        rows.append([symbol(name), *cells, scientific(min(claim.cap for claim, _ in found), 1)])
    heads = [head for pair in pairs for head in (pair_label(pair), "$U$")]
    return f"{WORST}\n\n{table(['quantity', *heads, 'cap'], rows, 1)}"


def _published_page(case: PublishedCase) -> str:
    head = ["column", "quantity", "line", "values", "counted", "departures", "largest, over scale", "seen"]
    rows = []
    for item in case.columns:
        departed = int(np.count_nonzero(item.departure))
        largest = scientific(float(np.abs(item.departure).max()) / item.scale) if departed else ""
        line = text(item.profile.line.rsplit(", ", 2)[0])
        numbers = map(str, (len(item.text), int(item.counted.sum()), departed))
        seen = SEEN.get(item.seen, item.seen)
        rows.append([text(item.column), symbol(item.profile.quantity), line, *numbers, largest, seen])
    files = [
        f"- `{entry['file']}`, {SEEN.get(entry['seen'], entry['seen'])}: {text(entry['read'])}."
        for entry in case.citation["tables"]
    ]
    result = stored(case.name)
    parts = [
        f"# {text(case.title)}",
        f"Case `{case.name}`, {case.citation['year']}. Source: {text(case.source)}.",
        text(case.citation["remark"] or ""),
        f"    coatcheck run {case.name}",
        "## Problem",
        *_problem(result),
        "## Tables",
        "\n".join(dict.fromkeys(files)),
        table(head, rows, 3),
        "## Results",
        _worst_table(result),
    ]
    return "\n\n".join(part for part in parts if part) + "\n"
