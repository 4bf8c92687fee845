"""Tasks on workers of an executor: one killed in the middle costs nothing but time, and no number changes."""

import os
import re
import signal
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from contextlib import ExitStack
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest
from quick_case import QUICK
from test_failing_workers import REASONS, _planted, task

from verification.cases.case_file import parse_case
from verification.commands.common.command_error import CommandError
from verification.commands.common.task_progress import executor_at
from verification.running.case_tasks import case_task
from verification.running.checked_files import write_checked
from verification.running.pool import executor_tasks
from verification.running.pool.process_pool import run_tasks

__all__ = ["_planted"]  # a fixture that each test here uses


def pool(stack: ExitStack) -> tuple[Executor, list[int]]:
    """Two workers in processes of their own, with their numbers."""
    executor = stack.enter_context(ProcessPoolExecutor(2, mp_context=get_context("spawn")))
    for _ in range(2):
        executor.submit(abs, 1)
    pids = list(executor._processes)
    # a worker killed while it waited for work keeps the lock of the queue: the other would never end
    stack.callback(lambda: [process.kill() for process in (executor._processes or {}).values()])
    return executor, pids


def cluster(stack: ExitStack) -> tuple[Executor, list[int]]:
    """The same on a scheduler of Dask, reached by its address."""
    distributed = pytest.importorskip("distributed")
    nodes = stack.enter_context(
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    )
    executor = stack.enter_context(executor_at(nodes.scheduler_address))
    return executor, list(executor._client.run(os.getpid).values())


@pytest.mark.parametrize("workers", [pool, cluster])
def test_a_worker_killed_in_the_middle_loses_nothing_and_changes_no_number(workers, tmp_path):
    cases = [
        parse_case(QUICK.replace("420e9", f"{n + 1}00e9").encode(), Path(f"quick_{n}.toml")) for n in range(4)
    ]
    alone = run_tasks([case_task(case, tmp_path / "alone") for case in cases], jobs=2, time_limit=300)
    names: list[str] = []
    with ExitStack() as stack:
        executor, pids = workers(stack)

        def finished(name: str, _: object) -> None:
            if not names:
                os.kill(pids[0], signal.SIGKILL)
            names.append(name)

        tasks = [case_task(case, tmp_path / "cluster") for case in cases]
        found = run_tasks(tasks, jobs=2, time_limit=300, executor=executor, finished=finished)
    assert sorted(names) == [case.name for case in cases]
    for one, other in zip(alone, found, strict=True):
        assert one.profiles
        assert one.outcome is other.outcome
        for then, now in zip(one.profiles, other.profiles, strict=True):
            np.testing.assert_array_equal(now.value, then.value)


@pytest.fixture
def _process_ended():
    """Ends the process that a worker keeps as long as itself; here the worker is this process."""
    yield
    slot = executor_tasks._here.__dict__.pop("slot", None)
    if slot is not None:
        slot.stop()
        slot.errors.close()


class Elsewhere(Executor):
    """A worker in this process; ``change`` is done before each answer is given."""

    def __init__(self, change=lambda: None) -> None:
        self.change = change

    def submit(self, work, /, *given):
        future = Future()
        try:
            answer = work(*given)
            self.change()
            future.set_result(answer)
        except Exception as error:
            future.set_exception(error)
        return future


@pytest.mark.usefixtures("_process_ended")
def test_a_task_that_fails_on_a_worker_has_the_reason_of_one_that_fails_here(tmp_path):
    hows = ("exception", "hang", "good", "abort")
    *reasons, died = run_tasks(
        [task(how, tmp_path) for how in hows], jobs=1, time_limit=3, executor=Elsewhere()
    )
    assert reasons.pop() == "good"
    for how, reason in zip(("exception", "hang", "abort"), [*reasons, died], strict=True):
        assert re.fullmatch(REASONS[how], reason)


@pytest.mark.usefixtures("_process_ended")
@pytest.mark.parametrize("trouble", ["other file", "no file", "other versions"])
def test_what_a_worker_did_elsewhere_is_done_here_and_said(trouble, tmp_path, monkeypatch, capsys):
    (good,) = tasks = [task("good", tmp_path)]
    changes = {
        "other file": lambda: write_checked(good.path, {"said": "earlier"}),
        "no file": good.path.unlink,
        "other versions": lambda: None,
    }
    if trouble == "other versions":
        known = iter(["here", "there"])
        monkeypatch.setattr(executor_tasks, "fingerprint", lambda: next(known))
    assert run_tasks(tasks, jobs=1, time_limit=300, executor=Elsewhere(changes[trouble])) == ["good"]
    said = capsys.readouterr().err
    assert said.startswith("coatcheck: 1 task")
    assert ("versions" if trouble == "other versions" else "good-0.json") in said


@pytest.mark.slow
def test_a_scheduler_that_does_not_answer_is_one_sentence_with_what_to_do():
    for address in ("127.0.0.1:9", "nowhere"):
        with (
            pytest.raises(CommandError, match=f"--scheduler {address}: .*(pip install|dask scheduler)"),
            executor_at(address),
        ):
            raise AssertionError
