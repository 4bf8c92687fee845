"""A sphere on a homogeneous half-space solved by ``semianalytic.indent``, timed beside other codes.

The contact is not periodic, on the square [-2, 2]^2 of N x N patches; lengths are in contact radii, moduli
in E*. It is solved by ``semianalytic.indent``, by the Polonsky-Keer solver of tamaas with its DC-FFT
operator, by aspher as it is fastest (nested grids, FFT operator, FFT preconditioner). Each has the
tolerance with which it just meets ``LIMIT``; all measure their own gap, over their own scale. Every solver
returns the pressures of the patches, (N, N).

As a program: times one of them, whose name, patches a side and threads are its arguments.
"""

import json
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from statistics import median
from typing import Annotated, Any

import numpy as np
from cyclopts import Parameter
from rich.console import Console
from rich.markup import escape
from scipy.fft import irfft2, next_fast_len, rfft2

from verification.commands.common.shared_options import AsJson
from verification.commands.common.terminal import named_table, print_error, print_json, print_out
from verification.commands.common.terminal_bar import progress_bar
from verification.judging.outcome import Outcome
from verification.problem.array_types import FloatArray
from verification.regression.run_exit_codes import EXIT
from verification.running.provenance import PACKAGES, commit, machine, versions

LIMIT = 1e-6
LOAD = 4 / 3
SHORT = 0.25  # s: the first hundredths of a second after another process measure the caches of the machine
Numbers = Annotated[tuple[int, ...], Parameter(consume_multiple=True, negative="")]


def centres(n: int) -> FloatArray:
    """Centres of the ``n`` patches of a side."""
    return (np.arange(n) - (n - 1) / 2) * (4 / n)


def gap(n: int) -> FloatArray:
    """Height of the sphere over the patches, (n, n)."""
    x = centres(n)
    return (x[:, None] ** 2 + x[None, :] ** 2) / 2


def residual(pressure: FloatArray) -> float:
    """The largest of gap in contact and penetration, over the approach, and the relative error of the load.

    By Love's coefficients coded here, which are those of none of the solvers.   pressure : (n, n).
    """
    n = len(pressure)
    d = 4 / n
    corner = np.arange(-0.5, n + 0.5)
    X, Y = corner[:, None], corner[None, :]
    # Love (1929): int int dx dy / r over a square, as the corner sum of X asinh(Y/|X|) + Y asinh(X/|Y|)
    f = X * np.arcsinh(Y / np.abs(X)) + Y * np.arcsinh(X / np.abs(Y))
    quadrant = np.diff(np.diff(f, axis=0), axis=1) * d / np.pi
    m = next_fast_len(2 * n - 1, real=True)
    kernel = np.zeros((m, m))
    kernel[:n, :n] = quadrant
    kernel[m - n + 1 :, :n] = quadrant[:0:-1]
    kernel[:, m - n + 1 :] = kernel[:, n - 1 : 0 : -1]
    g = irfft2(rfft2(kernel) * rfft2(pressure, s=(m, m)), s=(m, m))[:n, :n] + gap(n)
    loaded = pressure > 0
    g -= (g[loaded].max() + g[loaded].min()) / 2  # the approach that suits the pressure best; it is 1
    load_error = abs(pressure.sum() * d * d / LOAD - 1)
    return max(float(np.abs(g[loaded]).max()), float(-g[~loaded].min()), float(load_error))


def contact(patches: int, threads: int) -> FloatArray:
    """``semianalytic.indent`` by patches alone, as the others, without uncertainty."""
    found = import_module("semianalytic").indent(
        profile=lambda x, y: (x**2 + y**2) / 2,
        half_width=2.0,
        load=LOAD,
        coatings=(),
        substrate=(1.0, 0.0),
        patches=patches,
        tolerance=8e-7,
        edge_correction=False,
        threads=threads,
        estimate_uncertainty=False,
    )
    return np.asarray(found.patch_pressure)


def tamaas(patches: int, threads: int) -> FloatArray:
    """tamaas, whose threads are those of OpenMP."""
    package = import_module("tamaas")
    package.set_log_level(package.LogLevel.warning)
    model = package.ModelFactory.createModel(package.model_type.basic_2d, [4.0, 4.0], [patches, patches])
    model.E, model.nu = 1.0, 0.0
    package.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver = package.PolonskyKeerRey(model, -gap(patches), 1e-6)
    solver.setIntegralOperator("dcfft")
    solver.max_iter = 10_000
    solver.solve(LOAD / 16)
    return np.array(model.traction)


def aspher(patches: int, threads: int) -> FloatArray:
    """aspher, whose threads are those of OpenMP."""
    coarsest = patches
    while coarsest > 64 and coarsest % 2 == 0:
        coarsest //= 2
    result = import_module("aspher").solve_nested(
        grid_size=patches,
        gap=gap(patches).ravel(),
        p_nominal=LOAD / 16,
        domain_size=4.0,
        E_star=1.0,
        coarsest=coarsest,
        backend="fft",
        precond=True,
        precond_engine="fft",
        tol=1e-7,
    )
    return np.array(result.pressure, dtype=float).reshape(patches, patches)


@cache
def _arrays(patches: int) -> tuple[FloatArray, Any]:
    """A field on 2N x 2N with its transform."""
    return np.zeros((2 * patches, 2 * patches)), np.zeros((2 * patches, patches + 1), dtype=complex)


