"""Workers of a Dask scheduler, a local or a named one, with requests submitted a few at a time."""

import gc
import logging
import signal
import threading
import time
import warnings
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, TypeVar

from verification.running.case_result import message_of
from verification.running.pool.process_pool import THREAD_VARIABLES
from verification.running.provenance import cores, provenance

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
CONTINUE = "what is finished is kept: run the command again"
# By name, so that a process without this program can answer too.
PROBE = "__import__('verification.running.provenance', fromlist=['']).provenance()"
# With Dask's own setting every freed array is returned to the system, and a third of the time is spent on
# allocating anew; the memory kept between solves here is bounded too.
MALLOC = {"MALLOC_ARENA_MAX": 1, "MALLOC_MMAP_THRESHOLD_": 2**25, "MALLOC_TRIM_THRESHOLD_": 2**26}


class SchedulerError(ConnectionError):
    """A scheduler or its workers that cannot be used; the message says why."""


@dataclass(frozen=True)
class Lost:
    """A request that no worker could answer, for this ``reason``."""

    reason: str


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
        with _silent_logs():
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
) -> Generator[tuple[T, Any], None, None]:
    """What ``function`` answers on the workers, as the answers come: each with what its request was for.

    requests : key, request, what for. A bounded number is submitted at a time; those that are when the
    iteration ends are cancelled. What no worker can answer is Lost.
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
