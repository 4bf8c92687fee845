"""The study command: bad input is one message with exit code 2, nothing written; else what came of it."""

import json

import pytest
from synthetic_solves import STUDY

from verification.commands.study import Options, thickness
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


@pytest.mark.slow
def test_a_study_of_one_point_from_the_command_line(tmp_path, capfd):
    plan = tmp_path / "one.toml"
    text = STUDY.replace("[0.5, 2.0]", "[2.0]").replace("[2e-5, 4e-5, 8e-5]", "[4e-5]")
    plan.write_text(text + "[semianalytic]\npatches = 33\nestimate_uncertainty = false\n")
    words = {"output": tmp_path / "out", "jobs": 1, "cross_check": False, "figures": False}
    assert thickness(str(plan), options=Options(**words, as_json=True)) == 0
    out, err = capfd.readouterr()
    assert err == ""
    said = json.loads(out)
    assert (said["points"], said["rows"], said["done"], said["failed"]) == (2, 2, 1, 0)
    found = read_columns(tmp_path / "out" / "one.parquet")
    assert found["status"].tolist() == ["solved"] * 2
    assert (found["sigma_xx_base"] > 0).all()
    # found again, said in a message
    assert thickness(str(plan), options=Options(**words)) == 0
    out, err = capfd.readouterr()
    assert "1 semi-analytical" in err
    assert "(1 of them stored)" in err
    assert "0 of 2" in " ".join(out.split())