def convolution(patches: int, threads: int) -> None:
    """One padded real convolution on 2N x 2N by the FFT of ducc0, no solve: the unit of cost of a solver."""
    fft: Any = import_module("ducc0").fft
    field, wave = _arrays(patches)
    fft.r2c(field, axes=(0, 1), out=wave, nthreads=threads)
    np.multiply(wave, 1.0, out=wave)
    fft.c2r(wave, axes=(0, 1), lastsize=2 * patches, forward=False, out=field, nthreads=threads)


PEERS = ("tamaas", "aspher")
SOLVERS = {work.__name__: work for work in (contact, convolution, tamaas, aspher)}


def timed(solver: str, patches: int, threads: int) -> dict[str, float]:
    """Seconds of the quickest solve of those begun within ``SHORT`` seconds, and the residual of the last."""
    solve = SOLVERS[solver]
    solve(64, threads)  # loads what all solves share
    seconds, first, pressure = np.inf, time.perf_counter(), None
    while not np.isfinite(seconds) or time.perf_counter() - first < SHORT:
        began, pressure = time.perf_counter(), None
        pressure = solve(patches, threads)
        seconds = min(seconds, time.perf_counter() - began)
    return {"seconds": seconds, "residual": 0.0 if pressure is None else residual(pressure)}


def solved(solver: str, patches: int, threads: int) -> dict[str, float]:
    """What ``timed`` gives in a process of its own. Raises RuntimeError with the last line of a failure."""
    counts = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), str(threads))
    words = [sys.executable, __file__, solver, str(patches), str(threads)]
    done = subprocess.run(words, capture_output=True, text=True, env=os.environ | counts, check=False)
    if done.returncode:
        raise RuntimeError(f"{solver} failed: {(done.stderr.strip().splitlines() or ['no message'])[-1]}")
    answer: dict[str, float] = json.loads(done.stdout)
    return answer


def bench(
    *,
    sizes: Annotated[Numbers, Parameter(name=["--sizes", "-N"])] = (512, 1024, 2048),
    threads: Numbers = (1, 2),
    rounds: int = 5,
    as_json: AsJson = False,
) -> int:
    """Time the contact of a sphere over that of other codes, over one convolution and over fewer threads.

    Each solve has a process of its own; those that are compared take turns, so that whatever slows the
    machine meets all of them alike. tamaas comes with the extra "bench", aspher with pip install aspher,
    which builds it; each is measured where installed. The exit code is 3 where a code fails or its pressures
    do not meet the common limit on the residual.

    Args:
        sizes: Patches along a side of the square [-2a, 2a]^2.
        threads: Numbers of threads.
        rounds: Turns of each solve; the median counts.
    """
    solvers = ["contact", "convolution", *filter(find_spec, PEERS)]
    rows: list[dict[str, Any]] = []
    failed = False
    with progress_bar(Console(stderr=True)) as bar:
        task = bar.add_task("", total=len(sizes) * rounds * len(threads) * len(solvers))
        for patches in sizes:
            turns: list[dict[tuple[str, int], dict[str, float]]] = []
            try:
                for _ in range(rounds):
                    turns.append({})
                    for key in ((solver, count) for count in threads for solver in solvers):
                        bar.update(task, advance=1, description=f"{key[0]}, N = {patches}")
                        turns[-1][key] = solved(key[0], patches, key[1])
            except RuntimeError as error:
                failed = True
                print_error(str(error))
                continue
            rows += compared(turns, patches, threads)
            failed |= max(one["residual"] for turn in turns for one in turn.values()) > LIMIT
    if as_json:
        made_by = {"commit": commit(), "machine": machine(), "versions": versions((*PACKAGES, *PEERS))}
        print_json(made_by | {"ratios": rows})
    elif rows:
        table = named_table("patches a side", "threads", "over", "median", "lowest", "highest", "residual")
        for row in rows:
            texts = (f"{value:.3g}" if isinstance(value, float) else str(value) for value in row.values())
            table.add_row(*map(escape, texts))
        print_out(table)
    return EXIT[Outcome.NO_RESULT if failed else Outcome.AGREES]


def compared(
    turns: Sequence[dict[tuple[str, int], dict[str, float]]], patches: int, threads: Sequence[int]
) -> list[dict[str, Any]]:
    """Ratios of the contact's seconds to those of every other solver, and to those on the fewest threads."""
    rows = []
    for count in threads:
        others = [(name, count) for name, of in turns[0] if of == count and name != "contact"]
        others += [("contact", threads[0])] if count != threads[0] else []
        for name, of in others:
            both = ("contact", count), (name, of)
            ratios = [turn[both[0]]["seconds"] / turn[both[1]]["seconds"] for turn in turns]
            over = name if name != "contact" else f"{of} thread{'s' * (of > 1)}"
            largest = max(turn[key]["residual"] for turn in turns for key in both)
            found = {"median": median(ratios), "lowest": min(ratios), "highest": max(ratios)}
            rows.append({"patches": patches, "threads": count, "over": over, **found, "residual": largest})
    return rows


if __name__ == "__main__":
    answer = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what a library prints
    answer.write(json.dumps(timed(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))) + "\n")
    answer.close()
