"""Counts of published values: counted, departing, recomputed."""

from collections.abc import Sequence

from verification.cases.published_table import RECOMPUTED
from verification.running.case_result import CaseResult


def counts(results: Sequence[CaseResult]) -> tuple[int, int, int]:
    """Published values that count, published values that depart, values of recomputed tables."""
    items = [item for result in results for item in result.published["columns"]]
    total = sum(len(item["counted"]) for item in items)
    counted = sum(sum(item["counted"]) for item in items)
    recomputed = sum(len(item["counted"]) for item in items if item["seen"] == RECOMPUTED)
    return counted, total - counted - recomputed, recomputed


def published_message(results: Sequence[CaseResult]) -> str:
    """Counts of published values, departures, recomputed values in one line."""
    counted, departing, recomputed = counts(results)
    return f"{counted} published values count, {departing} depart and are listed, {recomputed} are recomputed"
