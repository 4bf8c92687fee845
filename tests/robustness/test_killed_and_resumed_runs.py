"""Runs that are killed and resumed, or repeated, give the same numbers, to the last bit."""

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from case_texts import case_text

from verification.running.checked_files import PART, read_checked

QUICK = case_text(
    "E = 420e9; nu = 0.25; thickness_over_a_h = 0.8",
    more="friction = 0.1",
    tables='[semianalytic]\npatches = 65\n[fem_reference]\nquality = "fast"\n',
)

# What a second run of the same case may measure differently: times, and what they are part of.
TIMES = ("seconds", "started", "diagnostics")
MARK = "COATCHECK_KILLED_BY"  # variable that every process of a run inherits, whoever its parent becomes
PATIENCE = 10.0  # s, for the end of a process whose parent was killed


def resumed(output: Path, cases: Sequence[str]) -> subprocess.Popen[bytes]:
    """A run that goes on with what ``output`` holds, as the leader of a group of its own."""
    words = ["run", *cases, "--resume", "--quiet", "--jobs", "2", "--output", str(output)]
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


def disturbed(output: Path, cases: Sequence[str], kills: int, longest: float) -> int:
    """Kill and resume a run ``kills`` times at most, then let it end; how often it was killed.

    Every second kill takes the run alone, the others its workers too; every third waits for a partial file.
    longest : latest moment of a kill [s]. Fails where a finished case is lost or computed again.
    """
    rng = random.Random(8)
    kept: dict[str, bytes] = {}
    for number in range(kills):
        run = resumed(output, cases)
        killed = kill_at(run, output, rng.uniform(0, longest), aimed=number % 3 == 2, group=number % 2 == 1)
        found = whole(output)
        assert kept.items() <= found.items()
        kept = found
        if not killed:
            break
    resumed(output, cases).wait()
    assert kept.items() <= whole(output).items()
    assert [path.name for path in output.rglob(".*")] == [".lock"]
    return number + killed


def measured(node: Any) -> Any:
    """A stored result without the times."""
    if isinstance(node, dict):
        return {key: measured(value) for key, value in node.items() if key not in TIMES}
    return [measured(value) for value in node] if isinstance(node, list) else node


def cases_of(output: Path) -> dict[str, Any]:
    """Every stored case of a run directory without the times, by its name."""
    return {path.name: measured(read_checked(path)) for path in sorted(output.glob("cases/*.json"))}


def quick_cases(folder: Path, number: int) -> tuple[str, ...]:
    for n in range(number):
        (folder / f"quick-{n}.toml").write_text(QUICK.replace("420e9", f"{n + 1}00e9"))
    return tuple(str(folder / f"quick-{n}.toml") for n in range(number))


@pytest.mark.slow
def test_runs_killed_and_resumed_lose_nothing_and_end_with_the_same_numbers(tmp_path):
    cases, began = quick_cases(tmp_path, 4), time.perf_counter()
    assert resumed(tmp_path / "calm", cases).wait() in (0, 4)
    quarter = (time.perf_counter() - began) / 4  # four of them cannot hold the work of the run
    assert disturbed(tmp_path / "rough", cases, kills=10, longest=quarter) >= 4
    assert cases_of(tmp_path / "calm") == cases_of(tmp_path / "rough")
    assert len(cases_of(tmp_path / "calm")) == 4
