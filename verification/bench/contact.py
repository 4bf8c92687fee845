"""Cost of the semi-analytical contact in time, in memory, beside that of its peers.

A rigid sphere on a homogeneous half-space, not periodic, on the square [-2a, 2a]^2 of N x N patches, solved
by ``semianalytic.indent``, by the Polonsky-Keer solver of tamaas with its DC-FFT operator, and by aspher as
it is fastest (nested grids, FFT operator, FFT preconditioner). All are held to one judge that is none's: the
patch pressures are put through Love's coefficients coded here, and gap in contact, penetration (over the
approach) and load have to be met within ``JUDGE``. Every measurement is a process of its own with the threads
set from outside, so that peak memory and threads mean what they say.

Results are ratios. The seconds belong to the machine they were measured on.
"""

import json
import os
import resource
import subprocess
import sys
import time
import tracemalloc
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from importlib import import_module
from importlib.util import find_spec
from itertools import product
from statistics import median
from typing import Any, TypeVar

import numpy as np
from scipy.fft import irfft2, next_fast_len, rfft2

from verification.problem.arrays import FloatArray

JUDGE = 1e-6
ENOUGH = 120.0  # seconds of one measurement after which it is not repeated
SIZES = (128, 256, 512, 1024, 2048)
A, R, E_STAR = 1.0, 1.0, 1.0  # lengths in contact radii, moduli in E*
W = 4 / 3 * E_STAR * A**3 / R
# tolerances with which each solver just meets the judge; all measure their own gap, over their own scale
TOLERANCE = {"semianalytic": 8e-7, "tamaas": 1e-6, "aspher": 1e-7}
PEERS = ("tamaas", "aspher")
Coatings = tuple[tuple[float, float, float], ...]
T = TypeVar("T")


@dataclass(frozen=True)
class BenchRow:
    """One solver on one grid; lengths over the approach, times in seconds, memory in bytes a grid point.

    gap, penetration, load : what the judge found.  iterations, convolutions : on the finest grid, -1 when not
    told.  full_convolution : one padded real convolution of the same N by the FFT of ducc0.
    memory : growth of the peak resident set by the solve.
    """

    solver: str
    patches: int
    threads: int
    seconds: float
    repeats: tuple[float, ...]
    gap: float
    penetration: float
    load: float
    iterations: int
    convolutions: int
    full_convolution: float
    memory: float

    @property
    def passes(self) -> bool:
        """Whether the judge is satisfied."""
        return max(self.gap, self.penetration, self.load) <= JUDGE


@dataclass(frozen=True)
class CoatedRow:
    """Iterations on the finest grid of a coated solid, and the time its influence coefficients take."""

    modulus_ratio: float
    thickness: float
    patches: int
    iterations: int
    convolutions: int
    seconds: float
    setup_seconds: float


@dataclass(frozen=True)
class PlaneRow:
    """Six stresses of one depth below every patch, beside six inverse real FFTs of the padded size; medians.

    seconds, transforms : for one pressure.  setup_seconds : of the influence, once for all pressures.
    memory : largest arrays held at a time, over those of the six results.
    """

    patches: int
    seconds: float
    transforms: float
    setup_seconds: float
    memory: float

    @property
    def ratio(self) -> float:
        """Stresses over transforms."""
        return self.seconds / self.transforms


def run_bench(
    *,
    sizes: Sequence[int] = SIZES,
    threads: Sequence[int] = (1, 2),
    repeats: int = 5,
    solvers: Sequence[str] | None = None,
    progress: Callable[[str], None] | None = None,
) -> list[BenchRow]:
    """Measure every solver on every grid with every number of threads.

    solvers : among "semianalytic", "tamaas" and "aspher"; None takes those that are installed.
    progress : called with a line before each measurement.
    Raises RuntimeError with the child's last words when a measurement fails.
    """
    if solvers is None:
        solvers = [name for name in TOLERANCE if find_spec(name)]
    rows = []
    for patches, count, solver in product(sizes, threads, solvers):
        if progress:
            progress(f"{solver}, {patches} x {patches} patches, {count} thread{'s' * (count > 1)}")
        rows.append(_measure(solver, patches, count, repeats))
    return rows


