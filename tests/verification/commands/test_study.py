"""The study command: bad input is one message with exit code 2, nothing written; else what came of it."""

import json
import os

import pytest
from synthetic_solves import STUDY

from verification.commands.study import Options, thickness
from verification.running.provenance import cores
from verification.study.study_table import read_columns


def written(folder):
    return [
        path
        for path in folder.rglob("*")
        if path.is_file() and path.suffix != ".toml" and path.stat().st_size
    ]


@pytest.mark.parametrize(
    ("plan", "options", "said"),
    [
        ("no_such_study", {}, "neither"),
        ("no_such_study.toml", {}, "no_such_study.toml"),
        (".", {}, "directory"),
        ("bad.toml", {}, "bad.toml"),
        ("good.toml", {"jobs": 0}, "--jobs = 0"),
        ("good.toml", {"limit": 0}, "--limit = 0"),
    ],
)
def test_bad_input_is_one_sentence_and_nothing_is_written(plan, options, said, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "good.toml").write_text(STUDY)
    (tmp_path / "bad.toml").write_text(STUDY.replace("10e-3", "'ten'"))
    assert thickness(plan, options=Options(output=tmp_path / "out", quiet=True, **options)) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert said in err
    assert written(tmp_path) == []


def test_a_study_of_one_point_from_the_command_line(tmp_path, capfd, monkeypatch):
    plan = tmp_path / "one.toml"
    plan.write_text(STUDY + "[semianalytic]\npatches = 33\nestimate_uncertainty = false\n")
    words = {"output": tmp_path / "out", "jobs": 1, "limit": 1, "cross_check": False, "figures": False}
    assert thickness(str(plan), options=Options(**words, as_json=True)) == 0
    out, err = capfd.readouterr()
    assert err == ""
    said = json.loads(out)
    assert (said["points"], said["rows"], said["done"], said["failed"]) == (1, 1, 1, 0)
    found = read_columns(tmp_path / "out" / "one.parquet")
    assert found["status"].tolist() == ["solved"]
    assert found["sigma_xx_base"][0] > 0
    # found again, said in a message; on a busy machine with the time beside what else runs
    monkeypatch.setattr(os, "getloadavg", lambda: (9.0 * cores(), 0.0, 0.0))
    assert thickness(str(plan), options=Options(**words)) == 0
    out, err = capfd.readouterr()
    assert "semi-analytical" in err
    assert "idle cores, 0 s beside the present load" in " ".join(err.split())
    assert "0 of 1" in " ".join(out.split())
