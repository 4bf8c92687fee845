"""A run on three workers started by hand, one of them killed, then stopped and resumed: real solves, slow."""

import json
import os
import signal
import subprocess
import sys

import pytest
from scheduler_by_hand import ENVIRONMENT, hand_started, wait_until

from verification.running.checked_files import read_checked
from verification.running.provenance import cores

CASES = ("01_uncoated_steel", "13_uncoated_sliding", "02_ratio_quarter", "07_thick")

pytestmark = pytest.mark.slow


def start(output, *more):
    words = ["run", *CASES, "--output", str(output), "--baseline", str(output / "none"), *more]
    return subprocess.Popen(
        [sys.executable, "-m", "verification.cli", *words],
        env=ENVIRONMENT,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # ignored below nohup and the like
    )


def finish(process, code=0):
    said, _ = process.communicate(timeout=900)
    assert process.returncode == code, said
    assert "Traceback" not in said
    return said


def stored(output):
    """Everything of each case and plane but the seconds, which are measurements."""

    def measured(part):
        if isinstance(part, dict):
            return {key: measured(one) for key, one in part.items() if "seconds" not in key}
        return [measured(one) for one in part] if isinstance(part, list) else part

    files = [path for folder in ("cases", "planes") for path in sorted((output / folder).glob("*.json"))]
    return {f"{path.parent.name}/{path.stem}": json.dumps(measured(read_checked(path))) for path in files}


def test_a_killed_worker_and_a_stopped_run_leave_the_same_bits_as_one_machine(tmp_path):
    # One thread a process, as on the workers.
    finish(start(tmp_path / "here", "--jobs", str(cores()), "--quiet"))
    here = stored(tmp_path / "here")
    assert len(here) == 2 * len(CASES)
    with hand_started(tmp_path, workers=3) as (address, workers):
        killed = start(tmp_path / "killed", "--scheduler", address)
        wait_until(lambda: stored(tmp_path / "killed"), "a finished case", 900)
        os.killpg(workers[0].pid, signal.SIGKILL)
        assert "4 cases in" in finish(killed)
        assert stored(tmp_path / "killed") == here

        stopped = start(tmp_path / "stopped", "--scheduler", address)
        wait_until(lambda: list((tmp_path / "stopped" / "cases").glob("*.json")), "a finished case", 900)
        stopped.send_signal(signal.SIGINT)
        assert "finished" in finish(stopped, 130)
        finished = {path: path.stat().st_mtime_ns for path in (tmp_path / "stopped" / "cases").iterdir()}
        assert 0 < len(finished) < len(CASES)
        finish(start(tmp_path / "stopped", "--scheduler", address, "--resume"))
        assert finished.items() <= {path: path.stat().st_mtime_ns for path in finished}.items()
        assert stored(tmp_path / "stopped") == here
