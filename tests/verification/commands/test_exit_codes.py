"""The command line: exit codes, one-line messages, nothing written on bad input."""

import os
import subprocess
from dataclasses import replace
from functools import partial
from importlib import import_module

import pytest
from quick_case import COMMAND, QUICK, coatcheck

from verification.cases.case_file import read_case
from verification.judging.verdict import Outcome
from verification.running.case_tasks import case_task
from verification.running.pool.process_pool import run_tasks


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["run", "no_such_case"], "no_such_case"),
        (["run", "."], "directory"),
        (["run", "bad.toml"], "load must be above 0"),
        (["run", "01_uncoated_steel", "01_uncoated_steel"], "twice"),
        (["run", "--jobs", "0"], "--jobs = 0"),
        (["run", "--time-limit", "-1"], "--time-limit = -1"),
        (["frobnicate"], "frobnicate"),
    ],
)
def test_bad_input_is_one_sentence_code_2_and_nothing_written(tmp_path, words, said):
    (tmp_path / "bad.toml").write_text(QUICK.replace("load = 20", "load = 0"))
    before = sorted(tmp_path.rglob("*"))
    done = coatcheck(*words, cwd=tmp_path)
    assert done.returncode == 2
    assert said in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert "Traceback" not in done.stderr
    assert sorted(tmp_path.rglob("*")) == before


def test_process_that_ends_badly_is_no_result_with_the_reason(tmp_path):
    (tmp_path / "quick.toml").write_text(QUICK)
    quick = read_case(tmp_path / "quick.toml")
    broken = replace(case_task(quick, tmp_path), work=partial(import_module, "no_such_module"))
    result = run_tasks([broken], jobs=1, time_limit=100)[0]
    assert result.outcome is Outcome.NO_RESULT
    assert "code 1" in result.verdicts[0][1].reason


def test_missing_system_library_names_the_packages_and_writes_nothing(tmp_path):
    (tmp_path / "fake").mkdir()
    (tmp_path / "fake" / "gmsh.py").write_text(
        "raise OSError('libGLU.so.1: cannot open shared object file: No such file or directory')\n"
    )
    (tmp_path / "quick.toml").write_text(QUICK)
    done = subprocess.run(
        [*COMMAND, "run", "quick.toml"],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(tmp_path / "fake")},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 3
    assert "apt-get install" in done.stderr
    assert "libglu1-mesa" in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert not (tmp_path / "reports").exists()