def ratios(rows: Sequence[BenchRow]) -> list[tuple[str, float]]:
    """Figures of merit: ratios to the peer and to a full convolution, growth with N, memory."""
    found = []
    by = {(row.solver, row.patches, row.threads): row for row in rows}
    for (solver, patches, threads), row in by.items():
        where = f"N = {patches}, threads {threads}"
        if solver == "semianalytic":
            found.append((f"solve / full convolution, {where}", row.seconds / row.full_convolution))
            for name in PEERS:
                peer = by.get((name, patches, threads))
                if peer:
                    found.append((f"solve / {name}, {where}", row.seconds / peer.seconds))
            found.append((f"convolutions on the finest grid, {where}", float(row.convolutions)))
            coarser = by.get((solver, 256, threads))
            if coarser and patches > 256:
                growth = row.iterations / coarser.iterations
                found.append((f"iterations over those at N = 256, {where}", growth))
        found.append((f"{solver}: bytes per grid point, {where}", row.memory))
    for solver, threads in sorted({(row.solver, row.threads) for row in rows}):
        line = [(row.patches, row.seconds) for row in rows if (row.solver, row.threads) == (solver, threads)]
        if len(line) > 1:
            n, seconds = np.log(np.array(line)).T
            growth = float(np.polyfit(n, seconds, 1)[0])
            found.append((f"{solver}: time grows as N^, threads {threads}", growth))
    return found


def run_coated(
    *,
    sizes: Sequence[int] = (512,),
    modulus_ratios: Sequence[float] = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 10.0),
    thicknesses: Sequence[float] = (0.05, 0.1, 0.3, 1.0, 3.0),
) -> list[CoatedRow]:
    """Iterations and set-up of coated solids on such grids; thickness in uncoated contact radii."""
    return [_coated(patches, ratio, h) for patches in sizes for ratio in modulus_ratios for h in thicknesses]


def coated_ratios(rows: Sequence[CoatedRow]) -> list[tuple[str, float]]:
    """Iterations over those of equal moduli on the same grid, set-up over the solve; the largest of each."""
    found = []
    for patches in sorted({row.patches for row in rows}):
        here = [row for row in rows if row.patches == patches]
        bare = min(row.iterations for row in here if row.modulus_ratio == 1)
        most = max(row.iterations for row in here)
        found.append((f"iterations of coated solids, most / homogeneous, N = {patches}", most / bare))
        setup = max(row.setup_seconds / row.seconds for row in here)
        found.append((f"setting up coefficients / the whole solve, most, N = {patches}", setup))
    return found


def _coated(patches: int, ratio: float, h: float) -> CoatedRow:
    coatings = ((ratio * E_STAR, 0.0, h * A),)
    half_width = 2 * A * max(1.0, ratio ** (-1 / 3))
    seconds, s = _timed(lambda: _indented(patches, half_width, coatings))
    loaded = np.flatnonzero(s.patch_pressure.any(axis=1))
    n = int(1.1 * (loaded[-1] - loaded[0]))
    setup, _ = _timed(lambda: _set_up(n, 2 * half_width / patches, coatings))
    d = s.diagnostics
    return CoatedRow(ratio, h, patches, d.iterations, d.convolutions, seconds, setup)


def _timed(work: Callable[[], T]) -> tuple[float, T]:
    """Seconds that ``work`` takes, and its result."""
    began = time.perf_counter()
    found = work()
    return time.perf_counter() - began, found


def run_plane(*, sizes: Sequence[int] = (256, 512), repeats: int = 9) -> list[PlaneRow]:
    """Time the six stresses at the interface of a sliding coating, against six transforms, taken in turns."""
    return [_plane(patches, repeats) for patches in sizes]


