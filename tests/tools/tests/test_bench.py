"""The benchmark: what judges the pressures, threads that cost no time, ratios of turns, failures."""

import json

import bench
import ducc0
import numpy as np
import pytest
from cyclopts import App


def test_a_second_thread_is_not_used_where_it_costs_time(monkeypatch):
    """Of a contact on 512 patches a side no transform is large enough; of 2048 some are."""
    used = set()
    for name in ("dct", "r2c", "c2c", "c2r"):
        transform = getattr(ducc0.fft, name)

        def counted(*arrays, nthreads, transform=transform, **options):
            used.add(nthreads)
            return transform(*arrays, nthreads=nthreads, **options)

        monkeypatch.setattr(ducc0.fft, name, counted)

    two = bench.contact(512, 2)
    assert used == {1}
    np.testing.assert_array_equal(two, bench.contact(512, 1))
    bench.contact(2048, 2)
    assert used == {1, 2}


def test_a_solve_in_its_own_process_satisfies_the_judge_and_a_failure_is_a_message():
    found = bench.solved("contact", 64, 1)
    assert found["seconds"] > 0
    assert 0 < found["residual"] <= bench.LIMIT
    with pytest.raises(RuntimeError, match="no_such_code"):
        bench.solved("no_such_code", 64, 1)


def test_ratios_are_taken_turn_by_turn_and_a_failure_keeps_the_rest(monkeypatch, capsys):
    times = iter((1.0, 2.0, 4.0, 5.0, 3.0, 30.0))  # contact, convolution, in each of three turns

    def solved(solver, patches, threads):
        if patches == 128:
            raise RuntimeError("no memory")
        return {"seconds": next(times), "residual": 0.0}

    monkeypatch.setattr(bench, "find_spec", lambda name: None)
    monkeypatch.setattr(bench, "solved", solved)
    app = App(result_action="return_value")
    app.default(bench.bench)
    assert app(["--sizes", "64", "128", "--threads", "1", "--rounds", "3", "--json"]) == 3
    out, err = capsys.readouterr()
    assert "no memory" in err
    (row,) = json.loads(out)["ratios"]
    assert (row["patches"], row["over"]) == (64, "convolution")
    assert [row[name] for name in ("lowest", "median", "highest")] == [0.1, 0.5, 0.8]
