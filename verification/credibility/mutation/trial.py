"""One mutant tried in a copy of the source tree: checks of the default run with self-tests, then unit tests.

The copy also reaches what the code starts in processes of its own. Seconds are of the processor, so that no
mutant seems to hang on a busy machine.
"""

import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from verification.credibility.faults.trial import try_fault
from verification.credibility.mutation.record import ROOMS, ROOT, Catch, Trial
from verification.credibility.mutation.sites import Mutant, mutated
from verification.judging.outcome import Outcome
from verification.running.pool import THREAD_VARIABLES, Task
from verification.running.provenance import CODE, fingerprint
from verification.running.records import decode, encode
from verification.running.store import StoreError, read_checked, write_checked

KILLED = (-9, -24)  # by the limit of processor time
PYTEST = ("-m", "pytest", "-x", "-q", "--tb=line", "--hypothesis-seed=0", "-p", "no:cacheprovider")


def trial_task(room: str, mutant: Mutant | None, output: Path, limit: float) -> Task[Trial]:
    """The trial of ``mutant``, each of its two steps limited to ``limit`` seconds of the processor."""
    words = (room, json.dumps(encode(mutant) if mutant else None), str(output.absolute()), str(limit))

    def failed(reason: str, seconds: float) -> Trial:
        catch = Catch.TIME if "not finished" in reason else Catch.NOT_TRIED
        return Trial(room, mutant, catch, reason, seconds=seconds)

    path = _path(room, mutant, output)
    return Task(path.stem, (f"{__name__}:main", *words), path, _stored, failed)


def kept_trial(room: str, mutant: Mutant | None, output: Path) -> Trial | None:
    """The trial of an earlier run by the same code, if it survived by the same tests; None without one."""
    try:
        data = read_checked(_path(room, mutant, output))
        trial = _stored(data)
    except (StoreError, ValueError, KeyError):
        return None
    same = data.get("made_by") == fingerprint() and (trial.caught or data.get("tests") == _tests())
    return trial if same and trial.mutant == mutant else None


def _tests() -> str:
    return fingerprint(("tests",), ())


def _path(room: str, mutant: Mutant | None, output: Path) -> Path:
    return output / "trials" / f"{mutant.name if mutant else f'control_{room}'}.json"


def _stored(data: dict[str, Any]) -> Trial:
    return decode(Trial, data["trial"])


def main(room: str, mutant: str, output: str, limit: str) -> None:
    """Try the ``mutant`` of ``room`` given as JSON, null for none, and store its trial in ``output``."""
    content = json.loads(mutant)
    trial = try_mutant(
        room, decode(Mutant, content) if content else None, Path(output) / "clean", float(limit)
    )
    made = {"made_by": fingerprint(), "tests": _tests()}
    write_checked(_path(room, trial.mutant, Path(output)), made | {"trial": encode(trial)})


def try_mutant(room: str, mutant: Mutant | None, clean: Path, limit: float, root: Path = ROOT) -> Trial:
    """Check a copy of ``root`` with ``mutant`` against the ``clean`` run, then by the tests of ``room``."""
    with tempfile.TemporaryDirectory(prefix="mutant-") as name:
        copy = Path(name)
        for part in (*CODE, "tests"):
            if (root / part).exists():
                shutil.copytree(root / part, copy / part)
        shutil.copy(root / "pyproject.toml", copy)
        if mutant:
            path = copy / mutant.file
            path.write_text(mutated(path.read_text("utf-8"), mutant), "utf-8")
        catch, by, (change, changed) = Catch.SURVIVED, "", (0.0, "")
        done = _run(("-m", __name__, room, str(clean)), copy, limit)
        if done.returncode:
            catch, by = _stopped(done, Catch.CRASH)
        else:
            found, by, change, changed = json.loads(done.stdout.splitlines()[-1])
            catch = Catch(found)
        if catch is Catch.SURVIVED:
            module = mutant.file.removesuffix(".py").replace("/", ".") if mutant else ""
            places = [copy / place for place in ROOMS[room].tests]
            files = [f for place in places for f in (sorted(place.rglob("test_*.py")) or [place])]
            files.sort(key=lambda file: module not in file.read_text("utf-8"))  # its own tests first
            done = _run((*PYTEST, *map(str, files)), copy, limit)
            if done.returncode:
                catch, by = _stopped(done, Catch.TESTS)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return Trial(room, mutant, catch, by, float(change), changed, used.ru_utime + used.ru_stime)


def _run(words: tuple[str, ...], copy: Path, limit: float) -> subprocess.CompletedProcess[str]:
    limited = ("sh", "-c", f'ulimit -t {limit:.0f}; exec "$@"', "sh", sys.executable, *words)
    env = os.environ | dict.fromkeys(THREAD_VARIABLES, "1") | {"PYTHONPATH": str(copy)}
    return subprocess.run(
        limited, cwd=copy, env=env, stdin=subprocess.DEVNULL, capture_output=True, text=True
    )


def _stopped(done: subprocess.CompletedProcess[str], otherwise: Catch) -> tuple[Catch, str]:
    """What caught a mutant whose process failed, with the line that says why."""
    lines = [line for line in (done.stdout + done.stderr).splitlines() if line.strip()] or ["no message"]
    named = [line for line in lines if line.startswith(("FAILED", "ERROR"))]
    by = (named or lines[-1:])[0][:400]
    if done.returncode in KILLED:
        return Catch.TIME, "its limit of processor time"
    return (Catch.CRASH if done.returncode != 1 else otherwise), by


def checked(room: str, clean: Path) -> tuple[str, str, float, str]:
    """Catch, message, change and what changed, by the checks of the default run in this process."""
    trial = try_fault(ROOMS[room].checks, clean)
    # A changed number alone is no error, as with planted faults.
    bad = [check for check in trial.checks if not check.passed and check.column != "baseline"]
    answered = [check for check in bad if check.outcome is not Outcome.NO_RESULT]
    if not bad:
        catch = Catch.SURVIVED
    elif not answered:
        catch = Catch.CRASH
    else:
        catch = Catch.SELF_TESTS if all(c.column == "self-tests" for c in answered) else Catch.CHECKS
    first = (answered or bad)[:1]
    return catch, "".join(check.message for check in first), trial.change, trial.changed


if __name__ == "__main__":
    print(json.dumps(checked(sys.argv[1], Path(sys.argv[2]))))  # noqa: T201 - read by the process above
