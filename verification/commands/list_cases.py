"""coatcheck list: the shipped cases with their sources."""

import json
import sys
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console
from rich.table import Table

from verification.cases.contact import Case, read_case, shipped_cases
from verification.cases.published import PublishedCase, published_cases, read_published

__all__ = ["list_cases"]


def list_cases(*, as_json: Annotated[bool, Parameter(name="--json", negative="")] = False) -> int:
    """List the shipped cases with title and source, then the published results with their year.

    Parameters
    ----------
    as_json
        Print a JSON array instead of tables.
    """
    cases = [read_case(path) for path in shipped_cases().values()]
    published = [read_published(path) for path in published_cases().values()]
    if as_json:
        rows = [_listed(case) for case in cases]
        rows += [
            _listed(p) | {"year": p.citation["year"], "primary_read": p.citation["primary_read"]}
            for p in published
        ]
        sys.stdout.write(json.dumps(rows, indent=2) + "\n")
        return 0
    table = Table("case", "title", "claims", "source", box=None, header_style="bold")
    for case in cases:
        table.add_row(case.name, case.title, str(len(case.claims)), case.source)
    printed = Table("published", "title", "values", "year", "source", box=None, header_style="bold")
    for result in published:
        values = sum(int(item.counted.sum()) for item in result.columns)
        printed.add_row(result.name, result.title, str(values), str(result.citation["year"]), result.source)
    Console().print(table)
    Console().print()
    Console().print(printed)
    return 0


def _listed(case: Case | PublishedCase) -> dict[str, object]:
    return {"name": case.name, "title": case.title, "source": case.source, "claims": len(case.claims)}
