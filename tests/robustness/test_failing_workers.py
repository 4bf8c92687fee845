"""Workers that crash, hang or run out of memory: no result of their own, nobody else's lost, none left."""

import os
import re
import signal
import subprocess
import sys
import time
import weakref
from dataclasses import replace
from functools import partial
from pathlib import Path

import planted_worker
import pytest

from verification.running.checked_files import StoreError, read_checked, write_checked
from verification.running.pool import process_pool
from verification.running.pool.pool_task import Task
from verification.running.pool.process_pool import run_tasks

HERE = Path(__file__).parent
# What a process dies of, and how the reason must read.
REASONS = {
    "segmentation fault": r".*signal 11.*",
    "exit": r".*code 7\b.*",
    "exception": r".*code 1: RuntimeError: .*singular.*row 7",
    "abort": r".*signal 6.*",
    "memory": r".*code 1: .*memory.*--jobs.*",
    "kernel": r".*signal 9.*memory.*--jobs.*",
    "nothing": r".*no result.*",
    "hang": r".*\d+ s\b.*--time-limit.*",
}


@pytest.fixture(autouse=True)
def _planted(environment):
    places = [str(HERE), str(HERE.parent / "verification"), os.environ.get("PYTHONPATH", "")]
    environment(PYTHONPATH=os.pathsep.join(filter(None, places)))  # an empty one is the working directory


def task(how: str, folder: Path, number: int = 0) -> Task[str]:
    path = folder / f"{how}-{number}.json"
    return Task(
        path.stem,
        partial(planted_worker.main, how, str(path)),
        path,
        lambda data: data["said"],
        lambda reason, _: reason,
    )


def alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def gone(pids: list[int], within: float) -> None:
    """Fails where one of ``pids`` still runs after so many seconds."""
    begin = time.monotonic()
    while any(alive(pid) for pid in pids) and time.monotonic() - begin < within:
        time.sleep(0.02)
    assert not any(alive(pid) for pid in pids)


@pytest.mark.parametrize(
    ("cores", "jobs", "stated", "threads"),
    [(7, 2, "", "3"), (2, 3, "", "1"), (7, 2, "2", "2"), (7, 2, "9", "3"), (7, 2, "0", "1")],
)
def test_jobs_share_the_cores_each_has_one_at_least_and_no_more_than_stated(
    cores, jobs, stated, threads, tmp_path, monkeypatch, environment
):
    environment(**dict.fromkeys(process_pool.THREAD_VARIABLES, stated))
    monkeypatch.setattr(process_pool, "cores", lambda: cores)
    assert run_tasks([task("threads", tmp_path)], jobs=jobs, time_limit=300) == [threads]


def test_a_folder_named_as_a_method_in_the_working_directory_hides_nothing(tmp_path, monkeypatch):
    (tmp_path / "semianalytic").mkdir()
    (tmp_path / "semianalytic" / "__init__.py").touch()
    monkeypatch.chdir(tmp_path)
    assert run_tasks([task("method", tmp_path)], jobs=1, time_limit=300) == ["solve"]


def test_each_death_has_its_reason_and_the_others_finish(tmp_path):
    deaths = [how for how in REASONS if how != "hang"]
    tasks = [task(how, tmp_path) for how in (*deaths, "good")]
    *reasons, good = run_tasks(tasks, jobs=4, time_limit=300)
    assert good == "good"
    for how, reason in zip(deaths, reasons, strict=True):
        assert re.fullmatch(REASONS[how], reason), (how, reason)


def test_hanging_worker_is_stopped_with_what_it_started(tmp_path):
    # The good one ends long before; only what hangs meets the limit.
    reason, good = run_tasks([task("hang", tmp_path), task("good", tmp_path)], jobs=2, time_limit=3)
    assert good == "good"
    assert re.fullmatch(REASONS["hang"], reason)
    pids = [int(pid) for pid in (tmp_path / "hang-0.json.pids").read_text().split()]
    assert len(pids) == 2
    gone(pids, within=10)


