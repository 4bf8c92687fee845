"""The key of a stored solve follows everything that its answer depends on."""

import ast
import json
from importlib.util import find_spec
from pathlib import Path

import pytest
from synthetic_solves import STUDY, made_up

from verification.running.checked_files import StoreError
from verification.running.provenance import fingerprint
from verification.study import solve_cache
from verification.study.solve_cache import read_answer, solve_key, stored_path, write_answer
from verification.study.study_plan import parse_study


@pytest.fixture
def request_():
    return next(parse_study(STUDY.encode(), Path("x.toml")).solves()).request


OTHERS = {"source": "fem_reference", "numerics": {"patches": 65}, "frictions": [0.3], "residual": [1e9]}
OTHERS |= {"problem": {"radius": 1.0}, "swept": 1}


@pytest.mark.parametrize("name", OTHERS)
def test_every_part_of_a_request_is_in_its_key(request_, name):
    assert OTHERS.keys() == request_.keys()
    assert solve_key(request_ | {name: OTHERS[name]}) != solve_key(request_)
    assert solve_key(json.loads(json.dumps(request_))) == solve_key(request_)


def imports(module):
    """The modules of this package that ``module`` takes its functions from."""
    tree = ast.parse(Path(find_spec(module).origin).read_text())
    named = {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module}
    return {name for name in named if name.startswith("verification.")}


def test_whatever_finds_the_quantities_is_in_the_key():
    # the table and the cache only carry what was found; run brings the solvers, the reading of errors
    carriers = {
        "verification.study.study_table",
        "verification.study.solve_cache",
        "verification.running.provenance",
    }
    searched = tuple(solve_cache._SEARCH)
    for module in (
        "verification.study.study_point",
        "verification.study.largest_stresses",
        "verification.study.friction_planes",
    ):
        assert all(name.startswith(searched) or name in carriers for name in imports(module))


def test_a_changed_source_file_changes_every_key(request_, monkeypatch):
    before = solve_key(request_)
    planes = find_spec("verification.study.friction_planes").origin
    read = Path.read_bytes
    monkeypatch.setattr(Path, "read_bytes", lambda path: read(path) + b" " * (str(path) == planes))
    fingerprint.cache_clear()
    try:
        assert solve_key(request_) != before
    finally:
        fingerprint.cache_clear()


def test_an_answer_comes_back_as_it_was_put(request_, tmp_path):
    path = stored_path(tmp_path, solve_key(request_))
    write_answer(path, request_, made_up(request_))
    found = read_answer(path, request_)
    assert found["rows"][0]["peak_pressure"] == made_up(request_)["rows"][0]["peak_pressure"]
    assert found["rows"][0]["sigma_xx_base_x"] is None  # NaN, which strict JSON lacks
    with pytest.raises(StoreError, match="states"):
        read_answer(path, request_ | {"swept": 1})
