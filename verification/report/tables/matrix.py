"""The verdict matrix: a row for each case, a column for each pair of sources on each group of lines."""

from collections.abc import Callable, Mapping, Sequence

from verification.judging.verdict import Claim, Outcome, Verdict
from verification.report.tables.cells import Cell, Row, Table
from verification.report.tables.labels import OUTCOMES, source_label
from verification.report.tables.lookup import GROUPS, group_of, slug
from verification.report.tables.numbers import scientific
from verification.running.result import CaseResult
from verification.sources.registry import METHODS

# With a soft hyphen, where a narrow column may break the word.
_HEADS = {"interfaces": "inter\u00adfaces"}


def verdict_matrix(
    results: Sequence[CaseResult],
    anchors: Mapping[CaseResult, str],
    more: Sequence[tuple[str, Callable[[CaseResult], Cell]]] = (),
) -> Table:
    """Overview of all cases; each cell holds its worst verdict and its largest difference.

    more : further columns behind the verdict, each with the function that gives the cell of a case.
    """
    claims = [claim for result in results for claim, _ in result.verdicts]
    blocks = sorted({_block(claim) for claim in claims})
    groups = [*GROUPS, *sorted({group_of(claim.line) for claim in claims} - set(GROUPS))]
    columns = [(b, g) for b in blocks for g in groups if any(_place(c) == (b, g) for c in claims)]
    rows = []
    for result in results:
        link = f"#{anchors[result]}"
        cells = [outcome_cell(result.outcome, href=link), *(cell(result) for _, cell in more)]
        for place in columns:
            found = [(c, v) for c, v in result.verdicts if _place(c) == place]
            cells.append(_cell(found, f"{link}-{_target(result, place[1])}"))
        rows.append(Row(case_cell(result, link), cells))
    spans = [(title, sum(b == (rank, title) for b, _ in columns)) for rank, title in blocks]
    return Table(
        "Largest difference of each pair of sources, as a fraction of the value for p0, a, approach and dW/d "
        "delta, of the smaller of p_h and p0 for stresses, of the smaller of delta_h and approach for "
        "displacements, of a for the place of the largest tension. A cell links "
        "to the figures behind it. Numbers since the baseline, where they "
        "were compared: = same, ≠ drifted, − gone, + new.",
        ["case", "verdict", *(name for name, _ in more), *(_HEADS.get(group, group) for _, group in columns)],
        rows,
        [("", 2 + len(more)), *spans],
        "matrix",
    )


def case_cell(result: CaseResult, href: str) -> Cell:
    """The title of a case as the head of a row, with its name for a pointer."""
    return Cell(result.title, note=f"{result.title} ({result.name})", href=href)


def outcome_cell(outcome: Outcome, href: str = "") -> Cell:
    """A verdict as letter, mark and colour, its word for a pointer; it sorts by how bad it is."""
    style = OUTCOMES[outcome]
    return Cell(f"{style.letter} {style.mark}", float(style.rank), f"verdict {style.css}", style.word, href)


def _cell(found: Sequence[tuple[Claim, Verdict]], href: str) -> Cell:
    if not found:
        return Cell("", None, "nothing", "no claim")
    worst = min((verdict.outcome for _, verdict in found), key=lambda o: OUTCOMES[o].rank)
    numbers = [(v.difference, c, v) for c, v in found if v.difference is not None]
    if not numbers:
        claim, verdict = next((c, v) for c, v in found if v.outcome is worst)
        note = f"{claim.quantity} on {claim.line}: {verdict.reason}"
        return Cell(f"{OUTCOMES[worst].letter} –", None, f"verdict {OUTCOMES[worst].css}", note, href)
    largest, claim, _ = max(numbers, key=lambda item: item[0])
    agreeing = sum(verdict.outcome is Outcome.AGREES for _, verdict in found)
    note = (
        f"{agreeing} of {len(found)} agree; largest difference {scientific(largest)}, {claim.quantity} "
        f"on {claim.line}, {' against '.join(source_label(s) for s in claim.between)}"
    )
    # The letter alone keeps sixteen columns within a page; its mark and word are above the matrix.
    style = OUTCOMES[worst]
    if worst is Outcome.NO_RESULT:
        # The difference of those with a number would look like the result.
        return Cell(f"{style.letter} –", None, f"verdict {style.css}", note, href)
    return Cell(f"{style.letter} {scientific(largest)}", largest, f"verdict {style.css}", note, href)


def _block(claim: Claim) -> tuple[int, str]:
    """Rank and title of the columns a pair belongs to: references share theirs, whatever they are."""
    methods = [source for source in METHODS if source in claim.between]
    if len(methods) == 2:
        return 0, " – ".join(source_label(source) for source in methods)
    if methods:
        return 1 + METHODS.index(methods[0]), f"{source_label(methods[0])} – reference"
    return 1 + len(METHODS), "reference – reference"


def _place(claim: Claim) -> tuple[tuple[int, str], str]:
    return _block(claim), group_of(claim.line)


def _target(result: CaseResult, group: str) -> str:
    """The part of the case's section that a group of lines is drawn in."""
    if group == GROUPS[0]:
        return "contact"
    drawn = [profile.line for profile in result.profiles if group_of(profile.line) == group]
    return slug(drawn[0]) if drawn else "comparisons"