def test_worker_that_cannot_write_ends_the_run_with_one_sentence(tmp_path):
    write_checked(tmp_path / "good-0.json", {"said": "earlier"})
    (tmp_path / "file").write_text("in the way")
    blocked = Task(
        "x", partial(planted_worker.main, "good", tmp_path / "file" / "x.json"), tmp_path / "x", str, str
    )
    with pytest.raises(StoreError, match="written"):
        run_tasks([blocked], jobs=1, time_limit=300)
    assert read_checked(tmp_path / "good-0.json") == {"said": "earlier"}


def test_failing_worker_leaves_the_earlier_file_and_does_not_pass_it_off_as_its_own(tmp_path):
    nothing = task("nothing", tmp_path)
    write_checked(nothing.path, {"said": "earlier"})
    assert re.fullmatch(REASONS["nothing"], run_tasks([nothing], jobs=1, time_limit=300)[0])
    assert read_checked(nothing.path) == {"said": "earlier"}


def test_tasks_together_run_in_one_process_which_a_failed_one_alone_leaves(tmp_path):
    hows = ["process", "process", "abort", "process", "process"]
    tasks = [replace(task(how, tmp_path, n), together="one process") for n, how in enumerate(hows)]
    first, second, died, third, fourth = run_tasks(tasks, jobs=2, time_limit=300)
    assert first == second
    assert re.fullmatch(REASONS["abort"], died)
    assert third == fourth
    assert third not in (first, str(os.getpid()))


def test_costly_tasks_start_first(tmp_path):
    order: list[str] = []
    tasks = [replace(task("good", tmp_path, n), cost=cost) for n, cost in enumerate((1.0, 3.0, 0.0, 2.0))]
    assert run_tasks(tasks, jobs=1, time_limit=300, started=order.append) == ["good"] * 4
    assert order == ["good-1", "good-3", "good-0", "good-2"]


def test_process_that_cannot_be_started_is_a_reason(tmp_path, monkeypatch):
    def refuse(*_, **__):
        raise OSError(12, "full")

    monkeypatch.setattr(subprocess, "Popen", refuse)
    (reason,) = run_tasks([task("good", tmp_path)], jobs=1, time_limit=300)
    assert "full" in reason


def hang_in(folder: str) -> None:
    run_tasks([task("hang", Path(folder), n) for n in range(2)], jobs=2, time_limit=600)


def test_workers_of_a_killed_run_end_with_it(tmp_path):
    code = "import sys, test_failing_workers as t; t.hang_in(sys.argv[1])"
    parent = subprocess.Popen([sys.executable, "-c", code, str(tmp_path)], env=os.environ)
    said = [tmp_path / f"hang-{n}.json.pids" for n in range(2)]
    begin = time.monotonic()
    while not all(path.exists() and path.read_text().endswith("\n") for path in said):
        assert parent.poll() is None, "the run ended before its workers had begun"
        assert time.monotonic() - begin < 60
        time.sleep(0.02)
    pids = [int(pid) for path in said for pid in path.read_text().split()]
    assert len(pids) == 4
    assert all(alive(pid) for pid in pids)
    parent.send_signal(signal.SIGKILL)
    parent.wait()
    gone(pids, within=5)


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("waiting", [1, 0], ids=["a task waits", "every result is kept"])
def test_ctrl_c_in_the_clean_up_of_an_import_stops_the_run_too(tmp_path, waiting):
    """Python drops an exception that a callback of a weak reference raises, as of the lock of an import."""

    class Lock:
        pass

    def clean_up(_):
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(0.01)

    def meanwhile():
        lock = Lock()
        kept = weakref.ref(lock, clean_up)
        del lock
        assert kept() is None

    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored below nohup and the like
    try:
        with pytest.raises(KeyboardInterrupt):
            run_tasks([task("hang", tmp_path)] * waiting, jobs=1, time_limit=3, meanwhile=meanwhile)
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)
