"""History of the runs that a user keeps: a page of its own."""

from collections.abc import Sequence
from itertools import pairwise
from math import ceil, floor, isfinite, log10

import numpy as np
from markupsafe import Markup

from verification.page.html_page import render_sections
from verification.page.number_text import factor, seconds
from verification.page.page_parts import Cell, Gallery, Panel, Part, Section, Table, number, row, words
from verification.page.svg_plot import Axes, drawing, power_of_ten, round_ticks
from verification.regression.run_history import PastRun
from verification.sources.source_record import Style

WIDTH, HEIGHT = 400, 235
BOX = (48.0, 8.0, 338.0, 188.0)  # left, top, width, height
LEAST = 1e-4  # a smaller departure is drawn here
MOST_COLUMNS = 8  # runs in the table of times
LIMIT = Style("cap", (3.6, 3.0))
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
        Section("runs", "Runs", [Part(_RUNS, [_table(runs)], _gallery(runs))]),
        Section("times", "Times of each case", [Part("", [_times(runs)])]),
    ]
    return render_sections("coatcheck history", history_message(runs), facts, sections)


def _gallery(runs: Sequence[PastRun]) -> Gallery:
    departures = [[case.departure for case in run.cases if case.departure is not None] for run in runs]
    departed = Panel(
        "Departure from the baseline", _departures(departures), "a dot for each case; above 1 it has left", ""
    )
    times = Panel("Seconds of the run", _seconds(runs), "the whole run, on the processes that it used", "")
    return Gallery([], [departed, times], "Runs from the earliest to the latest.")


def _departures(departures: Sequence[Sequence[float]]) -> Markup:
    """The departure of each case of each run, logarithmic; a line at 1."""
    finite = [value for some in departures for value in some if value > LEAST and isfinite(value)]
    top = max(1.0, ceil(log10(max(finite, default=1.0))))
    axes = Axes(BOX, (0.5, len(departures) + 0.5), (log10(LEAST), top + 0.2))
    exponents = range(floor(log10(LEAST)), int(top) + 1)
    axes.ticks(_numbers(len(departures)), [(n, power_of_ten(n) if n else "1") for n in exponents], "run")
    axes.level(0.0, LIMIT)
    for n, some in enumerate(departures, 1):
        values = np.log10(np.clip(np.array(some, dtype=float), LEAST, 10.0**top))
        axes.marks(np.full(values.size, float(n)), values, Style("semi"))
    return drawing(WIDTH, HEIGHT, "departure of each case from the baseline, run by run", axes)


def _seconds(runs: Sequence[PastRun]) -> Markup:
    """Seconds of each run from zero; runs of one machine joined."""
    times = [run.info.seconds for run in runs]
    top = 1.1 * max([*(t for t in times if isfinite(t)), 1e-3])
    axes = Axes(BOX, (0.5, len(runs) + 0.5), (0.0, top))
    axes.ticks(_numbers(len(runs)), round_ticks(0.0, top, 5), "run")
    for n, (one, two) in enumerate(pairwise(runs), 1):
        if one.info.machine == two.info.machine:
            axes.line(np.array([n, n + 1.0]), np.array(times[n - 1 : n + 1]), Style("semi"))
    axes.marks(np.arange(1.0, len(runs) + 1), np.array(times), Style("semi"))
    return drawing(WIDTH, HEIGHT, "seconds of each run", axes)


def _numbers(count: int) -> list[tuple[float, str]]:
    step = ceil(count / 12)
    return [(float(n), str(n)) for n in range(1, count + 1, step)]


def _table(runs: Sequence[PastRun]) -> Table:
    """One row a run, the latest first."""
    rows = []
    for n, run in reversed(list(enumerate(runs, 1))):
        mark, css = ("✓", "agrees") if run.agrees else ("✗", "disagrees")
        first = next(one for one in runs if one.info.machine == run.info.machine)
        rows.append(
            row(
                Cell(str(n), float(n)),
                _day(run),
                run.info.commit or "–",
                run.info.versions.get("coatcheck", "–"),
                Cell(f"{mark} {run.agreeing} of {run.comparisons}", float(run.agreeing), f"verdict {css}"),
                number(run.difference),
                number(run.departure),
                number(run.info.seconds, seconds),
                Cell(factor(run.info.seconds, first.info.seconds)),
                words(run.path),
            )
        )
    columns = ["run", "started", "commit", "version", "agree", "largest |A − B|", "departure", "time"]
    return Table(
        "Runs, the latest first; |A − B| over its scale, the last ratio over the first run on that machine.",
        [*columns, "ratio", "report"],
        rows,
    )


def _times(runs: Sequence[PastRun]) -> Table:
    shown = runs[-MOST_COLUMNS:]
    titles = {case.name: case.title for run in shown for case in run.cases}
    rows = []
    for name, title in titles.items():
        times = [run.seconds(name) for run in shown]
        known = [time for time in times if time is not None]
        ratio = Cell(factor(known[-1], known[0]) if len(known) > 1 else "–")
        rows.append(row(Cell(title, note=name), *(number(time, seconds) for time in times), ratio))
    start = len(runs) - len(shown) + 1
    heads = [f"run {n}" for n in range(start, len(runs) + 1)]
    more = f" The last {MOST_COLUMNS} runs." if len(runs) > MOST_COLUMNS else ""
    return Table(f"Seconds of each case.{more}", ["case", *heads, "last over first"], rows)


def _day(run: PastRun) -> str:
    return run.info.started.replace("T", " ").replace("+00:00", " UTC")
