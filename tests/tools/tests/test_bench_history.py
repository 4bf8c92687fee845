"""The benchmark's history: a line for each run, shown as a table, as a figure."""

import json

import numpy as np
import pytest
from bench import speed_figure
from bench.figures import Figure
from bench.history import BenchRun, append, read
from cyclopts import App

from verification.running.checked_files import StoreError


def bench_run(n, *figures):
    return BenchRun(f"{n:012x}", f"2026-11-2{n}T10:00:00+00:00", "a machine", {"numpy": "2"}, figures)


def solve(*ratios):
    return Figure("solve with uncertainty", "dfc1d79", 0.3, ratios)


@pytest.fixture
def kept(tmp_path):
    """A history of two runs."""
    path = tmp_path / "bench.jsonl"
    append(path, bench_run(1, solve(0.5, 0.4, 0.6)))
    append(path, bench_run(2, solve(0.2), Figure("contact, N = 512, 2 threads", "tamaas", None, (0.01,))))
    return path


def test_runs_are_read_as_they_were_written(kept):
    first, second = read(kept)
    assert first == bench_run(1, solve(0.5, 0.4, 0.6))
    assert [json.loads(line)["commit"] for line in kept.read_text().splitlines()] == [
        "0" * 11 + "1",
        "0" * 11 + "2",
    ]
    assert [run.median(second.figures[1]) for run in (first, second)] == [None, 0.01]
    assert read(kept.with_name("none")) == ()


@pytest.mark.parametrize("line", ["{", "[]", '{"commit": 1}'])
def test_a_line_of_another_program_is_named(kept, line):
    with kept.open("a") as file:
        file.write(line)
    with pytest.raises(StoreError, match=r"bench\.jsonl: line 3"):
        read(kept)


app = App(result_action="return_value")
app.command("bench.command:bench")


def command(*words):
    return app(["bench", *map(str, words)])


def test_the_history_is_shown_as_table_and_figure(kept, capsys, monkeypatch):
    saved = {}
    monkeypatch.setattr(speed_figure, "save", lambda drawn, path: saved.update({path: drawn()}))
    plot = kept.with_suffix(".svg")
    assert command("--history", kept, "--show", "--plot", plot) == 0
    table = capsys.readouterr().out
    assert [word for word in table.split() if word in ("0.5", "0.2", "0.01")] == ["0.5", "0.2", "0.01"]
    solved, beside = saved[plot].axes
    assert (solved.get_title(), beside.get_title()) == ("over dfc1d79", "over tamaas")
    medians, asked = solved.lines
    np.testing.assert_array_equal(medians.get_ydata(), [0.5, 0.2])
    np.testing.assert_array_equal(asked.get_ydata(), [0.3, 0.3])


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("solve",), "name it with --against"),
        (("--show",), "name it with --history"),
        (("--plot", "bench.txt"), "has to end in"),
        (("--rounds", 0), "--rounds from 1"),
        (("--sizes", 8192), "--sizes from 16 to 4096"),
        (("gpu", "--sizes", 32768), "--sizes from 16 to 16384"),
        (("--against", "no such commit"), "--against no such commit: neither"),
        (("--history", "none.jsonl", "--show"), "holds no run"),
    ],
)
def test_what_cannot_be_measured_is_refused(words, message, capsys):
    assert command(*words) == 2
    assert message in capsys.readouterr().err


def test_missed_figures_are_named_in_the_end_and_a_failure_keeps_the_rest(monkeypatch, tmp_path, capsys):
    from bench import command as bench

    def measured(group, rounds, progress):
        if "N = 64, 1 thread" not in next(iter(group.works)):
            raise RuntimeError("contact failed: no memory")
        return [solve(0.5), Figure("contact", "tamaas", 0.1, (0.05,))]

    monkeypatch.setattr(bench, "measure", measured)
    assert command("contact", "--sizes", 64) == 1
    assert "1 of 2 asked figures missed: solve with uncertainty over dfc1d79." in capsys.readouterr().out
    path = tmp_path / "bench.jsonl"
    assert command("contact", "--sizes", 64, 128, "--history", path, "--json") == 3
    out, err = capsys.readouterr()
    assert "contact failed: no memory" in err
    assert [figure["name"] for figure in json.loads(out)[0]["figures"]] == [
        "solve with uncertainty",
        "contact",
    ]
    assert len(read(path)) == 1


def test_the_part_gpu_is_left_out_with_a_line_where_no_device_computes(monkeypatch, capsys):
    from bench import command as bench

    monkeypatch.setattr(bench, "not_measured", lambda: "cupy is not installed")
    monkeypatch.setattr(bench, "measure", lambda group, rounds, progress: [solve(0.2)])
    assert command("gpu") == 0
    out, err = capsys.readouterr()
    assert out == ""
    assert err == "coatcheck: the part gpu is not measured: cupy is not installed\n"
    monkeypatch.setattr(bench, "not_measured", lambda: None)
    assert command("gpu", "--sizes", 16384) == 0
    out, err = capsys.readouterr()
    assert "solve with uncertainty" in out
    assert "not measured" not in err
