"""Comparison with the baseline: the change of each number since it was recorded."""

from collections.abc import Mapping, Sequence
from math import isfinite

from verification.page.number_text import scientific
from verification.page.page_parts import Cell, Part, Section, Table, number, row, words
from verification.page.source_labels import source_label
from verification.regression.baseline_change import COUNTED, CaseDrift, Regression, baseline_message
from verification.regression.manifest import manifest_message
from verification.regression.number_drift import FACTOR, RELATIVE, TOLERANCE, Drift, State

ANCHOR = "baseline"
MOST = 40
# How a state is shown without relying on colour: mark, class, rank in a column.
_STATES = {
    State.DRIFTED: ("≠", "inconclusive", 0),
    State.GONE: ("−", "no-result", 1),
    State.NEW: ("+", "", 2),
    State.SAME: ("=", "agrees", 3),
}
_RULE = (
    f"A number is the same where it differs by at most {scientific(RELATIVE, 1)} of the largest magnitude of "
    "its profile, an uncertainty where it differs by at most 10 %. On another machine or with other versions "
    "a run fails where a value left its baseline by more than its uncertainty, or by more than "
    f"{scientific(TOLERANCE, 1)} of the scale where the uncertainty is less (the largest change between two "
    f"machines was 5e-12), and where an uncertainty is more than {FACTOR:g} times that of the baseline or "
    "less than a quarter of it. "
    "Every point of every profile is compared, with values that the baseline rounds to 5e-11 at most."
)


def state_cell(case: CaseDrift, *, short: bool = False) -> Cell:
    """State of a case as mark and word, or as mark alone; it sorts by severity."""
    mark, css, rank = _STATES[case.state]
    note = f"{case.state}: {case.message or f'largest change {scientific(case.change)} of the scale'}"
    return Cell(mark if short else f"{mark} {case.state}", float(rank), f"verdict {css}".strip(), note)


def section(found: Regression | None, anchors: Mapping[str, str]) -> Section | None:
    """The run compared with its baseline; None where that was not done.   anchors : of cases by name."""
    if found is None:
        return None
    if found.update is None:
        text = (
            f"{baseline_message(found)} A complete run that agrees throughout becomes the baseline by: "
            'coatcheck baseline update --why "..."'
        )
        return Section(ANCHOR, "Baseline", [Part(text)])
    update = found.update
    made = f"recorded {update.when.replace('T', ' ').replace('+00:00', ' UTC')}"
    made += f" at commit {update.commit}" if update.commit else ""
    parts = [
        Part(f"{baseline_message(found)} The baseline in {found.folder} was {made}: “{update.why}”. {_RULE}")
    ]
    if found.other_versions:
        differences = "; ".join(
            f"{name} {then} in the baseline, {now} in this run" for name, then, now in found.other_versions
        )
        more = " Some changed by more than that explains." if found.beyond else ""
        parts.append(Part(f"The digits may differ because the provenance differs: {differences}.{more}"))
    # A case that is gone as a whole has its row above.
    here = [c for c in found.cases if any(d.state is not State.GONE for d in c.drifts)]
    moved = [(c, d) for c in here for d in c.drifts if d.state in (State.DRIFTED, State.GONE)]
    table = case_table(found.cases, anchors, "Numbers of each case compared with the baseline.")
    parts.append(Part("", [table, drift_table(moved)]))
    parts.append(Part(_judged(found), [_difference_table(found)], title="Manifest"))
    return Section(ANCHOR, "Baseline", parts)


def _judged(found: Regression) -> str:
    """What was judged compared with the manifest, in two sentences."""
    rule = (
        "The manifest records of each case what was judged: cap and scale in force, number, extent, widest "
        "gap of the points of each comparison, invariants, self-tests, sources, counted published values."
    )
    message = manifest_message(found.less) or manifest_message(found.judged)
    return f"{rule} {f'{message[0].upper()}{message[1:]}.' if message else 'This run judged all of it.'}"


def _difference_table(found: Regression) -> Table:
    rows = [
        row(
            item.case or "harness",
            "less" if item.less else "more",
            words(item.message),
            number(item.count, str),
        )
        for item in found.judged[:MOST]
    ]
    more = f" The first {MOST} of {len(found.judged)}." if len(found.judged) > MOST else ""
    return Table(
        f"What was judged otherwise than recorded.{more}", ["case", "judged", "change", "checks"], rows
    )


def drift_table(moved: Sequence[tuple[CaseDrift, Drift]]) -> Table:
    """The changed profiles, the largest change first."""
    order = sorted(moved, key=lambda item: -(float("inf") if item[1].change is None else item[1].change))
    rows = []
    for case, drift in order[:MOST]:
        mark, css, rank = _STATES[drift.state]
        state = Cell(f"{mark} {drift.state}", float(rank), f"verdict {css}")
        head, source = Cell(case.name, note=case.title), source_label(drift.source)
        change = _change(drift.change)
        rows.append(row(head, state, source, drift.quantity, drift.line, change, drift.message))
    more = f" The {MOST} of {len(order)} with the largest change." if len(order) > MOST else ""
    return Table(
        f"Changed numbers; changes over the largest magnitude of the profile.{more}",
        ["case", "state", "source", "quantity", "line", "largest change", "remark"],
        rows,
    )


def case_table(cases: Sequence[CaseDrift], anchors: Mapping[str, str], caption: str) -> Table:
    """State and counts of numbers of each case; ``anchors`` leads to cases by name."""
    rows = []
    for case in cases:
        place = anchors.get(case.name)
        head = Cell(case.title, note=case.name, href=f"#{place}" if place else "")
        counts = [number(case.count(state), str) for state in COUNTED]
        rows.append(row(head, state_cell(case), *counts, _change(case.change), case.message))
    return Table(caption, ["case", "state", "same", "drifted", "gone", "new", "largest change", ""], rows)


def _change(change: float | None) -> Cell:
    return Cell(scientific(change), change if change is not None and isfinite(change) else None)
