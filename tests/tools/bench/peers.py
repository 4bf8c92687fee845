"""A sphere on a homogeneous half-space, solved by ``semianalytic.indent`` or one of its peers.

The contact is not periodic, on the square [-2a, 2a]^2 of N x N patches: by ``semianalytic.indent``, by the
Polonsky-Keer solver of tamaas with its DC-FFT operator, by aspher as it is fastest (nested grids, FFT
operator, FFT preconditioner). Each has the tolerance with which it just meets ``judge.LIMIT``; all measure
their own gap, over their own scale. Every function returns the pressures of the patches, (N, N).

As a program: times one of them, whose name, patches a side and threads are its arguments.
"""

import json
import os
import sys
import time
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1]))  # where this file is run as a program

from bench.judge import E_STAR, RADIUS, A, W, gap, residual
from verification.problem.array_types import FloatArray

__all__ = ["SOLVERS", "timed"]

SHORT = 0.25  # s: the first hundredths of a second after another process measure the caches of the machine


def contact(patches: int, threads: int) -> FloatArray:
    """``semianalytic.indent`` by patches alone, as the others, without uncertainty."""
    found: FloatArray = (
        import_module("semianalytic")
        .indent(
            profile=lambda x, y: (x**2 + y**2) / (2 * RADIUS),
            half_width=2 * A,
            load=W,
            coatings=(),
            substrate=(E_STAR, 0.0),
            patches=patches,
            tolerance=8e-7,
            edge_correction=False,
            threads=threads,
            estimate_uncertainty=False,
        )
        .patch_pressure
    )
    return found


def tamaas(patches: int, threads: int) -> FloatArray:
    """tamaas, whose threads are those of OpenMP."""
    package = import_module("tamaas")
    package.set_log_level(package.LogLevel.warning)
    side = 4 * A
    model = package.ModelFactory.createModel(package.model_type.basic_2d, [side, side], [patches, patches])
    model.E, model.nu = E_STAR, 0.0
    package.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver = package.PolonskyKeerRey(model, -gap(patches), 1e-6)
    solver.setIntegralOperator("dcfft")
    solver.max_iter = 10_000
    solver.solve(W / side**2)
    return np.array(model.traction)


def aspher(patches: int, threads: int) -> FloatArray:
    """aspher, whose threads are those of OpenMP."""
    coarsest = patches
    while coarsest > 64 and coarsest % 2 == 0:
        coarsest //= 2
    result = import_module("aspher").solve_nested(
        grid_size=patches,
        gap=gap(patches).ravel(),
        p_nominal=W / (4 * A) ** 2,
        domain_size=4 * A,
        E_star=E_STAR,
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


if __name__ == "__main__":
    answer = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what a library prints
    answer.write(json.dumps(timed(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))) + "\n")
    answer.close()
