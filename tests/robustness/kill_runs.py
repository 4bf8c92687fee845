"""Runs killed with kill -9 at random moments and resumed; two run directories compared number by number.

Every second kill takes the run alone, the others its workers too; every third waits for a half-written file.
"""

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from verification.running.checked_files import PART, read_checked

# What a second run of the same case may measure differently: times, and what they are part of.
TIMES = ("seconds", "started", "diagnostics")
MARK = "COATCHECK_KILLED_BY"  # variable that every process of a run inherits, whoever its parent becomes
PATIENCE = 10.0  # s, for the end of a process whose parent was killed


def resumed(output: Path, cases: Sequence[str], jobs: int) -> subprocess.Popen[bytes]:
    """A run that goes on with what ``output`` holds, as the leader of a group of its own."""
    words = ["run", *cases, "--resume", "--quiet", "--jobs", str(jobs), "--output", str(output)]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    environment = os.environ | {MARK: str(os.getpid())}
    command = [sys.executable, "-m", "verification.cli", *words]
    return subprocess.Popen(command, start_new_session=True, env=environment, **quiet)


def whole(output: Path) -> dict[str, bytes]:
    """The finished cases with the content of their files. Raises StoreError for any stored file damaged."""
    for path in sorted(output.rglob("*.json")):
        if path.name != "report.json":
            read_checked(path)
    files = [path for folder in ("cases", "planes") for path in (output / folder).glob("*.json")]
    return {str(p): p.read_bytes() for p in files if (output / "cases" / p.name).exists()}


def descendants() -> list[int]:
    """Processes that runs of this process started, at any depth, and that still run."""
    mark, found = f"{MARK}={os.getpid()}".encode(), []
    for entry in Path("/proc").iterdir():
        with suppress(OSError):
            ours = entry.name.isdigit() and mark in (entry / "environ").read_bytes().split(b"\0")
            if ours and (entry / "stat").read_text().rpartition(")")[2].split()[0] != "Z":
                found.append(int(entry.name))
    return found


def kill_at(run: subprocess.Popen[bytes], output: Path, moment: float, *, aimed: bool, group: bool) -> bool:
    """Kill at the moment [s] or, ``aimed``, where a file is being written; False where the run had ended.

    Fails where a process of the run outlives it.
    """
    begin = time.monotonic()
    places = (output, *(output / name for name in ("cases", "planes")))
    while run.poll() is None and time.monotonic() - begin < moment * (3 if aimed else 1):
        late = aimed and time.monotonic() - begin > moment / 2
        if late and any(next(place.glob(f".*{PART}"), None) for place in places):
            break
        time.sleep(0.0005 if aimed else 0.005)
    if run.poll() is not None:
        return False
    for pid in [run.pid, *(descendants() if group else [])]:
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
    run.wait()
    deadline = time.monotonic() + PATIENCE
    while descendants() and time.monotonic() < deadline:
        time.sleep(0.01)
    assert not descendants()
    return True


def disturbed(output: Path, cases: Sequence[str], kills: int, longest: float, jobs: int) -> int:
    """Kill and resume a run ``kills`` times at most, then let it end; how often it was killed.

    longest : latest moment of a kill [s]. Fails where a finished case is lost or computed again.
    """
    rng = random.Random(8)
    kept: dict[str, bytes] = {}
    for number in range(kills):
        run = resumed(output, cases, jobs)
        killed = kill_at(run, output, rng.uniform(0, longest), aimed=number % 3 == 2, group=number % 2 == 1)
        found = whole(output)
        assert kept.items() <= found.items()
        kept = found
        if not killed:
            break
    resumed(output, cases, jobs).wait()
    assert kept.items() <= whole(output).items()
    assert [path.name for path in output.rglob(".*")] == [".lock"]
    return number + killed


def numbers(node: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Every leaf of a stored result but the times."""
    if isinstance(node, dict):
        for key, value in node.items():
            if key not in TIMES:
                yield from numbers(value, (*path, key))
    elif isinstance(node, list):
        for n, value in enumerate(node):
            yield from numbers(value, (*path, str(n)))
    else:
        yield path, node


def scale_of(payload: dict[str, Any], path: tuple[str, ...], value: float) -> float:
    """What a difference of the number at ``path`` is divided by: the scale that verdicts use, or itself."""
    scales = {"peak_pressure": "p_h", "contact_radius": "a_h", "approach": "delta_h"}
    if path[0] in ("verdicts", "invariants", "conversions"):
        return 1.0  # fractions of such scales already
    if path[0] == "profiles" and path[2] in ("value", "uncertainty"):
        return payload["problem"][scales.get(payload["profiles"][int(path[1])]["quantity"], "p_h")]
    if path[0] == "sources" and "budget" in path:
        return payload["problem"][
            scales.get(payload["sources"][int(path[1])]["budget"][int(path[3])][0], "p_h")
        ]
    return abs(value)


def largest_difference(one: Path, other: Path) -> tuple[float, int]:
    """Largest difference of the numbers of two run directories over their scales, and how many there were.

    Infinite where anything else differs: a verdict, a name, the number of values. Messages, which state
    figures in words, are not compared.
    """
    largest, count = 0.0, 0
    names = [{p.relative_to(folder) for p in folder.glob("cases/*.json")} for folder in (one, other)]
    if names[0] != names[1] or not names[0]:
        return float("inf"), 0
    for name in sorted(names[0]):
        payload = read_checked(one / name)
        a, b = dict(numbers(payload)), dict(numbers(read_checked(other / name)))
        if a.keys() != b.keys():
            return float("inf"), count
        count += len(a)
        for path, value in a.items():
            if value == b[path] or path[-1] in ("reason", "message"):
                continue
            if not (isinstance(value, float) and isinstance(b[path], float)):
                return float("inf"), count
            largest = max(largest, abs(value - b[path]) / scale_of(payload, path, value))
    return largest, count