def _plane(patches: int, repeats: int) -> PlaneRow:
    from semianalytic import subsurface
    from semianalytic.inputs import Body

    x = (np.arange(patches) - (patches - 1) / 2) * (2.2 * A / patches)
    pressure = np.sqrt(np.maximum(1 - (x[:, None] ** 2 + x[None, :] ** 2) / A**2, 0))
    body = Body(((4 * E_STAR, 0.3, 0.3 * A),), (E_STAR, 0.3), 0.25)
    setup, plane = _timed(lambda: subsurface.stress_plane(0.3 * A, 0, grid_x=x, grid_y=x, body=body))
    wave = plane.spectrum[0].copy()
    ours, theirs = [], []
    for _ in range(repeats):
        ours.append(_timed(lambda: plane(pressure))[0])
        theirs.append(_timed(lambda: [irfft2(wave, plane.size) for _ in range(6)])[0])
    tracemalloc.start()
    result = plane(pressure)
    memory = tracemalloc.get_traced_memory()[1] / result.nbytes
    tracemalloc.stop()
    return PlaneRow(patches, median(ours), median(theirs), setup, memory)


def _set_up(n: int, d: float, coatings: Coatings) -> None:
    """The coefficients of an n x n window."""
    from semianalytic import frf, halfspace, influence

    def excess(k: FloatArray) -> FloatArray:
        return frf.compliance_excess(k, coatings, (E_STAR, 0.0))

    thickness = [h for _, _, h in coatings]
    image = influence.split_image(excess, thickness)
    halfspace.surface_deflection(n, n, d, d)
    halfspace.surface_deflection(n, n, d, d, image[1])
    influence.remainder_coefficients(n, d, excess, thickness, image)


def _measure(solver: str, patches: int, threads: int, repeats: int) -> BenchRow:
    """Run this file as a child and read its row."""
    environment = {**os.environ, "OMP_NUM_THREADS": str(threads), "OPENBLAS_NUM_THREADS": str(threads)}
    words = (solver, *map(str, (patches, threads, repeats)))
    command = [sys.executable, "-m", "verification.bench.contact", *words]
    child = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if child.returncode:
        last = (child.stderr.strip().splitlines() or ["no message"])[-1]
        raise RuntimeError(f"{solver} on {patches} x {patches} patches failed: {last}")
    row = json.loads(child.stdout.splitlines()[-1])
    return BenchRow(**row | {"repeats": tuple(row["repeats"])})


def _child(solver: str, patches: int, threads: int, repeats: int) -> BenchRow:
    run = {"semianalytic": _semianalytic, "tamaas": _tamaas, "aspher": _aspher}[solver]
    run(64, threads)  # imports and plans are not what is measured
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    times = []
    for _ in range(repeats):
        seconds, (pressure, iterations, convolutions) = _timed(lambda: run(patches, threads))
        times.append(seconds)
        if sum(times) > ENOUGH:
            break
    memory = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) * 1024 / patches**2
    measured = (solver, patches, threads, median(times), tuple(times), *_judge(pressure))
    return BenchRow(*measured, iterations, convolutions, _full_convolution(patches, threads), memory)


def _sphere(x: FloatArray, y: FloatArray) -> FloatArray:
    return (x**2 + y**2) / (2 * R)


def _indented(patches: int, half_width: float, coatings: Coatings, **numerics: Any) -> Any:
    import semianalytic

    return semianalytic.indent(
        profile=_sphere,
        half_width=half_width,
        load=W,
        coatings=coatings,
        substrate=(E_STAR, 0.0),
        patches=patches,
        tolerance=TOLERANCE["semianalytic"],
        edge_correction=False,  # as the others: patches alone
        estimate_uncertainty=False,
        **numerics,
    )


def _semianalytic(patches: int, threads: int) -> tuple[FloatArray, int, int]:
    s = _indented(patches, 2 * A, (), threads=threads)
    return s.patch_pressure, s.diagnostics.iterations, s.diagnostics.convolutions


