"""coatcheck list: the shipped cases and published results."""

from rich.markup import escape

from verification.cases.case_file import Case, default_cases, read_case
from verification.cases.published_file import PublishedCase, published_cases, read_published
from verification.commands.common.shared_options import AsJson
from verification.commands.common.terminal import named_table, print_json, print_out


def list_cases(*, as_json: AsJson = False) -> int:
    """List the shipped cases with their title, then the published results; sources with --json."""
    cases = [read_case(path) for path in default_cases().values()]
    published = [read_published(path) for path in published_cases().values()]
    if as_json:
        keys = ("year", "tables")
        rows = [_listed(case) for case in cases]
        print_json(rows + [_listed(p) | {key: p.citation[key] for key in keys} for p in published])
        return 0
    table = named_table("case", "claims", "title")
    for case in cases:
        table.add_row(case.name, str(len(case.claims)), escape(case.title))
    results = named_table("published", "values", "year", "title")
    for result in published:
        values = sum(int(item.counted.sum()) for item in result.columns)
        results.add_row(result.name, str(values), str(result.citation["year"]), escape(result.title))
    print_out(table, "", results)
    return 0


def _listed(case: Case | PublishedCase) -> dict[str, object]:
    return {"name": case.name, "title": case.title, "source": case.source, "claims": len(case.claims)}
