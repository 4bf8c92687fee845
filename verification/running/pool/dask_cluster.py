"""The workers of a Dask scheduler: requests submitted a few at a time, and tasks of a run among them.

A worker runs the tasks of another machine in processes of their own.
"""

import gc
import logging
import os
import signal
import tempfile
import threading
import time
import uuid
import warnings
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from verification.running.case_result import message_of
from verification.running.checked_files import MAX_BYTES, StoreError, read_bounded, write_atomically
from verification.running.pool.pool_task import Group, SchedulerError, Task, in_order, paths_of, with_paths
from verification.running.pool.process_pool import THREAD_VARIABLES, Slot, wait_for
from verification.running.provenance import Provenance, cores, provenance

Result = tuple[str, float]  # why there is none, or nothing; seconds


@dataclass(frozen=True)
class Request:
    """Tasks that share a process, with the files that they need.

    tasks : name, work, path, modules to import ahead of each.
    files : permissions and content of each, by its path on the machine that asks.
    code : fingerprint of the program that asks.
    """

    tasks: tuple[tuple[str, partial[None], Path, tuple[str, ...]], ...]
    files: dict[Path, tuple[int, bytes]]
    time_limit: float
    code: str


@dataclass(frozen=True)
class Reply:
    """The result of each task, with the ``files`` that they wrote, by their path on the machine that asks.

    Without results where the worker's program is another one.
    """

    made_by: Provenance
    results: tuple[Result, ...] = ()
    files: dict[Path, bytes] = field(default_factory=dict)


def serve(request: Request) -> Reply:
    """Run the tasks of ``request`` in a directory of their own, which holds copies of what they need."""
    mine = provenance()
    if mine.code != request.code:
        return Reply(mine)
    with tempfile.TemporaryDirectory(prefix="coatcheck-", ignore_cleanup_errors=True) as place:
        root = Path(place)
        for path, (mode, content) in request.files.items():
            copy = _within(root, path)
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(content)
            copy.chmod(mode)
        results = _run([_local(root, *task) for task in request.tasks], request.time_limit)
        return Reply(mine, results, _written(root, request))


def _within(root: Path, path: Path) -> Path:
    """Where the file or directory ``path`` of the machine that asks lies below ``root``."""
    return root / path.relative_to(path.anchor)


def _local(root: Path, name: str, work: partial[None], path: Path, ahead: tuple[str, ...]) -> Task[Result]:
    here = partial(_within, root)
    return Task(
        name,
        with_paths(work, here),
        here(path),
        lambda _: ("", 0.0),
        lambda *result: result,
        ahead=ahead,
    )


def _run(tasks: list[Task[Result]], time_limit: float) -> tuple[Result, ...]:
    """The results of ``tasks`` in one process, until the scheduler no longer wants them."""
    from verification.running.pool import dask_worker

    held, abandoned, results = dask_worker.kept(), dask_worker.abandoned(), []
    slot = held.idle.pop() if held and held.idle else Slot[Result](1)
    try:
        slot.owed = deque(enumerate(tasks))
        while slot.owed:
            slot.start()
            while (found := slot.poll(time_limit)) is None:
                wait_for([slot])
                if abandoned():
                    raise RuntimeError("stopped, since nobody waits for it any more")
            results.append(found[2])
    except BaseException:
        slot.close()
        raise
    if held:
        held.idle.append(slot)
    else:
        slot.close()
    return tuple(results)


def _written(root: Path, request: Request) -> dict[Path, bytes]:
    """New files at the paths that the tasks were given, or below them."""
    asked = {path for _, work, *_ in request.tasks for path in paths_of(work)}
    found = {}
    for copy in root.rglob("*"):
        path = Path("/", copy.relative_to(root))
        if path not in request.files and not asked.isdisjoint((path, *path.parents)) and copy.is_file():
            found[path] = copy.read_bytes()
    return found


T = TypeVar("T")

WINDOW = 3  # requests submitted at a time for each thread of the cluster
WAIT = 60.0  # s, for a worker
CONNECT_WITHIN = 5.0  # s, to a scheduler that was named
LOOK = 5.0  # s between two looks at the workers
POLL = 0.01  # s
DIED = "every worker that it was submitted to was killed, most likely for lack of memory"
REMEDY = (
    "install the same coatcheck and the same versions of its dependencies on the scheduler and every worker"
)
CONTINUE = "what is finished is kept: run the command again, with --resume where it has this option"
# By name, so that a process without this program can answer too.
PROBE = "__import__('verification.running.provenance', fromlist=['']).provenance()"
# With Dask's own setting every freed array is returned to the system, and a third of the time is spent on
# allocating anew; the memory kept between solves here is bounded too.
MALLOC = {"MALLOC_ARENA_MAX": 1, "MALLOC_MMAP_THRESHOLD_": 2**25, "MALLOC_TRIM_THRESHOLD_": 2**26}


