"""Factors of the uncertainty of patches come from their calibration alone."""

import json
from pathlib import Path

import calibrate
import pytest

from semianalytic import numbers
from verification.commands.common.command_error import CommandError


def test_the_table_has_the_factors_of_the_record():
    found = json.loads(calibrate.RECORD.read_text(encoding="utf-8"))
    assert found["factors"] == {name: getattr(numbers, name) for name in found["factors"]}
    assert found["seed"] not in calibrate.JUDGES
    assert found["largest"] <= 1


def test_stored_factors_change_no_other_number(tmp_path):
    text = Path(numbers.__file__).read_text(encoding="utf-8")
    table = tmp_path / "numbers.py"
    table.write_text(text, encoding="utf-8")
    calibrate.store(table, {"SAFETY": 1.75})
    now = table.read_text(encoding="utf-8").splitlines()
    assert sorted({*now} - {*text.splitlines()}) == ["SAFETY = 1.75"]


def test_a_seed_that_judges_is_refused():
    with pytest.raises(CommandError, match="--seed = 1 judges the methods"):
        calibrate.calibrate.__wrapped__(seed=calibrate.JUDGES[0])
