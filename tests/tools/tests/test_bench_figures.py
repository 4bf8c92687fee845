"""The benchmark's figures: what is measured over what, how ratios are taken, which are missed."""

import json

import pytest
from bench import figures
from bench.figures import REFERENCE, ROOMS, Figure, Other, groups, measure
from bench.turns import HERE, Times
from cyclopts import App


def planned(name=REFERENCE, root=HERE, **options):
    return groups(
        ("solve", "stress", "elements", "contact", "default-run"),
        other=Other(name, root, "python"),
        **options,
    )


def asked(found):
    return {
        (group.works[r.work].name, r.work, r.over): r.asked
        for group in found
        for r in group.ratios
        if r.asked
    }


def test_every_ratio_asked_is_measured():
    found = asked(planned(peers=("tamaas", "aspher"), fast=True))
    beside_others = ("sphere", "more_threads")
    limits = sorted(limit for (work, _, _), limit in found.items() if work not in beside_others)
    assert limits == [0.3, 0.3, 0.3, 0.4, 0.45, 0.5, 0.6]
    beside = [over for (work, _, over) in found if work == "sphere"]
    assert {over: beside.count(over) for over in beside} == {
        "tamaas": 6,
        "aspher": 6,
        "convolution": 3,
    }
    assert [limit for (work, _, _), limit in found.items() if work == "more_threads"] == [1.0, 1.0, 1.0]


def test_default_run_is_that_of_the_contacts_that_both_commits_have(tmp_path):
    cases = tmp_path / "verification" / "cases" / "elsewhere"
    cases.mkdir(parents=True)
    for name in ("05_ratio_4", "99_unknown_today"):
        (cases / f"{name}.toml").touch()
    *_, group = planned(ROOMS, tmp_path)
    assert {(work.arguments, work.root) for work in group.works.values()} == {
        (("05_ratio_4",), HERE),
        (("05_ratio_4",), tmp_path),
    }
    (ratio,) = group.ratios
    assert (ratio.over, ratio.asked) == (ROOMS, 0.6)


def test_over_another_commit_nothing_is_asked():
    assert {over for _, _, over in asked(planned("1234567"))} == {"convolution", "1 thread"}
    assert {work for work, _, _ in asked(planned("dfc1d79+"))} == {"sphere", "more_threads"}


def test_both_commits_do_the_same_work(tmp_path):
    for group in planned(root=tmp_path, fast=True):
        before = group.works.get(REFERENCE)
        if before is not None:
            ours = next(iter(group.works.values()))
            assert (before.name, before.arguments, before.root) == (ours.name, ours.arguments, tmp_path)
            assert group.processor
            assert ours.root == HERE


def test_ratios_are_taken_turn_by_turn_of_the_clock_of_the_group(monkeypatch):
    group, *_ = planned()
    ours, before = group.works
    times = {
        ours: Times((9.0, 9.0, 9.0), (1.0, 4.0, 2.0), 0.0, 0.0),
        before: Times((1.0, 1.0, 1.0), (2.0, 5.0, 10.0), 0.0, 0.0),
    }
    monkeypatch.setattr(figures, "in_turn", lambda works, rounds, progress: times)
    (figure,) = measure(group, 3)
    assert figure == Figure(ours, REFERENCE, 0.3, (0.5, 0.8, 0.2))
    assert figure.median == 0.5
    assert figure.missed
    assert not Figure(ours, REFERENCE, 0.5, (0.5,)).missed
    assert not Figure(ours, "1234567", None, (5.0,)).missed


def test_of_works_that_may_be_equal_a_cost_is_missed_where_every_turn_shows_it(monkeypatch):
    (group,) = groups(("contact",), other=None, sizes=(512,))

    def missed(*ratios):
        times = {name: Times((1.0,), (1.0,), 0.0, 0.0) for name in group.works}
        times["N = 512, 2 threads, in one process"] = Times((1.0,), (1.0,), 0.0, 0.0, ratios)
        monkeypatch.setattr(figures, "in_turn", lambda works, rounds, progress: times)
        (figure,) = (one for one in measure(group, 1) if one.over == "1 thread")
        assert figure.ratios == ratios
        return figure.missed

    assert missed(1.01, 1.02, 1.001)
    assert not missed(1.01, 1.02, 0.999)


def test_peak_memory_is_counted_and_a_solver_that_misses_the_judge_is_a_figure_missed(monkeypatch):
    (group,) = groups(("contact",), other=None, sizes=(512,), threads=(2,), peers=("tamaas",))
    times = {name: Times((1.0,), (2.0,), 16.0 * 512**2, 0.0) for name in group.works}
    times["tamaas, N = 512, 2 threads"] = Times((4.0,), (1.0,), 0.0, 3e-6)
    monkeypatch.setattr(figures, "in_turn", lambda works, rounds, progress: times)
    found = {(figure.name, figure.over): figure for figure in measure(group, 1)}
    assert found["contact, N = 512, 2 threads", "tamaas"].ratios == (0.25,)
    assert found["peak memory, contact, N = 512, 2 threads", "N x N doubles"].ratios == (2.0,)
    residual = found["residual, tamaas, N = 512, 2 threads", "judge"]
    assert residual.median == pytest.approx(3)
    assert residual.missed


app = App(result_action="return_value")
app.command("bench.command:bench")


@pytest.mark.parametrize(
    ("words", "option"),
    [
        ("solve", "--against"),
        ("--rounds 0", "--rounds"),
        ("--sizes 8192", "--sizes"),
        ("--against no-such-commit", "--against"),
    ],
)
def test_what_cannot_be_measured_is_refused(words, option, capsys):
    assert app(["bench", *words.split()]) == 2
    assert option in capsys.readouterr().err


def test_the_exit_code_shows_a_missed_figure_and_a_failure_keeps_the_rest(monkeypatch, capsys):
    def measured(group, rounds, progress):
        if "N = 64, 1 thread" not in next(iter(group.works)):
            raise RuntimeError("no memory")
        return [Figure("solve", REFERENCE, 0.3, (0.5,)), Figure("contact", "tamaas", 0.1, (0.05,))]

    monkeypatch.setattr("bench.command.measure", measured)
    assert app(["bench", "contact", "--sizes", "64"]) == 1
    assert capsys.readouterr().out.count("missed") == 1
    assert app(["bench", "contact", "--sizes", "64", "128", "--json"]) == 3
    out, err = capsys.readouterr()
    assert "no memory" in err
    assert [figure["name"] for figure in json.loads(out)["figures"]] == ["solve", "contact"]