@dataclass(frozen=True)
class Lost:
    """A request that no worker could answer, for this ``reason``."""

    reason: str


@dataclass
class Cluster:
    """The workers of the scheduler at ``address``, in place of processes on this machine.

    jobs : threads of the workers, once connected.   machines : hardware of those that answered.
    """

    address: str
    jobs: int = 0
    machines: set[str] = field(default_factory=set)

    def run(
        self,
        tasks: Sequence[Task[T]],
        *,
        time_limit: float,
        started: Callable[[str], None] = lambda name: None,
        finished: Callable[[str, T], None] = lambda name, result: None,
        meanwhile: Callable[[], object] = lambda: None,
    ) -> list[T]:
        """Run ``tasks`` as ``run_tasks`` does, on the workers.

        A task that ends its workers leaves what ``failed`` makes of that. Raises SchedulerError where the
        scheduler or all workers are gone or run another program; files of finished tasks are kept.
        """
        if not tasks:
            meanwhile()
            return []
        results: dict[int, T] = {}
        with connected(self.address, None) as client:
            from verification.running.pool.dask_worker import Kept

            client.register_plugin(Kept())
            self.jobs = max(self.jobs, sum(client.nthreads().values()))
            requests = _requests(tasks, time_limit, started)
            with closing(answers(client, serve, requests, meanwhile)) as arriving:
                for group, reply in arriving:
                    for number, result in self._taken(group, reply):
                        results[number] = result
                        finished(tasks[number].name, result)
        return [results[number] for number in range(len(tasks))]

    def _taken(self, group: Group[T], reply: Reply | Lost) -> Iterator[tuple[int, T]]:
        """Number and result of each task of ``group``, its files written."""
        if isinstance(reply, Lost):
            yield from ((number, task.failed(reply.reason, 0.0)) for number, task in group)
            return
        if differs := reply.made_by.difference(provenance()):
            raise SchedulerError(f"a worker of {self.address} runs another program: {differs}; {REMEDY}")
        self.machines.add(reply.made_by.hardware)
        last = {task.path for _, task in group}  # where a result lies, all that belongs to it does
        for path in sorted(reply.files, key=lambda path: path in last):
            write_atomically(path, reply.files[path])
        for (number, task), (reason, seconds) in zip(group, reply.results, strict=True):
            yield number, task.failed(reason, seconds) if reason else task.result(seconds)


def _requests(
    tasks: Sequence[Task[T]], time_limit: float, started: Callable[[str], None]
) -> Iterator[tuple[str, Request, Group[T]]]:
    """Key and request of each group of ``tasks``."""
    code = provenance().code
    for group in in_order(tasks):
        for _, task in group:
            started(task.name)
        needed = {_absolute(path) for _, task in group for path in task.needs()}
        commands = tuple(
            (task.name, with_paths(task.work, _absolute), _absolute(task.path), task.ahead)
            for _, task in group
        )
        request = Request(commands, _contents(needed), time_limit, code)
        # A key of its own: a worker may still be at the same task of a run that was stopped.
        yield f"{group[0][1].name}-{uuid.uuid4().hex}", request, group


def _absolute(path: Path) -> Path:
    return Path(os.path.abspath(path))


def _contents(paths: Iterable[Path]) -> dict[Path, tuple[int, bytes]]:
    """Permissions and content of the files at ``paths``. Raises StoreError where they are too large."""
    found, size = {}, 0
    for path in paths:
        content = read_bounded(path, MAX_BYTES)
        found[path] = path.stat().st_mode & 0o777, content
        size += len(content)
        if size > MAX_BYTES:
            raise StoreError(
                f"{path.parent}: more than {MAX_BYTES // 10**6} MB to send to a worker; leave out --scheduler"
            )
    return found


@contextmanager
def connected(scheduler: str | None, jobs: int | None) -> Iterator[Any]:
    """A client of the cluster at ``scheduler``, or of a local one of ``jobs`` processes.

    jobs : all cores unless given.
    Raises SchedulerError where there is no scheduler or no worker, or where one of them runs another program.
    """
    import dask
    from distributed import Client, LocalCluster

    # A client of an earlier study that is collected while a new one starts would wait for it forever.
    gc.collect()
    if scheduler is not None:
        # A request holds the files that a task needs.
        with _silent_logs(), dask.config.set({"distributed.admin.large-graph-warning-threshold": "1 GB"}):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # other versions of Dask work, or fail with a message
                try:
                    client = Client(scheduler, timeout=CONNECT_WITHIN, set_as_default=False)
                except (OSError, ValueError, TimeoutError) as error:
                    message = " ".join(str(error).split())[:200]
                    raise SchedulerError(
                        f"--scheduler {scheduler}: {message}; start one with: dask scheduler"
                    ) from None
            with client:
                _require_same_program(client)
                yield client
        return
    environment = {
        "distributed.nanny.pre-spawn-environ": MALLOC | dict.fromkeys(THREAD_VARIABLES, 1),
        # It stores an hour of profiles, 1 MB a solve, and takes a quarter of the time.
        "distributed.worker.profile.enabled": False,
        "distributed.admin.log-length": 100,
        "logging": {"distributed": "critical", "tornado": "critical"},
    }
    with _silent_logs(), dask.config.set(environment):
        with _interrupt_ignored():
            cluster = LocalCluster(
                n_workers=jobs or cores(),
                threads_per_worker=1,
                processes=True,
                host="127.0.0.1",
                dashboard_address="127.0.0.1:0",
                memory_limit=0,
                silence_logs=logging.CRITICAL,
            )
        with cluster, Client(cluster, set_as_default=False) as client:
            yield client


