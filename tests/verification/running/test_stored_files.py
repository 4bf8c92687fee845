"""Stored results: whole or refused, never half."""

import pytest
from synthetic_results import INFO, contact, result_of

from verification.running.case_result import to_json
from verification.running.checked_files import (
    StoreError,
    locked,
    read_checked,
    write_atomically,
    write_checked,
)
from verification.running.stored_run import StoredRun, confirm

PAYLOAD = {"name": "β-film <script>", "value": [1.0, 1e-300, -0.0, 0.1 + 0.2], "none": None}


def test_what_is_stored_is_read_back(tmp_path):
    write_checked(tmp_path / "a.json", PAYLOAD)
    assert read_checked(tmp_path / "a.json") == PAYLOAD
    assert [path.name for path in tmp_path.iterdir()] == ["a.json"]


def test_number_that_is_none_is_not_stored(tmp_path):
    with pytest.raises(ValueError, match="JSON"):
        write_checked(tmp_path / "a.json", {"value": float("nan")})
    assert not list(tmp_path.iterdir())


def test_file_that_cannot_be_written_leaves_the_old_one(tmp_path):
    write_atomically(tmp_path / "a", "old")
    (tmp_path / "b").write_text("in the way")
    with pytest.raises(StoreError, match="written"):
        write_atomically(tmp_path / "b" / "c", "new")
    assert (tmp_path / "a").read_text() == "old"


def test_second_writer_is_told(tmp_path):
    with locked(tmp_path), pytest.raises(StoreError, match="coatcheck"), locked(tmp_path):
        pass


def test_report_of_other_results_than_those_stored_beside_it_is_refused(tmp_path):
    stored, other = (result_of(contact(), name="one", points=points) for points in (9, 11))
    write_checked(tmp_path / "cases" / "one.json", to_json(stored))
    confirm(StoredRun(tmp_path / "report.json", INFO, (stored,)))
    with pytest.raises(StoreError, match="another"):
        confirm(StoredRun(tmp_path / "report.json", INFO, (other,)))
