"""A scheduler with its workers as a person starts them, for tests that kill some."""

import json
import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

BIN = Path(sys.executable).parent
ENVIRONMENT = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def wait_until(condition, what, seconds=300):
    until = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < until, f"not within {seconds} s: {what}"
        time.sleep(0.05)


@contextmanager
def hand_started(folder, workers=2, threads=1, **variables):
    """``dask scheduler`` with ``dask worker``, as a person starts them; its address, the workers.

    threads : of each worker.   variables : of their environment, beside those of this process.
    """
    environment = ENVIRONMENT | variables
    there = folder / "scheduler.json"
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "start_new_session": True}
    common = ["--scheduler-file", str(there), "--host", "127.0.0.1", "--no-dashboard"]
    dask = str(BIN / "dask")
    started = [
        subprocess.Popen([dask, "scheduler", *common, "--port", "0"], env=environment, cwd=folder, **quiet)
    ]
    try:
        # The file is there before its content is.
        wait_until(lambda: there.exists() and there.read_text().strip().endswith("}"), "a scheduler", 60)
        for _ in range(workers):
            words = [dask, "worker", *common, "--nworkers", "1", "--nthreads", str(threads)]
            words += ["--local-directory", str(folder)]
            started.append(subprocess.Popen(words, env=environment, cwd=folder, **quiet))
        yield json.loads(there.read_text())["address"], started[1:]
    finally:
        for process in started:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
