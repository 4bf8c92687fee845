"""Tasks of another machine, run by a worker of a scheduler in processes of their own."""

import tempfile
from collections import deque
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from verification.running.pool.pool_task import Task, paths_of, with_paths
from verification.running.pool.process_pool import Slot, wait_for
from verification.running.provenance import Provenance, provenance

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
