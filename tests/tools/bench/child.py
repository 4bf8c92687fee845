"""Child process of the benchmark: one piece of work, timed whenever its standard input requires it.

It runs as a file, with the packages of any commit on PYTHONPATH, and calls their public functions alone.
Each turn is a problem of its own, moduli and depths changed by parts in a thousand, so that no cache of one
turn serves the next. What a turn prepares is not timed. Turn 0 loads what all turns share. A sphere, of which
no solver keeps anything, is solved again and again for ``SHORT`` seconds, and the quickest counts: the first
few hundredths of a second after another process measure the caches of the machine. Works that may be equal,
on one thread and on two, are told apart in one process: two processes differ by a hundredth of themselves.

Input: a number of a turn, or "judge", in a line. Output: an object of JSON in a line; where a work measures
a ratio itself, with that.
"""

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from importlib import import_module
from importlib.metadata import Distribution, PackageNotFoundError
from pathlib import Path
from statistics import median
from types import ModuleType
from typing import Any

sys.path.append(str(Path(__file__).resolve().parents[1]))  # beside the packages that are measured
Prepared = Callable[[], Any]  # what is timed

RADIUS, LOAD, FRICTION = 10e-3, 20.0, 0.3  # m, N
DEPTHS = 200  # points of the line across depths
SHORT = 0.25  # s
LONG = 10.0  # s, in which equal spheres of N = 512 differ by up to 0.5 %


def public(name: str) -> ModuleType:
    """A package of the commit that is measured. Raises ImportError where another one is found."""
    module = import_module(name)
    if not Path(str(module.__file__)).is_relative_to(os.environ["PYTHONPATH"]):
        raise ImportError(f"{name} is imported from {module.__file__}, not from {os.environ['PYTHONPATH']}")
    return module


def hide(name: str) -> None:
    """Make a distribution look as if it were not installed; to be called before a package looks for it."""
    from_name = Distribution.from_name

    def found(wanted: str) -> Distribution:
        if wanted == name:
            raise PackageNotFoundError(name)
        return from_name(wanted)

    Distribution.from_name = found  # type: ignore[method-assign, assignment]
    sys.modules[name] = None  # type: ignore[assignment]


def problem(turn: int) -> dict[str, Any]:
    """Steel under a coating four times as stiff, about as thick as the contact is wide."""
    coating = (840e9 * (1 + 1e-3 * turn), 0.3, 85e-6)
    return {"radius": RADIUS, "load": LOAD, "coatings": (coating,), "substrate": (210e9, 0.3)}


def solve(turn: int, uncertainty: bool) -> Prepared:
    """Semi-analytical solve at its defaults."""
    semianalytic = public("semianalytic")
    return lambda: semianalytic.solve(**problem(turn), estimate_uncertainty=uncertainty)


def stress(turn: int) -> Prepared:
    """Stresses with their uncertainty on a line that crosses the depths of coating and substrate."""
    import numpy as np

    solution = public("semianalytic").solve(**problem(turn), friction=FRICTION)
    x = np.linspace(-1.5, 1.5, DEPTHS) * solution.contact_radius
    z = np.linspace(0.01, 2.0 + 1e-3 * turn, DEPTHS) * solution.contact_radius
    return lambda: solution.stress_with_uncertainty(x, 0.0, z)


def elements(turn: int, friction: float, fast: bool) -> Prepared:
    """Finite elements at their defaults, with the factorisation of the extra "fast" or without it."""
    if not fast:
        hide("mkl")  # of versions before 0.3
        hide("pypardiso")
    fem_reference = public("fem_reference")
    return lambda: fem_reference.solve(**problem(turn), friction=friction)


def default_run(turn: int, *cases: str) -> Prepared:
    """The command ``coatcheck run`` of the shipped ``cases``, with its report; nothing in turn 0."""
    if not turn:
        return lambda: None
    shipped = Path(os.environ["PYTHONPATH"], "verification", "cases")
    files = [str(next(shipped.rglob(f"{name}.toml"))) for name in cases]

    def run() -> None:
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
            command = [sys.executable, "-m", "verification.cli", "run", *files, "--output", folder]
            # Elsewhere than in a checkout, whose packages would come before those on PYTHONPATH.
            subprocess.run(command, stdout=subprocess.DEVNULL, check=False, cwd=folder)
            # Its verdicts, so its exit code, are those of another machine and of other versions.
            if not Path(folder, "report.json").exists():
                raise RuntimeError("coatcheck run wrote no report")

    return run


def sphere(turn: int, solver: str, patches: int, threads: int) -> Prepared:
    """A sphere on a homogeneous half-space by one of ``bench.peers``; turn 0 is a small one."""
    solved = import_module("bench.peers").SOLVERS[solver]
    return lambda: solved(patches if turn else 64, threads)


def more_threads(turn: int, patches: int, few: int, many: int) -> Prepared:
    """Seconds of ``contact`` on ``many`` threads over those on ``few``, the median of ``LONG`` seconds."""
    solved = import_module("bench.peers").SOLVERS["contact"]

    def seconds(threads: int) -> float:
        began = time.perf_counter()
        solved(patches, threads)
        return time.perf_counter() - began

    def ratio() -> float:
        found: list[float] = []
        first = time.perf_counter()
        while not found or (turn and time.perf_counter() - first < LONG):
            # in this order what drifts changes both alike
            a, b, c, d = (seconds(threads) for threads in (few, many, many, few))
            found.append((b + c) / (a + d))
        return median(found)

    return ratio


def judge(result: Any) -> float:
    """Worst residual of pressures of a sphere, 0 of any other result; see ``bench.judge``."""
    if not hasattr(result, "shape"):
        return 0.0
    return float(import_module("bench.judge").residual(result))


def processor_seconds() -> float:
    """Processor time of this process with those that it has started."""
    usages = map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)


def timed(prepared: Prepared, enough: float) -> tuple[Any, dict[str, float]]:
    """The last result, and the seconds of the quickest of the calls begun within ``enough`` seconds."""
    found: list[dict[str, float]] = []
    first = time.perf_counter()
    while not found or time.perf_counter() - first < enough:
        result = None  # the memory of the last one
        processor, began = processor_seconds(), time.perf_counter()
        result = prepared()
        seconds = time.perf_counter() - began
        found.append({"seconds": seconds, "processor": processor_seconds() - processor})
    return result, min(found, key=lambda one: one["seconds"])


def main() -> None:
    """Answer the lines of standard input; the arguments are the name of a function above and its own."""
    # What a library prints goes to standard error.
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)
    work, arguments = globals()[sys.argv[1]], json.loads(sys.argv[2])
    result = None
    for line in sys.stdin:
        if line.strip() == "judge":
            answer = {"residual": judge(result)}
        else:
            result, answer = timed(work(int(line), *arguments), SHORT if work is sphere else 0.0)
            if isinstance(result, float):
                answer["ratio"] = result
            answer["peak"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024.0  # bytes
        answers.write(json.dumps(answer) + "\n")


if __name__ == "__main__":
    main()
