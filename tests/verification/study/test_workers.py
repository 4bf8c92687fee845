"""Workers of a scheduler: what goes wrong with them is one message."""

import time
from dataclasses import replace

import pytest
from scheduler_by_hand import hand_started

from verification.study import dask_cluster
from verification.study.dask_cluster import Lost, SchedulerError


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    """Of a scheduler with one worker, in processes of their own."""
    with hand_started(tmp_path_factory.mktemp("worker"), 1) as (address, _):
        yield address


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


def test_another_program_is_named_by_what_differs():
    here = dask_cluster.provenance()
    assert replace(here, hardware="elsewhere").difference(here) == ""
    assert replace(here, code="0").difference(here)
    other = replace(here, code="0", versions=here.versions | {"numpy": "1.0"})
    assert {"numpy", "1.0", here.versions["numpy"]} <= set(other.difference(here).replace(",", "").split())


def test_workers_of_another_program_are_refused(address, monkeypatch):
    other = replace(dask_cluster.provenance(), code="0" * 64)
    monkeypatch.setattr(dask_cluster, "provenance", lambda: other)
    with (
        pytest.raises(SchedulerError, match="worker"),
        dask_cluster.connected(address, None),
    ):
        pass


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
