"""Comparison with the baseline: the change of each number since it was recorded."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from math import isfinite

from verification.page.number_text import scientific
from verification.page.page_parts import Cell, Part, Section, Table, Value, table_of, words
from verification.page.source_labels import source_label
from verification.regression.baseline_change import COUNTED, CaseDrift, Regression, baseline_message
from verification.regression.manifest import manifest_message
from verification.regression.number_drift import FACTOR, KERNEL, RELATIVE, TOLERANCE, Drift, State
from verification.running.case_result import CaseResult

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
    f"its profile, or by less than its uncertainty and {scientific(KERNEL, 1)}, which another kernel of the "
    "linear algebra or another number of threads may cause; an uncertainty where it differs by at most 10 %. "
    "On another machine or with other versions a run fails where a value left its baseline by more than its "
    f"uncertainty, or by more than {scientific(TOLERANCE, 1)} of the scale where the uncertainty is less, "
    f"and where an uncertainty is more than {FACTOR:g} times that of the baseline or below a quarter of it. "
    "Every point of every profile is compared, with values that the baseline rounds to 5e-11 at most."
)


def state_cell(case: CaseDrift) -> Cell:
    """State of a case as mark and word; it sorts by severity."""
    note = f"{case.state}: {case.message or f'largest change {scientific(case.change)} of the scale'}"
    return _state(case.state, note)


def section(found: Regression | None, anchors: Mapping[CaseResult, str]) -> Section | None:
    """The run compared with its baseline; None where that was not done.   anchors : of the cases."""
    if found is None:
        return None
    if found.update is None:
        text = (
            f"{baseline_message(found)} A complete run that agrees throughout becomes the baseline by: "
            'coatcheck baseline update --why "..."'
        )
        return Section("baseline", "Baseline", [Part(text)])
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
    parts.append(Part("", [_case_table(found.cases, anchors), _drift_table(moved)]))
    parts.append(Part(_judged(found), [_difference_table(found)], title="Manifest"))
    return Section("baseline", "Baseline", parts)


def _judged(found: Regression) -> str:
    """Comparison of what was judged with the manifest, in two sentences."""
    rule = (
        "The manifest records of each case what was judged: cap and scale in force, number, extent, widest "
        "gap of the points of each comparison, invariants, self-tests, sources, counted published values."
    )
    message = manifest_message(found.less) or manifest_message(found.judged)
    return f"{rule} {f'{message[0].upper()}{message[1:]}.' if message else 'This run judged all of it.'}"


def _difference_table(found: Regression) -> Table:
    more = f" The first {MOST} of {len(found.judged)}." if len(found.judged) > MOST else ""
    return table_of(
        f"What was judged otherwise than recorded.{more}",
        found.judged[:MOST],
        [
            ("case", lambda one: one.case or "harness"),
            ("judged", lambda one: "less" if one.less else "more"),
            ("change", lambda one: words(one.message)),
            ("checks", lambda one: one.count),
        ],
    )


def _drift_table(moved: Sequence[tuple[CaseDrift, Drift]]) -> Table:
    """The changed profiles, the largest change first."""
    order = sorted(moved, key=lambda item: -(float("inf") if item[1].change is None else item[1].change))
    more = f" The {MOST} of {len(order)} with the largest change." if len(order) > MOST else ""
    return table_of(
        f"Changed numbers; changes over the largest magnitude of the profile.{more}",
        order[:MOST],
        [
            ("case", lambda item: Cell(item[0].name, note=item[0].title)),
            ("state", lambda item: _state(item[1].state)),
            ("source", lambda item: source_label(item[1].source)),
            ("quantity", lambda item: item[1].quantity),
            ("line", lambda item: item[1].line),
            ("largest change", lambda item: _change(item[1].change)),
            ("remark", lambda item: item[1].message),
        ],
    )


def _state(state: State, note: str = "") -> Cell:
    mark, css, rank = _STATES[state]
    return Cell(f"{mark} {state}", float(rank), f"verdict {css}".strip(), note)


def _case_table(cases: Sequence[CaseDrift], anchors: Mapping[CaseResult, str]) -> Table:
    """State and counts of numbers of each case; ``anchors`` leads to the cases."""
    places = {result.name: f"#{anchor}" for result, anchor in anchors.items()}
    columns: list[tuple[str, Callable[[CaseDrift], Value]]] = [
        ("case", lambda case: Cell(case.title, note=case.name, href=places.get(case.name, ""))),
        ("state", state_cell),
        *((str(state), partial(CaseDrift.count, state=state)) for state in COUNTED),
        ("largest change", lambda case: _change(case.change)),
        ("", lambda case: case.message),
    ]
    return table_of("Numbers of each case compared with the baseline.", cases, columns)


def _change(change: float | None) -> Cell:
    return Cell(scientific(change), change if change is not None and isfinite(change) else None)
