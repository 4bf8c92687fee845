"""Generated blocks of pages: ``{generated} name`` is replaced by what ``BLOCKS[name]`` returns."""

from collections.abc import Callable

from verification.cases.contact import read_case, shipped_cases


def case_list() -> str:
    """Table of the shipped cases."""
    rows = ["| case | title |", "| --- | --- |"]
    rows += [f"| {case.name} | {case.title} |" for case in map(read_case, shipped_cases().values())]
    return "\n".join(rows)


BLOCKS: dict[str, Callable[[], str]] = {f.__name__: f for f in (case_list,)}