def _tamaas(patches: int, threads: int) -> tuple[FloatArray, int, int]:
    import tamaas

    tamaas.set_log_level(tamaas.LogLevel.warning)
    side = 4 * A
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [side, side], [patches, patches])
    model.E, model.nu = E_STAR, 0.0
    tamaas.ModelFactory.registerNonPeriodic(model, "dcfft")
    x = _centres(patches)
    solver = tamaas.PolonskyKeerRey(model, -_sphere(x[:, None], x[None, :]), TOLERANCE["tamaas"])
    solver.setIntegralOperator("dcfft")
    solver.max_iter = 10_000
    solver.solve(W / side**2)
    return np.array(model.traction), -1, -1


def _aspher(patches: int, threads: int) -> tuple[FloatArray, int, int]:
    aspher = import_module("aspher")  # no package index has it built
    x = _centres(patches)
    coarsest = patches
    while coarsest > 64 and coarsest % 2 == 0:
        coarsest //= 2
    result = aspher.solve_nested(
        grid_size=patches,
        gap=_sphere(x[:, None], x[None, :]).ravel(),
        p_nominal=W / (4 * A) ** 2,
        domain_size=4 * A,
        E_star=E_STAR,
        coarsest=coarsest,
        backend="fft",
        precond=True,
        precond_engine="fft",
        tol=TOLERANCE["aspher"],
    )
    pressure = np.array(result.pressure, dtype=float).reshape(patches, patches)
    return pressure, int(result.iterations), int(result.matvec_count)


def _centres(n: int) -> FloatArray:
    return (np.arange(n) - (n - 1) / 2) * (4 * A / n)


def _judge(pressure: FloatArray) -> tuple[float, float, float]:
    """(gap in contact, penetration) over the approach, and the relative error of the load."""
    n = len(pressure)
    d = 4 * A / n
    corner = np.arange(-0.5, n + 0.5)
    X, Y = corner[:, None], corner[None, :]
    # Love (1929): int int dx dy / r over a square, as the corner sum of X asinh(Y/|X|) + Y asinh(X/|Y|)
    f = X * np.arcsinh(Y / np.abs(X)) + Y * np.arcsinh(X / np.abs(Y))
    quadrant = np.diff(np.diff(f, axis=0), axis=1) * d / (np.pi * E_STAR)
    m = next_fast_len(2 * n - 1, real=True)
    kernel = np.zeros((m, m))
    kernel[:n, :n] = quadrant
    kernel[m - n + 1 :, :n] = quadrant[:0:-1]
    kernel[:, m - n + 1 :] = kernel[:, n - 1 : 0 : -1]
    u = irfft2(rfft2(kernel) * rfft2(pressure, s=(m, m)), s=(m, m))[:n, :n]
    x = _centres(n)
    g = u + _sphere(x[:, None], x[None, :])
    loaded = pressure > 0
    g -= (g[loaded].max() + g[loaded].min()) / 2  # the approach that suits the pressure best
    approach = A**2 / R
    return (
        float(np.abs(g[loaded]).max() / approach),
        float(max(0.0, -g[~loaded].min()) / approach),
        abs(float(pressure.sum()) * d * d / W - 1),
    )


def _full_convolution(n: int, threads: int) -> float:
    """Seconds of one real convolution on 2n x 2n, the shortest of five."""
    import ducc0

    field = np.zeros((2 * n, 2 * n))
    wave = np.zeros((2 * n, n + 1), dtype=complex)

    def convolve() -> None:
        ducc0.fft.r2c(field, axes=(0, 1), out=wave, nthreads=threads)
        np.multiply(wave, 1.0, out=wave)
        ducc0.fft.c2r(wave, axes=(0, 1), lastsize=2 * n, forward=False, out=field, nthreads=threads)

    return min(_timed(convolve)[0] for _ in range(5))


if __name__ == "__main__":
    sys.stdout.write(json.dumps(asdict(_child(sys.argv[1], *map(int, sys.argv[2:])))) + "\n")
