"""Open digits: counted, checked against schema and checksums, computed again."""

import csv
import hashlib
import io
import json
import re
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from open_digits_made.content import vector
from open_digits_made.problems import problems
from open_digits_made.values import exact_rows
from open_digits_made.vector_schema import VectorSet
from quick_case import coatcheck

from verification.guests.vectors import open_digits
from verification.problem.quantity import DISPLACEMENTS, STRESSES


@pytest.fixture(scope="module")
def shipped():
    return open_digits.shipped()


def test_at_least_500_problems_of_all_kinds(shipped):
    assert len(shipped["problems"]) >= 500
    assert len({one["name"] for one in shipped["problems"]}) == len(shipped["problems"])
    assert {len(one["problem"]["coatings"]) for one in shipped["problems"]} == set(range(6))
    groups = {one["group"] for one in shipped["problems"]}
    assert {"uncoated", "osullivan_king", "thin", "nearly_incompressible", "disc", "hertz_ellipse"} <= groups
    assert {"sliding_ellipse", "elastic_ball"} <= groups
    for one in shipped["problems"]:
        off = [points for points in one["points"] if any(points["y"])]
        assert {q for points in off for q in points["values"]} == {*STRESSES, *DISPLACEMENTS}, one["name"]
        assert {points["body"] for points in off} == {"flat", *(["ball"] if "ball" in one["problem"] else [])}


def test_the_schema_holds_and_every_value_has_its_uncertainty(shipped):
    VectorSet.model_validate_json(json.dumps(shipped))
    assert json.loads(open_digits.SCHEMA.read_text()) == VectorSet.model_json_schema()
    assert "CC0" in shipped["licence"]
    cff = Path(__file__).parents[3] / "CITATION.cff"
    assert shipped["cite"]["authors"] in cff.read_text()
    assert shipped["cite"]["version"] == shipped["schema"].partition("/")[2]
    wide = {"stress": [], "displacement": []}
    for one in shipped["problems"]:
        wide["stress"] += [U / abs(value) for value, U in one["contact"].values()]
        scales = Counter()
        for points in one["points"]:
            for q, values in points["values"].items():
                scales[q] = max(scales[q], *map(abs, values))
        for points in one["points"]:
            for q, found in points["uncertainty"].items():
                kind = "displacement" if q in DISPLACEMENTS else "stress"
                wide[kind] += [U / (scales[q] or 1.0) for U in found]
            assert points["values"].keys() == points["uncertainty"].keys()
            sizes = {len(v) for part in ("values", "uncertainty") for v in points[part].values()}
            assert sizes == {len(points[c]) for c in "xyz"} == {len(points["x"])}
    both = np.concatenate([np.array(found) for found in wide.values()])
    assert np.isfinite(both).all()
    assert (both >= 0).all()
    assert (both <= 1e-10).mean() > 0.8  # ten digits
    assert max(wide["stress"]) < 1e-5
    assert max(wide["displacement"]) < 2e-5  # below a film that is much stiffer than its substrate


def test_both_methods_agree_within_their_uncertainty(shipped):
    problems = Counter()
    # an uncertainty from a refinement covers 999 of 1000 values; the README names the others
    for one in shipped["checked"]:
        problems[one["method"]] += one["problems"]
        assert one["within"] >= 0.999 * one["values"]
    assert problems["semianalytic"] >= 200
    assert problems["fem_reference"] >= 30


@pytest.mark.parametrize("number", [0, 30, 300, 500, 515, 520, 540])
def test_problems_computed_anew_have_the_same_digits(shipped, number):
    one = problems()[number]
    stored = shipped["problems"][number]
    found = vector(one, exact_rows(one.problem))
    assert found["problem"] == stored["problem"]
    for new, old in zip(found["points"], stored["points"], strict=True):
        assert new.keys() == old.keys()
        for quantity, values in old["values"].items():
            allowed = 2 * np.array(old["uncertainty"][quantity]) + 1e-300
            assert (np.abs(np.array(new["values"][quantity]) - values) <= allowed).all()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """What the command writes."""
    place = tmp_path_factory.mktemp("vectors")
    done = coatcheck("vectors", "--output", "digits", cwd=place)
    assert done.returncode == 0, done.stderr
    return place / "digits"


def test_the_command_writes_files_whose_checksums_hold(folder, shipped):
    for line in (folder / "SHA256SUMS").read_text().splitlines():
        digest, name = line.split()
        assert hashlib.sha256((folder / name).read_bytes()).hexdigest() == digest
    for name, digest in shipped["sha256"].items():
        assert hashlib.sha256((folder / name).read_bytes()).hexdigest() == digest
    rows = list(csv.DictReader(io.StringIO((folder / "values.csv").read_text())))
    assert len(rows) >= 50_000


def test_the_reader_shown_is_at_most_20_lines_that_run(folder, monkeypatch, capsys):
    text = (folder / "README.md").read_text()
    code = re.search(r"```python\n(.*?)```", text, re.DOTALL)[1]
    assert len(code.splitlines()) <= 20
    monkeypatch.chdir(folder)
    exec(compile(code, "README", "exec"), {})
    assert "osullivan_king_013" in capsys.readouterr().out
