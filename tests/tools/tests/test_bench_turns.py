"""Children of the benchmark: in turn, each on the packages of its own commit, failures with their message."""

import ducc0
import numpy as np
import pytest
from bench import turns
from bench.judge import LIMIT, centres, residual
from bench.peers import SOLVERS
from bench.turns import Work, in_turn

PACKAGE = """
from pathlib import Path
def solve(*, coatings, **problem):
    print("a library's own words")
    with (Path(__file__).parent / "log").open("a") as log:
        log.write(f"{coatings[0][0]:.6g} {problem['estimate_uncertainty']}\\n")
"""


@pytest.fixture
def commit(tmp_path):
    """A folder with a package of that name, which notes what it is called with."""
    (tmp_path / "semianalytic").mkdir()
    (tmp_path / "semianalytic" / "__init__.py").write_text(PACKAGE)
    return tmp_path


def test_a_child_solves_another_problem_in_each_turn(commit):
    seen = []
    found = in_turn({"here": Work("solve", (True,), commit)}, 2, progress=seen.append)["here"]
    assert (commit / "semianalytic" / "log").read_text().split("\n") == [
        "8.4e+11 True",
        "8.4084e+11 True",
        "8.4168e+11 True",
        "",
    ]
    assert seen == ["here"] * 3
    assert len(found.seconds) == len(found.processor) == 2
    assert found.residual == 0
    assert found.of(True) == found.processor


def test_turns_alternate_and_end_after_long(monkeypatch):
    seen = []

    class Child:
        def __init__(self, name, work):
            self.name = name

        def __enter__(self):
            return self

        def __exit__(self, *_):
            seen.append(f"{self.name} ended")

        def answer(self, line):
            seen.append(f"{self.name}{line}")
            return {"seconds": 1.0, "processor": 1.0, "peak": 1.0, "residual": 0.0}

    monkeypatch.setattr(turns, "_Child", Child)
    works = {"A": Work("solve"), "B": Work("solve")}
    in_turn(works, 2)
    assert seen == ["A0", "B0", "A1", "B1", "A2", "B2", "Ajudge", "Bjudge", "B ended", "A ended"]
    assert len(in_turn(works, 5, enough=-1.0)["A"].seconds) == 1


def test_a_second_thread_is_not_used_where_it_costs_time(monkeypatch):
    """Of a contact on 512 patches a side no transform is large enough; of 2048 some are."""
    used = set()
    for name in ("dct", "r2c", "c2c", "c2r"):
        transform = getattr(ducc0.fft, name)

        def counted(*arrays, nthreads, transform=transform, **options):
            used.add(nthreads)
            return transform(*arrays, nthreads=nthreads, **options)

        monkeypatch.setattr(ducc0.fft, name, counted)

    two = SOLVERS["contact"](512, 2)
    assert used == {1}
    np.testing.assert_array_equal(two, SOLVERS["contact"](512, 1))
    SOLVERS["contact"](2048, 2)
    assert used == {1, 2}


def test_judge_accepts_hertz_roughly_and_no_guess():
    x = centres(128)
    r2 = x[:, None] ** 2 + x[None, :] ** 2
    hertz = 2 / np.pi * np.sqrt(np.maximum(1 - r2, 0))
    # the exact pressure on patches: discretisation of the edge, a few per cent of a patch
    assert 1e-4 < residual(hertz) < 2e-2
    assert residual(np.where(r2 < 1, 4 / 3 / np.pi, 0.0)) > 0.1
    assert residual(1.01 * hertz) > 0.9e-2


def test_the_patches_satisfy_the_judge():
    assert residual(SOLVERS["contact"](64, 1)) <= LIMIT
