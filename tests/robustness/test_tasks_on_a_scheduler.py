"""Tasks on the workers of a scheduler: as on this machine, and what goes wrong there is one message."""

import datetime
import os
import re
import time
from dataclasses import replace
from functools import partial
from pathlib import Path

import planted_worker
import pytest
from planted_worker import end_kept_processes, kept_processes
from scheduler_by_hand import hand_started, wait_until
from test_failing_workers import REASONS, alive, gone, task

from verification.commands.common.command_error import CommandError
from verification.commands.common.task_progress import pool_of, run_info
from verification.running.checked_files import StoreError, read_checked, write_checked
from verification.running.pool import dask_cluster
from verification.running.pool.dask_cluster import Cluster, Lost
from verification.running.pool.pool_task import SchedulerError, Task
from verification.running.provenance import hardware

HERE = Path(__file__).parent


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    """Of a scheduler with one worker, in processes of their own."""
    folder = tmp_path_factory.mktemp("worker")
    places = [str(HERE), str(HERE.parent / "verification"), os.environ.get("PYTHONPATH", "")]
    with hand_started(folder, 1, PYTHONPATH=os.pathsep.join(places)) as (address, _):
        yield address


def test_a_worker_keeps_its_process_for_the_next_run_and_ends_it_with_itself(address, tmp_path):
    from distributed import Client

    kept = []
    with Client(address, set_as_default=False) as client:
        for n in range(2):
            Cluster(address).run([task("process", tmp_path, n)], time_limit=60.0)
            kept += client.run(kept_processes).values()
        first, second = kept
        assert len(first) == 1
        assert second == first
        assert alive(first[0])
        client.run(end_kept_processes)
        gone(first, within=10)
        assert list(client.run(kept_processes).values()) == [[]]


def test_tasks_run_as_on_this_machine(address, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "given.txt").write_text("content")
    given = Path("given.txt")
    copied = Task(
        "copy",
        partial(planted_worker.copy, given, Path("out/beside"), Path("out/copy.json")),
        Path("out/copy.json"),
        lambda data: data["said"],
        lambda reason, _: reason,
        cost=2.0,
        needs=lambda: (given,),
    )
    pair = [replace(task("process", tmp_path, n), together="one process") for n in range(2)]
    failing = task("exception", tmp_path)
    write_checked(failing.path, {"said": "earlier"})
    order, finished, calls = [], {}, []
    pool = Cluster(address)
    found = pool.run(
        [failing, *pair, copied],
        time_limit=60.0,
        started=order.append,
        finished=finished.__setitem__,
        meanwhile=lambda: calls.append(None),
    )
    reason, first, second, said = found
    assert said == "content"
    assert (tmp_path / "out" / "beside" / "more.txt").read_text() == "content"
    assert given.read_text() == "content"
    assert first == second != str(os.getpid())
    assert re.fullmatch(REASONS["exception"], reason)
    assert read_checked(failing.path) == {"said": "earlier"}
    assert order[0] == "copy"
    assert finished == dict(zip(["exception-0", "process-0", "process-1", "copy"], found, strict=True))
    assert len(calls) == 1
    info = run_info("command", datetime.datetime.now(datetime.UTC), pool)
    assert (info.jobs, info.machine) == (1, hardware())


def test_tasks_that_nobody_waits_for_end_with_their_processes(address, tmp_path):
    pids = []

    def said():
        return [int(pid) for path in tmp_path.rglob("*.pids") for pid in path.read_text().split()]

    def stop():
        wait_until(said, "the processes of a task", 60)
        pids.extend(said())
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        Cluster(address).run([task("hang", tmp_path / "out")], time_limit=60.0, meanwhile=stop)
    assert len(pids) == 2
    gone(pids, within=10)


class Future:
    """As one of Dask that ended with ``error``, or was cancelled."""

    def __init__(self, error=None):
        self.error = error

    def cancelled(self):
        return self.error is None

    def exception(self):
        return self.error


class KilledWorker(Exception):
    """As that of Dask."""


def test_a_request_that_a_worker_cannot_answer_is_a_reason():
    assert dask_cluster._answer(Future(KilledWorker())) == Lost(dask_cluster.DIED)
    lost = dask_cluster._answer(Future(OSError(28, "full")))
    assert lost == Lost("OSError: [Errno 28] full")
    with pytest.raises(SchedulerError, match="scheduler"):
        dask_cluster._answer(Future())
    with pytest.raises(SchedulerError, match="coatcheck"):
        dask_cluster._answer(Future(ModuleNotFoundError("No module named 'verification'")))
    (number, result), *_ = Cluster("")._taken([(7, task("good", Path()))], Lost("why"))
    assert (number, result) == (7, "why")


def test_another_program_is_named_by_what_differs():
    here = dask_cluster.provenance()
    assert replace(here, hardware="elsewhere").difference(here) == ""
    assert replace(here, code="0").difference(here)
    other = replace(here, code="0", versions=here.versions | {"numpy": "1.0"})
    assert {"numpy", "1.0", here.versions["numpy"]} <= set(other.difference(here).replace(",", "").split())
    with pytest.raises(SchedulerError, match="program"):
        list(Cluster("tcp://there:1")._taken([(0, task("good", Path()))], dask_cluster.Reply(other)))
    assert dask_cluster.serve(dask_cluster.Request((), {}, 1.0, "0")) == dask_cluster.Reply(here)


def test_workers_of_another_program_are_refused(address, monkeypatch):
    other = replace(dask_cluster.provenance(), code="0" * 64)
    monkeypatch.setattr(dask_cluster, "provenance", lambda: other)
    with (
        pytest.raises(SchedulerError, match="worker"),
        dask_cluster.connected(address, None),
    ):
        pass


def test_workers_without_the_program_are_refused(address, monkeypatch):
    monkeypatch.setattr(dask_cluster, "PROBE", "__import__('no_such_package')")
    with (
        pytest.raises(SchedulerError, match="coatcheck"),
        dask_cluster.connected(address, None),
    ):
        pass


def test_files_too_large_to_send_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(dask_cluster, "MAX_BYTES", 10)
    large = [tmp_path / name for name in "ab"]
    for path in large:
        path.write_text("sixsix")
    with pytest.raises(StoreError, match="worker"):
        dask_cluster._contents(large)


def test_no_worker_is_one_message(monkeypatch, tmp_path):
    monkeypatch.setattr(dask_cluster, "WAIT", 0.05)
    with (
        hand_started(tmp_path, 0) as (empty, _),
        pytest.raises(SchedulerError, match="scheduler"),
        dask_cluster.connected(empty, None),
    ):
        pass


def test_workers_that_all_leave_end_the_wait(monkeypatch):
    monkeypatch.setattr(dask_cluster, "LOOK", 0.0)
    monkeypatch.setattr(dask_cluster, "WAIT", 0.0)

    class Client:
        def __init__(self):
            self.threads = {"one": 2}

        def nthreads(self):
            return self.threads

    client = Client()
    workers = dask_cluster._Workers(client)
    assert workers.threads() == 2
    client.threads = {}
    time.sleep(0.001)
    with pytest.raises(SchedulerError, match="worker"):
        workers.threads()


def test_jobs_are_of_this_machine():
    assert pool_of(3, 1.0, None) == 3
    assert pool_of(None, 1.0, "tcp://there:1") == Cluster("tcp://there:1")
    with pytest.raises(CommandError, match="jobs = 3"):
        pool_of(3, 1.0, "tcp://there:1")
