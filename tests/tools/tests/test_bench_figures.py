"""The benchmark's figures: what is measured over what, how ratios are taken, which are missed."""

import json

import pytest
from bench import figures
from bench.figures import REFERENCE, Figure, Other, groups, measure
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
