"""History of the runs that a user keeps: verdicts, departure from the baseline, times, and their page."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from verification.judging.verdict import Outcome
from verification.page.html_page import render_sections
from verification.page.number_text import factor, seconds
from verification.page.page_parts import Cell, Part, Section, Table, number, row, table_of, words
from verification.regression.baseline_change import Baseline, case_drift
from verification.running.case_result import CaseResult, RunInfo
from verification.running.stored_run import StoredRun


@dataclass(frozen=True)
class PastCase:
    """One case of a run.

    difference : the largest |A - B| over its scale.
    departure : the largest change of a value since the baseline, over what is allowed on any machine; None
    where the baseline lacks the case or samples other points.
    """

    name: str
    title: str
    outcome: Outcome
    agreeing: int
    comparisons: int
    seconds: float
    difference: float | None
    departure: float | None


@dataclass(frozen=True)
class PastRun:
    """One run: the ``path`` of its report.json, its provenance, its cases."""

    path: str
    info: RunInfo
    cases: tuple[PastCase, ...]

    @property
    def agreeing(self) -> int:
        """Number of comparisons that agree."""
        return sum(case.agreeing for case in self.cases)

    @property
    def comparisons(self) -> int:
        """Number of comparisons."""
        return sum(case.comparisons for case in self.cases)

    @property
    def agrees(self) -> bool:
        """True where every case agrees."""
        return all(case.outcome is Outcome.AGREES for case in self.cases)

    @property
    def difference(self) -> float | None:
        """The largest |A - B| of all comparisons over its scale."""
        return max((case.difference for case in self.cases if case.difference is not None), default=None)

    @property
    def departure(self) -> float | None:
        """The largest departure of a case."""
        return max((case.departure for case in self.cases if case.departure is not None), default=None)

    def seconds(self, name: str) -> float | None:
        """Seconds of the case ``name``; None where it was not run."""
        return next((case.seconds for case in self.cases if case.name == name), None)


def reports_in(folders: Iterable[Path]) -> list[Path]:
    """The report.json of each of ``folders`` and of the folders in it."""
    found = {}
    for folder in folders:
        for path in (folder / "report.json", *sorted(folder.glob("*/report.json"))):
            if path.is_file():
                found[path.resolve()] = path
    return list(found.values())


def history(runs: Iterable[StoredRun], baseline: Baseline | None) -> tuple[PastRun, ...]:
    """The ``runs`` from the earliest to the latest, all of them compared with the same ``baseline``."""
    past = [
        PastRun(str(run.path), run.info, tuple(_case(result, baseline) for result in run.results))
        for run in runs
    ]
    return tuple(sorted(past, key=lambda run: run.info.started))


def _case(result: CaseResult, baseline: Baseline | None) -> PastCase:
    differences = [v.difference for _, v in result.verdicts if v.difference is not None]
    return PastCase(
        result.name,
        result.title,
        result.outcome,
        sum(verdict.outcome is Outcome.AGREES for _, verdict in result.verdicts),
        len(result.verdicts),
        result.seconds,
        max(differences, default=None),
        case_drift(result, baseline).departure if baseline is not None else None,
    )


MOST_COLUMNS = 8  # runs in the table of times
_RUNS = (
    "The departure is the largest change of a value since the baseline over what is allowed on any machine: "
    "above 1 the value has left its baseline. All runs are compared with the present baseline. Times compare "
    "only within one machine."
)


def history_message(runs: Sequence[PastRun]) -> str:
    """All runs in one sentence."""
    agreeing = sum(run.agrees for run in runs)
    last = runs[-1]
    left = sum(case.departure is not None and not case.departure <= 1.0 for case in last.cases)
    text = f"{agreeing} of {len(runs)} runs agree throughout; the last took {seconds(last.info.seconds)}"
    if left:
        return f"{text}, and {left} of its {len(last.cases)} cases left the baseline."
    return f"{text}, and no value of it left the baseline." if last.departure is not None else f"{text}."


def history_page(runs: Sequence[PastRun]) -> str:
    """The whole page as text; ``runs`` from the earliest to the latest, at least one."""
    facts = [("first", _day(runs[0])), ("last", _day(runs[-1]))]
    facts += [("machine", machine) for machine in dict.fromkeys(run.info.machine for run in runs)]
    sections = [
        Section("runs", "Runs", [Part(_RUNS, [_table(runs)])]),
        Section("times", "Times of each case", [Part("", [_times(runs)])]),
    ]
    return render_sections("coatcheck history", history_message(runs), facts, sections)


def _table(runs: Sequence[PastRun]) -> Table:
    """One row a run, the latest first."""
    first = {run.info.machine: run.info.seconds for run in reversed(runs)}
    return table_of(
        "Runs, the latest first; |A − B| over its scale, the last ratio over the first run on that machine.",
        reversed(list(enumerate(runs, 1))),
        [
            ("run", lambda pair: pair[0]),
            ("started", lambda pair: _day(pair[1])),
            ("commit", lambda pair: pair[1].info.commit or "–"),
            ("version", lambda pair: pair[1].info.versions.get("coatcheck", "–")),
            ("agree", lambda pair: _agreeing(pair[1])),
            ("largest |A − B|", lambda pair: pair[1].difference),
            ("departure", lambda pair: pair[1].departure),
            ("time", lambda pair: number(pair[1].info.seconds, seconds)),
            ("ratio", lambda pair: factor(pair[1].info.seconds, first[pair[1].info.machine])),
            ("report", lambda pair: words(pair[1].path)),
        ],
    )


def _agreeing(run: PastRun) -> Cell:
    mark, css = ("✓", "agrees") if run.agrees else ("✗", "disagrees")
    return Cell(f"{mark} {run.agreeing} of {run.comparisons}", float(run.agreeing), f"verdict {css}")


def _times(runs: Sequence[PastRun]) -> Table:
    shown = runs[-MOST_COLUMNS:]
    titles = {case.name: case.title for run in shown for case in run.cases}
    rows = []
    for name, title in titles.items():
        times = [run.seconds(name) for run in shown]
        known = [time for time in times if time is not None]
        ratio = factor(known[-1], known[0]) if len(known) > 1 else "–"
        rows.append(row(Cell(title, note=name), *(number(time, seconds) for time in times), ratio))
    heads = [f"run {n}" for n in range(len(runs) - len(shown) + 1, len(runs) + 1)]
    more = f" The last {MOST_COLUMNS} runs." if len(runs) > MOST_COLUMNS else ""
    return Table(f"Seconds of each case.{more}", ["case", *heads, "last over first"], rows)


def _day(run: PastRun) -> str:
    return run.info.started.replace("T", " ").replace("+00:00", " UTC")
