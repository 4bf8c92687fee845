"""One mutant tried in a copy of the source tree: checks of the default run with self-tests, then unit tests.

The copy also reaches what the code starts in processes of its own. Seconds are of the processor, so that no
mutant seems to hang on a busy machine.
"""

import functools
import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path
from typing import Any

from mutation.campaign import ROOMS, ROOT
from mutation.sites import mutated
from verification.credibility.faults.fault_trial import try_fault
from verification.evidence.mutant_record import Catch, Mutant, Trial
from verification.judging.outcome import Outcome
from verification.running.checked_files import StoreError, read_checked, write_checked
from verification.running.json_records import decode, encode
from verification.running.pool.pool_task import Task
from verification.running.pool.process_pool import THREAD_VARIABLES
from verification.running.provenance import CODE, fingerprint

KILLED = (128 + 9, 128 + 24)  # by the limit of processor time
WAITING = 10  # times that limit of wall time: a mutant that waits for ever uses no processor
# a mutant of the guard may kill every process that it sees: it sees those that it started
NAMESPACE = ("unshare", "--user", "--map-root-user", "--pid", "--fork", "--kill-child", "--mount-proc")
PYTEST = ("-m", "pytest", "-x", "-q", "--tb=line", "--hypothesis-seed=0", "-p", "no:cacheprovider")


def trial_task(room: str, mutant: Mutant | None, output: Path, limit: float) -> Task[Trial]:
    """The trial of ``mutant``, each of its two steps limited to ``limit`` seconds of the processor."""
    path = _path(room, mutant, output)
    work = partial(main, room, mutant, (output / "clean").absolute(), limit, path)

    def failed(reason: str, seconds: float) -> Trial:
        return Trial(room, mutant, Catch.NOT_TRIED, reason, seconds=seconds)

    return Task(path.stem, work, path, _stored, failed)


def kept_trial(room: str, mutant: Mutant | None, output: Path) -> Trial | None:
    """The trial of an earlier run by the same code, if it survived by the same tests; None without one."""
    try:
        data = read_checked(_path(room, mutant, output))
    except StoreError:
        return None
    trial = _stored(data)
    return trial if data["made_by"] == _made_by()[trial.caught] and trial.mutant == mutant else None


def _made_by() -> tuple[str, str]:
    """Of a trial that survived, of one that was caught."""
    return fingerprint((*CODE, "tests")), fingerprint(CODE)


def _path(room: str, mutant: Mutant | None, output: Path) -> Path:
    return output / "trials" / f"{mutant.name if mutant else f'control_{room}'}.json"


def _stored(data: dict[str, Any]) -> Trial:
    return decode(Trial, data["trial"])


def main(room: str, changed: Mutant | None, clean: Path, limit: float, path: Path) -> None:
    """Try the mutant of ``room``, None for no change, and store its trial at ``path``."""
    made_by = _made_by()  # before the source can change
    if changed and not _namespace() and "kill" in (ROOT / changed.file).read_text("utf-8"):
        trial = Trial(room, changed, Catch.NOT_TRIED, "may kill other processes: unshare(1) is needed")
    else:
        trial = try_mutant(room, changed, clean, limit)
    write_checked(path, {"made_by": made_by[trial.caught], "trial": encode(trial)})


def try_mutant(room: str, mutant: Mutant | None, clean: Path, limit: float, root: Path = ROOT) -> Trial:
    """Check a copy of ``root`` with ``mutant`` against the ``clean`` run, then by the tests of ``room``."""
    with tempfile.TemporaryDirectory(prefix="mutant-") as name:
        copy = Path(name)
        for part in (*CODE, "tests"):
            shutil.copytree(root / part, copy / part)
        shutil.copy(root / "pyproject.toml", copy)
        if mutant:
            path = copy / mutant.file
            path.write_text(mutated(path.read_text("utf-8"), mutant), "utf-8")
        change, changed = 0.0, ""
        catch, lines = _run(("-m", __name__, room, str(clean)), copy, limit, Catch.CRASH)
        if catch is Catch.SURVIVED:
            word, message, change, changed = json.loads(lines[-1])
            catch, lines = Catch(word), [message]
        if catch is Catch.SURVIVED:
            module = mutant.file.removesuffix(".py").replace("/", ".") if mutant else ""
            places = [copy / place for place in ROOMS[room].tests]
            files = [f for place in places for f in (sorted(place.rglob("test_*.py")) or [place])]
            files.sort(key=lambda file: module not in file.read_text("utf-8"))  # its own tests first
            catch, lines = _run((*PYTEST, *map(str, files)), copy, limit, Catch.TESTS)
    by = next((line for line in lines if line.startswith(("FAILED", "ERROR"))), lines[-1])[:400]
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return Trial(room, mutant, catch, by, change, changed, used.ru_utime + used.ru_stime)


@functools.cache
def _namespace() -> tuple[str, ...]:
    """Words before a command that give it processes of its own, none where the system has no such thing."""
    try:
        subprocess.run((*NAMESPACE, "true"), check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        return ()
    return NAMESPACE


def _run(words: tuple[str, ...], copy: Path, limit: float, failed: Catch) -> tuple[Catch, list[str]]:
    """What a process in ``copy`` found, ``failed`` for exit code 1, with the lines that it printed."""
    # the shell survives what is killed in the namespace, and returns its signal
    limited = ("sh", "-c", f'ulimit -t {limit:.0f}; "$@"; exit $?', "sh", sys.executable, *words)
    env = (
        os.environ
        | dict.fromkeys(THREAD_VARIABLES, "1")
        | {"PYTHONPATH": os.pathsep.join((str(copy), str(copy / "tests" / "tools")))}
    )
    try:
        done = subprocess.run(
            (*_namespace(), *limited),
            cwd=copy,
            env=env,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=WAITING * limit,
        )
    except subprocess.TimeoutExpired:
        return Catch.TIME, ["waits without using the processor"]
    lines = [line for line in (done.stderr + done.stdout).splitlines() if line.strip()] or ["no message"]
    found = {0: Catch.SURVIVED, 1: failed, **dict.fromkeys(KILLED, Catch.TIME)}
    return found.get(done.returncode, Catch.CRASH), lines


def checked(room: str, clean: Path) -> tuple[Catch, str, float, str]:
    """Catch, message, change and what changed, by the checks of the default run in this process."""
    trial = try_fault(ROOMS[room].checks, clean)
    # A changed number alone is no error, as with planted faults.
    bad = [check for check in trial.checks if not check.passed and check.column != "baseline"]
    answered = [check for check in bad if check.outcome is not Outcome.NO_RESULT]
    if not bad:
        return Catch.SURVIVED, "no check", trial.change, trial.changed
    catch = Catch.SELF_TESTS if {check.column for check in answered} == {"self-tests"} else Catch.CHECKS
    return (catch if answered else Catch.CRASH), (answered or bad)[0].message, trial.change, trial.changed


if __name__ == "__main__":
    print(json.dumps(checked(sys.argv[1], Path(sys.argv[2]))))  # noqa: T201 - read by the process above
