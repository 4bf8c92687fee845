"""History of kept runs: which are found, what is told of each, departures from the baseline."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from html_document import Document
from quick_case import coatcheck
from synthetic_results import INFO, STEEL, contact, result_of

from verification.regression.baseline_change import updated
from verification.regression.run_history import (
    MOST_COLUMNS,
    history,
    history_message,
    history_page,
    reports_in,
)
from verification.report.report_material import Material
from verification.report.report_page import report_json
from verification.running.stored_run import StoredRun

GOOD = result_of(contact((2 * STEEL[0], 0.3, 1.0)), name="stiff", points=17)
BASELINE = updated(None, [GOOD], INFO, "first", "2026-11-20T00:00:00+00:00")


def moved(by: float):
    """GOOD with one value off by ``by`` times its stated uncertainty."""
    profiles = list(GOOD.profiles)
    n = next(i for i, p in enumerate(profiles) if p.quantity == "sigma_xx" and p.source == "semianalytic")
    value = profiles[n].value.copy()
    at = int(np.argmax(profiles[n].uncertainty))
    value[at] += by * profiles[n].uncertainty[at]
    profiles[n] = replace(profiles[n], value=value)
    return replace(GOOD, profiles=tuple(profiles))


def run_of(day: int, *results, seconds: float = 10.0, machine: str = INFO.machine) -> StoredRun:
    info = replace(INFO, started=f"2026-11-{day:02d}T08:00:00+00:00", seconds=seconds, machine=machine)
    return StoredRun(Path(f"kept/{day}/report.json"), info, results)


@pytest.mark.parametrize("by", [0.0, 0.5, 3.0])
def test_a_departure_is_the_change_over_what_is_allowed(by):
    (run,) = history([run_of(1, moved(by))], BASELINE)
    assert run.departure == pytest.approx(by, rel=1e-6, abs=1e-12)
    assert ("1 of its 1" in history_message([run])) == (by > 1)


def test_runs_are_ordered_by_their_start_and_compared_with_one_baseline():
    runs = history([run_of(9, GOOD), run_of(2, GOOD, replace(GOOD, name="other"))], BASELINE)
    assert [run.info.started[8:10] for run in runs] == ["02", "09"]
    assert runs[0].cases[1].departure is None
    assert (runs[0].comparisons, runs[0].agreeing) == (2 * len(GOOD.verdicts),) * 2
    assert history([run_of(1, GOOD)], None)[0].departure is None


def test_the_page_shows_the_latest_first_and_ratios_within_a_machine():
    runs = [run_of(day, GOOD, seconds=10.0 * day) for day in range(1, MOST_COLUMNS + 2)]
    runs.append(run_of(20, moved(3.0), replace(GOOD, name="<b>"), seconds=7.0, machine="other"))
    document = Document(history_page(history(runs, BASELINE)))
    heads = document.whole("button")
    assert heads.index("run 3") < heads.index("run 10")
    assert "run 2" not in heads
    cells = document.whole("td")
    assert cells.index("2026-11-20 08:00:00 UTC") < cells.index("2026-11-01 08:00:00 UTC")


def test_the_command_finds_kept_runs_and_names_what_it_lacks(tmp_path):
    for name in ("", "one", "two"):
        folder = tmp_path / "reports" / name
        folder.mkdir(exist_ok=True)
        (folder / "report.json").write_text(report_json(Material([GOOD], INFO)))
    assert len(reports_in([tmp_path / "reports", tmp_path / "reports" / "one"])) == 3
    done = coatcheck("history", "--output", "h.html", "--json", cwd=tmp_path)
    assert done.returncode == 0
    assert len(json.loads(done.stdout)) == 3
    assert (tmp_path / "h.html").read_text().startswith("<!DOCTYPE html>")
    none = coatcheck("history", "nowhere", cwd=tmp_path)
    assert none.returncode == 2
    assert "report.json" in none.stderr
