"""A study under SIGKILL and Ctrl-C: real solves, minutes, hence slow."""

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from verification.running.checked_files import read_checked
from verification.study.study_table import read_columns

STUDY = """
title = "Small but real"
[problem]
radius = 10e-3
load = 20.0
substrate = { E = 210e9, nu = 0.3 }
coating = { nu = 0.3 }
[sweep]
modulus_ratio = [0.5, 2.0, 4.0]
thickness_over_a_h = { from = 0.4, to = 3.0, count = 7 }
friction = [0.0, 0.25]
cross_check = 20
[semianalytic]
patches = 65
[fem_reference]
quality = "fast"
estimate_uncertainty = false
"""
SOLVES = 21 + 2 * 3
KILLS = 10

pytestmark = pytest.mark.slow


def started(plan, output):
    """The study in a session of its own, where Ctrl-C arrives, ignored below nohup and the like or not."""
    words = ["study", "thickness", str(plan), "--output", str(output), "--quiet", "--no-figures"]
    return subprocess.Popen(
        [sys.executable, "-m", "verification.cli", *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )


def finish(plan, output):
    process = started(plan, output)
    assert process.communicate(timeout=900) == ("", "")
    assert process.returncode == 0
    return read_columns(output / "small.parquet")


def same(a, b):
    """The same table to the last bit, but for the seconds, which are measurements."""
    assert list(a) == list(b)
    for name in a:
        if name != "seconds":
            np.testing.assert_array_equal(a[name], b[name], err_msg=name)


def stored(output):
    """When each solve was stored, by its file."""
    return {path: path.stat().st_mtime_ns for path in (output / "cache").rglob("*.json")}


def wait_for_more(process, output, count):
    until = time.monotonic() + 300
    while process.poll() is None and len(stored(output)) < count:
        assert time.monotonic() < until
        time.sleep(0.05)


def descendants(pid):
    """Numbers of the processes below ``pid``."""
    try:
        children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    except OSError:
        return []
    return [number for child in children for number in (child, *descendants(child))]


def runs(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


@pytest.fixture(scope="module")
def plan(tmp_path_factory):
    path = tmp_path_factory.mktemp("plan") / "small.toml"
    path.write_text(STUDY)
    return path


@pytest.fixture(scope="module")
def undisturbed(plan, tmp_path_factory):
    table = finish(plan, tmp_path_factory.mktemp("undisturbed"))
    assert set(table["status"]) == {"solved"}
    assert table["point"].size == 42 + 2 * 6
    return table


def test_killed_ten_times_at_random_and_resumed_it_is_the_same_table(plan, undisturbed, tmp_path):
    random.seed(7)
    kills = 0
    for attempt in range(KILLS):
        before = stored(tmp_path)
        process = started(plan, tmp_path)
        # Every other kill comes anywhere from the first second on, the rest once something new is stored.
        if attempt % 2:
            wait_for_more(process, tmp_path, len(before) + 1)
        time.sleep(random.uniform(0, 4))
        family = descendants(process.pid)
        if process.poll() is None:
            kills += 1
            # the parent alone, whose end the others have to notice, or its group at one blow
            (os.kill if attempt % 3 else os.killpg)(process.pid, signal.SIGKILL)
        process.communicate()
        until = time.monotonic() + 60
        while any(map(runs, family)):
            assert time.monotonic() < until, "processes outlived their study"
            time.sleep(0.05)
        now = stored(tmp_path)
        assert before.items() <= now.items(), "solved twice"
        for path in now:
            assert read_checked(path)["answer"]["rows"]
    assert kills >= 8, "the study was over too soon to be killed"
    before = stored(tmp_path)
    same(finish(plan, tmp_path), undisturbed)
    assert before.items() <= stored(tmp_path).items(), "solved twice"
    assert len(stored(tmp_path)) == SOLVES


def test_ctrl_c_leaves_what_was_done_and_says_so(plan, undisturbed, tmp_path):
    process = started(plan, tmp_path)
    wait_for_more(process, tmp_path, 3)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does
    _, said = process.communicate(timeout=120)
    assert process.returncode == 130
    assert said.strip().count("\n") == 0
    assert "command" in said
    partial_table = read_columns(tmp_path / "small.parquet")
    assert partial_table["point"].size >= 6
    assert set(partial_table["status"]) == {"solved"}
    same(finish(plan, tmp_path), undisturbed)
