"""A study under SIGKILL, and on a cluster started by hand: real solves, minutes, hence slow."""

import json
import os
import random
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import numpy as np
import psutil
import pytest
from scheduler_by_hand import ENVIRONMENT, hand_started, wait_until

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


def command(plan, output, *more):
    words = ["study", "thickness", str(plan), "--output", str(output), "--quiet", "--no-figures", *more]
    return [sys.executable, "-m", "verification.cli", *words]


def finish(plan, output, *more):
    done = subprocess.run(
        command(plan, output, *more), capture_output=True, text=True, timeout=900, env=ENVIRONMENT
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    return read_columns(output / "small.parquet")


def same(a, b):
    """The same table to the last bit, but for the seconds, which are measurements."""
    assert list(a) == list(b)
    for name in a:
        if name != "seconds":
            np.testing.assert_array_equal(a[name], b[name], err_msg=name)


def ledger(output):
    try:
        lines = (output / "ledger.jsonl").read_text().splitlines()
    except FileNotFoundError:
        return []
    return [json.loads(line) for line in lines if line.endswith("}")]


def keys(lines, event):
    return [line["key"] for line in lines if line["event"] == event]


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


def over_or_stored(process, output, before):
    """Whether the study ended, or stored something since line ``before`` of its ledger."""
    return process.poll() is not None or bool(keys(ledger(output)[before:], "stored"))


def test_killed_ten_times_at_random_and_resumed_it_is_the_same_table(plan, undisturbed, tmp_path):
    random.seed(7)
    kills = 0
    stored: set[str] = set()
    for attempt in range(KILLS):
        before = len(ledger(tmp_path))
        process = subprocess.Popen(
            command(plan, tmp_path), env=ENVIRONMENT, start_new_session=True, stderr=subprocess.DEVNULL
        )
        # Every other kill comes anywhere from the first second on, the rest once something new is stored.
        if attempt % 2:
            wait_until(partial(over_or_stored, process, tmp_path, before), "a stored solve")
        time.sleep(random.uniform(0, 4))
        family = psutil.Process(process.pid).children(recursive=True) if process.poll() is None else []
        if process.poll() is None:
            kills += 1
            # the client alone, whose workers have to notice, or all of them at one blow
            (os.kill if attempt % 3 else os.killpg)(process.pid, signal.SIGKILL)
        process.wait()
        _, alive = psutil.wait_procs(family, timeout=60)
        assert not alive, f"workers outlived their study: {alive}"

        lines = ledger(tmp_path)
        assert not stored & set(keys(lines[before:], "sent")), "solved twice"
        stored |= set(keys(lines, "stored"))
        files = {path.stem for path in (tmp_path / "cache").rglob("*.json")}
        assert stored <= files
        for path in (tmp_path / "cache").rglob("*.json"):
            assert read_checked(path)["answer"]["rows"]
        if (tmp_path / "small.parquet").exists():
            so_far = read_columns(tmp_path / "small.parquet")
            assert np.isfinite(so_far["peak_pressure"]).all()
    assert kills >= 8, "the study was over too soon to be killed"
    before = len(ledger(tmp_path))
    same(finish(plan, tmp_path), undisturbed)
    lines = ledger(tmp_path)
    assert not stored & set(keys(lines[before:], "sent")), "solved twice"
    everything = keys(lines, "stored")
    assert len(everything) == len(set(everything)) <= SOLVES
    assert len({path.stem for path in (tmp_path / "cache").rglob("*.json")}) == SOLVES


def test_two_workers_started_by_hand_give_the_same_table(plan, undisturbed, tmp_path):
    with hand_started(tmp_path) as (address, _):
        same(finish(plan, tmp_path / "out", "--scheduler", address), undisturbed)


def test_a_worker_killed_in_the_middle_loses_no_point(plan, undisturbed, tmp_path):
    output = tmp_path / "out"
    with hand_started(tmp_path) as (address, workers):
        process = subprocess.Popen(
            command(plan, output, "--scheduler", address), env=ENVIRONMENT, stderr=subprocess.PIPE, text=True
        )
        wait_until(lambda: len(keys(ledger(output), "stored")) >= 5, "five stored solves")
        os.killpg(workers[0].pid, signal.SIGKILL)
        assert process.wait(timeout=900) == 0
        assert process.stderr is not None
        assert process.stderr.read() == ""
        process.stderr.close()
    lines = ledger(output)
    assert keys(lines, "lost") == []
    assert sorted(keys(lines, "stored")) == sorted(set(keys(lines, "sent")))
    same(read_columns(output / "small.parquet"), undisturbed)


def test_ctrl_c_leaves_what_was_done_and_says_so(plan, undisturbed, tmp_path):
    process = subprocess.Popen(
        command(plan, tmp_path),
        env=ENVIRONMENT,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # ignored below nohup and the like
    )
    wait_until(lambda: len(keys(ledger(tmp_path), "stored")) >= 3, "three stored solves")
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does: to the workers, too
    _, said = process.communicate(timeout=120)
    assert process.returncode == 130
    assert said.strip().count("\n") == 0
    assert "command" in said
    partial_table = read_columns(tmp_path / "small.parquet")
    assert partial_table["point"].size >= 6
    assert set(partial_table["status"]) == {"solved"}
    same(finish(plan, tmp_path), undisturbed)


def test_memory_stays_flat_over_ten_thousand_points(tmp_path):
    """Of the client, on made-up answers; that of workers is seen in the ledger of a real study."""
    script = tmp_path / "many.py"
    script.write_text(
        "import sys, functools\n"
        f"sys.path.insert(0, {str(Path(__file__).parents[1])!r})\n"
        "from pathlib import Path\n"
        "from synthetic_solves import made_up\n"
        "from verification.study.dask_cluster import connected\n"
        "from verification.study.study_engine import run_study\n"
        "from verification.study.study_plan import read_study_file, shipped_studies\n"
        "if __name__ == '__main__':\n"
        "    study = read_study_file(shipped_studies()['ten_thousand'])\n"
        "    cluster = functools.partial(connected, None, 2)\n"
        "    came = run_study(study, Path(sys.argv[1]), cluster, solve=made_up)\n"
        "    assert (came.rows, came.failed) == (10_000, 0), came\n"
    )
    path = os.pathsep.join([str(Path(__file__).parents[1]), os.environ.get("PYTHONPATH", "")])
    subprocess.run(
        [sys.executable, str(script), str(tmp_path)],
        check=True,
        timeout=900,
        env=ENVIRONMENT | {"PYTHONPATH": path},
    )
    memory = [line["client_memory"] for line in ledger(tmp_path) if line["event"] == "stored"]
    assert len(memory) == 2500
    # The first 500 fill what has a fixed length, like logs; after them a point costs nothing.
    assert memory[-1] - memory[500] < 30e6
