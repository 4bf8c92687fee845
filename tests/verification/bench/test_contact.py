"""The benchmark's own arithmetic, and that its judge tells a solution from a guess."""

import numpy as np
import pytest

from verification.bench import contact as bench


def row(solver, patches, seconds, **changes):
    values = {
        "threads": 1,
        "repeats": (seconds,),
        "gap": 1e-7,
        "penetration": 0.0,
        "load": 0.0,
        "iterations": 5,
        "convolutions": 9,
        "full_convolution": 0.1,
        "memory": 80.0,
    }
    return bench.BenchRow(solver=solver, patches=patches, seconds=seconds, **{**values, **changes})


def test_ratios_are_ratios():
    rows = [row("semianalytic", 100, 1.0), row("tamaas", 100, 50.0), row("semianalytic", 200, 4.0)]
    found = dict(bench.ratios(rows))
    assert found["solve / tamaas, N = 100, threads 1"] == pytest.approx(0.02)
    assert found["solve / full convolution, N = 200, threads 1"] == pytest.approx(40)
    assert found["semianalytic: time grows as N^, threads 1"] == pytest.approx(2)


def test_every_peer_has_its_ratio_and_growth_counts_from_256():
    rows = [row("semianalytic", 256, 1.0), row("semianalytic", 1024, 16.0, iterations=6)]
    rows += [row("aspher", 1024, 40.0)]
    found = dict(bench.ratios(rows))
    assert found["solve / aspher, N = 1024, threads 1"] == pytest.approx(0.4)
    assert found["iterations over those at N = 256, N = 1024, threads 1"] == pytest.approx(1.2)


def test_memory_of_the_stresses_of_a_plane_is_counted_by_patches():
    (found,) = bench.run_plane(sizes=(96,), repeats=3)
    assert 6 < found.memory * 6 < 60
    assert found.ratio > 0


def test_judge_accepts_hertz_roughly_and_no_guess():
    n = 128
    x = bench._centres(n)
    r2 = x[:, None] ** 2 + x[None, :] ** 2
    hertz = 2 / np.pi * np.sqrt(np.maximum(1 - r2, 0))
    gap, penetration, load = bench._judge(hertz)
    # the exact pressure on patches: discretisation of the edge, a few per cent of a patch
    assert gap < 2e-2
    assert penetration < 2e-2
    assert load < 1e-3
    guess = np.where(r2 < 1, 4 / 3 / np.pi, 0.0)
    assert bench._judge(guess)[0] > 0.1
    assert not row("semianalytic", 64, 1.0, gap=2e-6).passes


def test_a_measurement_satisfies_the_judge():
    (found,) = bench.run_bench(sizes=(64,), threads=(1,), repeats=1, solvers=("semianalytic",))
    assert found.passes
    assert found.convolutions <= 16


def test_a_failing_child_is_an_error_with_its_last_words():
    with pytest.raises(RuntimeError, match="KeyError"):
        bench.run_bench(sizes=(64,), threads=(1,), repeats=1, solvers=("nobody",))


def check_coated(sizes, ratios, thicknesses):
    rows = bench.run_coated(sizes=sizes, modulus_ratios=(1.0, *ratios), thicknesses=thicknesses)
    found = dict(bench.coated_ratios(rows))
    for n in sizes:
        # the figure asked; times are for the benchmark to judge
        assert found[f"iterations of coated solids, most / homogeneous, N = {n}"] <= 1.5
        assert found[f"setting up coefficients / the whole solve, most, N = {n}"] > 0
    assert max(row.convolutions for row in rows) <= 16


def test_coated_solids_take_about_the_iterations_of_the_homogeneous():
    # the film that took most, and its opposites
    check_coated((128, 256), (0.1, 10.0), (0.05, 1.0))


@pytest.mark.slow
def test_coated_solids_take_about_the_iterations_of_the_homogeneous_over_the_range():
    check_coated((128, 256, 512, 1024), (0.1, 0.25, 0.5, 2.0, 4.0, 10.0), (0.05, 0.1, 0.3, 1.0, 3.0))