@contextmanager
def _interrupt_ignored() -> Iterator[None]:
    """Processes started here ignore Ctrl-C, which a terminal sends to all; the client acts on it."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def _silent_logs() -> Iterator[None]:
    """No log of Dask below "critical": failures of workers are reported here."""
    before = logging.root.manager.disable
    logging.disable(logging.ERROR)
    try:
        yield
    finally:
        logging.disable(before)


def _require_same_program(client: Any) -> None:
    """Raises SchedulerError where the scheduler or a worker runs another program than this process."""
    _wait_for_worker(client)
    mine = provenance()
    found = {f"worker {address}": one for address, one in client.run(eval, PROBE, on_error="return").items()}
    try:
        found["scheduler"] = client.run_on_scheduler(eval, PROBE)
    except Exception as error:
        found["scheduler"] = error
    for place, one in found.items():
        if isinstance(one, Exception):
            raise SchedulerError(f"the {place} lacks this coatcheck ({message_of(one)}); {REMEDY}")
        if differs := one.difference(mine):
            raise SchedulerError(f"the {place} runs another program: {differs}; {REMEDY}")


def _wait_for_worker(client: Any) -> None:
    try:
        client.wait_for_workers(1, timeout=WAIT)
    except TimeoutError:
        raise SchedulerError(
            f"no worker joined the scheduler within {WAIT:.0f} s; start one with: dask worker ADDRESS"
        ) from None


def answers(
    client: Any,
    function: Callable[[Any], Any],
    requests: Iterator[tuple[str, Any, T]],
    meanwhile: Callable[[], object] = lambda: None,
) -> Generator[tuple[T, Any], None, None]:
    """What ``function`` answers on the workers, as the answers come: each with what its request was for.

    requests : key, request, what for. A bounded number is submitted at a time; those that are when the
    iteration ends are cancelled. What no worker can answer is Lost.
    meanwhile : called once, when the first requests are submitted.
    Raises SchedulerError where the scheduler or all workers are lost, or lack this program.
    """
    from distributed import as_completed

    _wait_for_worker(client)
    workers, arriving = _Workers(client), as_completed(loop=client.loop)
    pending: dict[Any, T] = {}

    def submit() -> None:
        while len(pending) < WINDOW * workers.threads():
            if (following := next(requests, None)) is None:
                break
            key, request, item = following
            future = client.submit(function, request, key=key, pure=False)
            pending[future] = item
            arriving.add(future)

    try:
        submit()
        meanwhile()
        while pending:
            while not arriving.has_ready():
                time.sleep(POLL)
                workers.threads()
            future = next(arriving)
            yield pending.pop(future), _answer(future)
            future.release()
            submit()
    finally:
        if pending and client.status == "running":
            client.cancel(list(pending), force=True)


class _Workers:
    """Threads of the workers of a client, looked up every ``LOOK`` seconds: some may join, some end."""

    def __init__(self, client: Any) -> None:
        self.client, self.count = client, 0
        self.looked, self.seen = -LOOK, time.monotonic()

    def threads(self) -> int:
        """Their number; the last one where none is left, for ``WAIT`` seconds, then SchedulerError."""
        now = time.monotonic()
        if now - self.looked < LOOK:
            return self.count
        self.looked = now
        try:
            count = sum(self.client.nthreads().values())
        except OSError:
            return self.count  # the requests are about to be cancelled
        if count:
            self.count, self.seen = count, now
        elif now - self.seen > WAIT:
            raise SchedulerError(
                f"no worker has been left for {WAIT:.0f} s; start one with: dask worker ADDRESS; {CONTINUE}"
            )
        return self.count


def _answer(future: Any) -> Any:
    if future.cancelled():
        raise SchedulerError(f"the scheduler is lost; {CONTINUE}")
    error = future.exception()
    if error is None:
        return future.result()
    if type(error).__name__ == "KilledWorker":
        return Lost(DIED)
    if isinstance(error, ImportError | AttributeError):  # of loading the request
        raise SchedulerError(f"a worker lacks this coatcheck ({message_of(error)}); {REMEDY}")
    return Lost(message_of(error))
