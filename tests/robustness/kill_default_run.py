"""Kill a run with kill -9 at random moments, resume it each time, compare what it ends with with a calm run.

Every second kill takes the run alone, the others its workers too; every third waits for a half-written file.
"""

import json
import os
import random
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from verification.running.checked_files import PART, StoreError, read_checked

# What a second run of the same case may measure differently: times, and what they are part of.
TIMES = ("seconds", "started", "diagnostics")
MARK = "COATCHECK_KILLED_BY"  # variable that every process of a run inherits, whoever its parent becomes
PATIENCE = 10.0  # s, for the end of a process whose parent was killed


def resumed(output: Path, cases: Sequence[str], jobs: int) -> subprocess.Popen[bytes]:
    """A run that goes on with what ``output`` holds, as the leader of a group of its own."""
    words = ["run", *cases, "--resume", "--quiet", "--jobs", str(jobs), "--output", str(output)]
    return subprocess.Popen(
        [sys.executable, "-m", "verification.cli", *words],
        start_new_session=True,
        env=os.environ | {MARK: str(os.getpid())},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


def whole(output: Path) -> dict[str, bytes]:
    """The finished cases with the content of their files. Raises StoreError for any stored file damaged.

    A case is finished with its result, and its plane stands already; the study of a whole run is one more.
    """
    for path in sorted(output.rglob("*.json")):
        if path.name != "report.json":
            read_checked(path)
    found = {}
    for path in (*sorted((output / "cases").glob("*.json")), *output.glob("accuracy.json")):
        plane = output / "planes" / path.name
        found[path.name] = path.read_bytes() + (plane.read_bytes() if plane.exists() else b"")
    return found


def descendants() -> list[int]:
    """Processes that runs of this script started, at any depth, and that are still there."""
    mark, found = f"{MARK}={os.getpid()}".encode(), []
    for entry in Path("/proc").iterdir():
        with suppress(OSError):
            if entry.name.isdigit() and mark in (entry / "environ").read_bytes().split(b"\0"):
                found.append(int(entry.name))
    return found


def running(pid: int) -> bool:
    """True for a process that is there and no zombie."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def kill_at(
    run: subprocess.Popen[bytes], output: Path, moment: float, *, aimed: bool, group: bool
) -> Counter[str]:
    """Wait for the moment [s] or, ``aimed``, for a file being written; kill; count what was seen."""
    seen: Counter[str] = Counter()
    begin = time.monotonic()
    places = (output, *(output / name for name in ("cases", "planes")))
    while run.poll() is None and time.monotonic() - begin < moment * (3 if aimed else 1):
        writing = (place.glob(f".*{PART}") for place in places)
        if aimed and time.monotonic() - begin > moment / 2 and any(next(w, None) for w in writing):
            seen["while a file was written"] += 1
            break
        time.sleep(0.0005 if aimed else 0.005)
    if run.poll() is not None:
        seen["too late: the run had ended"] += 1
        return seen
    below = [pid for pid in descendants() if pid != run.pid]
    seen["with workers at work" if below else "without workers"] += 1
    for pid in [run.pid, *(below if group else [])]:
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:
            continue
    run.wait()
    deadline = time.monotonic() + PATIENCE
    # Looked up anew: a process may have been started after the look above.
    while any(map(running, descendants())) and time.monotonic() < deadline:
        time.sleep(0.01)
    for pid in filter(running, descendants()):
        seen["processes left over"] += 1
        words = Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0")
        sys.stdout.write(f"left over: {b' '.join(words).decode(errors='replace')}\n")
    seen["kills"] += 1
    return seen


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
        profile = payload["profiles"][int(path[1])]
        return payload["problem"][scales.get(profile["quantity"], "p_h")]
    if path[0] == "sources" and "budget" in path:
        quantity = payload["sources"][int(path[1])]["budget"][int(path[3])][0]
        return payload["problem"][scales.get(quantity, "p_h")]
    return abs(value)


def largest_difference(one: Path, other: Path) -> tuple[float, int]:
    """Largest difference of the numbers of two run directories over their scales, and how many there were.

    Infinite where anything else differs: a verdict, a name, the number of values.
    """
    largest, count = 0.0, 0
    names = [
        {p.relative_to(folder) for p in (*folder.glob("cases/*.json"), *folder.glob("accuracy.json"))}
        for folder in (one, other)
    ]
    if names[0] != names[1] or not names[0]:
        return float("inf"), 0
    for name in sorted(names[0]):
        payload = read_checked(one / name)
        a, b = dict(numbers(payload)), dict(numbers(read_checked(other / name)))
        if a.keys() != b.keys():
            return float("inf"), count
        for path, value in a.items():
            count += 1
            if value == b[path]:
                continue
            # A verdict says its figures in words too; those are compared as numbers.
            if path[-1] in ("reason", "message"):
                continue
            if not (isinstance(value, float) and isinstance(b[path], float)):
                return float("inf"), count
            largest = max(largest, abs(value - b[path]) / scale_of(payload, path, value))
    return largest, count


def disturbed(
    output: Path, cases: Sequence[str], kills: int, longest: float, jobs: int, total: int, seed: int = 8
) -> Counter[str]:
    """Kill and resume runs until ``kills`` are counted; where all is done a new directory is begun.

    longest : latest moment of a kill [s], as long as some cases are finished before.
    """
    rng = random.Random(seed)
    counts: Counter[str] = Counter()
    turn = 0
    while counts["kills"] < kills:
        folder = output / f"round-{turn}"
        kept: dict[str, bytes] = {}
        finished = False
        reporting = 0  # kills since the last case was finished
        idle = 0  # kills since any case was finished
        while counts["kills"] < kills and not finished and reporting < 3:
            run = resumed(folder, cases, jobs)
            number = counts["kills"]
            counts += kill_at(
                # On a machine too busy to finish a case meanwhile, moments come later until one is finished.
                run,
                folder,
                rng.uniform(0, longest * (1 + idle // 4)),
                aimed=number % 3 == 2,
                group=number % 2 == 1,
            )
            finished = run.returncode is not None and run.returncode >= 0
            try:
                found = whole(folder)
            except StoreError:
                counts["partial files under the name of a result"] += 1
                raise
            # A finished case stays as it is, to the letter: it was neither lost nor computed again.
            counts["finished cases lost"] += sum(kept[name] != found.get(name) for name in kept)
            counts["cases finished"] += len(found.keys() - kept.keys())
            reporting = reporting + 1 if found.keys() == kept.keys() and len(found) >= total else 0
            idle = 0 if found.keys() - kept.keys() else idle + 1
            kept = found
            sys.stdout.write(f"{counts['kills']} kills, round {turn}: {len(found)} of {total} cases\n")
            sys.stdout.flush()
        if not finished:
            run = resumed(folder, cases, jobs)
            code = run.wait()
            counts[f"last run of a round ended with {code}"] += 1
            found = whole(folder)
            counts["finished cases lost"] += sum(kept[name] != found.get(name) for name in kept)
        counts["rounds"] += 1
        json.loads((folder / "report.json").read_text())
        counts["half-written files left"] += sum(path.name != ".lock" for path in folder.rglob(".*"))
        turn += 1
    return counts
