"""The engine of a study on made-up answers: nothing lost, nothing solved twice, the same table always."""

import json
import os
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from scheduler_by_hand import hand_started
from synthetic_solves import CRASHING, FAILING, STUDY, made_up

from verification.study import dask_cluster
from verification.study.dask_cluster import SchedulerError, connected
from verification.study.study_engine import run_study
from verification.study.study_plan import parse_study
from verification.study.study_point import answer
from verification.study.study_table import COLUMNS, read_columns, read_study

HELPERS = Path(__file__).parents[1]  # imported by the workers too
SOLVES = 6 + 2 * 3  # curves and their checks


def plan(**replaced):
    text = STUDY
    for old, new in replaced.items():
        text = text.replace(f"{old} = ", f"{old} = {new} #")
    return parse_study(text.encode(), Path("made_up.toml"))


@contextmanager
def threads(n, folder):
    """A client of a worker with ``n`` threads, in a process of its own."""
    from distributed import Client

    folder.mkdir(exist_ok=True)
    places = os.pathsep.join([str(HELPERS), os.environ.get("PYTHONPATH", "")])
    with (
        hand_started(folder, 1, n, PYTHONPATH=places) as (address, _),
        Client(address, set_as_default=False) as client,
    ):
        client.wait_for_workers(1)
        yield client


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    with threads(3, tmp_path_factory.mktemp("worker")) as client:
        yield client


@pytest.fixture
def client(cluster):
    @contextmanager
    def borrowed():
        yield cluster

    return borrowed


def ledger(folder):
    return [json.loads(line) for line in (folder / "ledger.jsonl").read_text().splitlines()]


def sent(folder):
    return [line["key"] for line in ledger(folder) if line["event"] == "sent"]


def test_every_point_is_a_row_with_its_full_input(tmp_path, client):
    came = run_study(plan(), tmp_path, client, solve=made_up)
    assert (came.points, came.rows, came.done, came.kept, came.failed) == (12, 12 + 2 * 6, SOLVES, 0, 0)
    assert came.complete
    found = read_columns(came.table)
    assert list(found) == COLUMNS.names
    curve = found["source"] == "semianalytic"
    assert found["point"][curve].tolist() == list(range(12))
    assert found["friction"][curve].tolist() == [0.0, 0.25] * 6
    assert found["thickness"][curve].tolist() == [2e-5, 2e-5, 4e-5, 4e-5, 8e-5, 8e-5] * 2
    assert found["coating_E"][curve].tolist() == [105e9] * 6 + [420e9] * 6
    checked = found["source"] == "fem_reference"
    assert found["point"][checked].tolist() == [0, 1, 4, 5, 10, 11]
    assert np.isnan(found["sigma_xx_base_x"]).all()
    assert read_study(came.table)["text"] == STUDY


def test_order_of_the_answers_leaves_no_trace(tmp_path, client):
    with threads(1, tmp_path / "worker") as alone:
        one = run_study(plan(), tmp_path / "one", lambda: client_of(alone), solve=made_up)
    three = run_study(plan(), tmp_path / "three", client, solve=made_up)
    assert one.table.read_bytes() == three.table.read_bytes()


@contextmanager
def client_of(client):
    yield client


def test_study_goes_on_where_it_stopped_and_solves_nothing_twice(tmp_path, client):
    whole = run_study(plan(), tmp_path / "whole", client, solve=made_up)

    class Stop(Exception):
        pass

    def stop(source, done, total):
        if done >= 4:
            raise Stop

    cut = tmp_path / "cut"
    with pytest.raises(Stop):
        run_study(plan(), cut, client, solve=made_up, report=stop)
    partial = read_columns(cut / "made_up.parquet")
    assert 0 < partial["point"].size < 24
    assert not read_study(cut / "made_up.parquet")["complete"]
    stored = {line["key"] for line in ledger(cut) if line["event"] == "stored"}
    before = len(sent(cut))
    again = run_study(plan(), cut, client, solve=made_up)
    assert again.kept == len(stored) > 0
    assert again.done == SOLVES - len(stored)
    assert not stored & set(sent(cut)[before:])
    assert again.table.read_bytes() == whole.table.read_bytes()


def test_a_finished_study_needs_no_cluster(tmp_path, client):
    first = run_study(plan(), tmp_path, client, solve=made_up)
    content = first.table.read_bytes()
    first.table.unlink()

    def none():
        raise AssertionError("a cluster was asked for")

    second = run_study(plan(), tmp_path, none)
    assert (second.done, second.kept) == (0, SOLVES)
    assert second.table.read_bytes() == content


def test_identical_points_are_solved_once(tmp_path, client):
    came = run_study(plan(thickness="[4e-5, 4e-5, 4e-5]"), tmp_path, client, solve=made_up)
    assert came.rows == 12 + 12  # all three checked points of each modulus are one solve
    assert len(sent(tmp_path)) == len(set(sent(tmp_path))) == 2 + 2 * 2
    other = plan(thickness="[4e-5, 8e-5]", cross_check="0")
    assert run_study(other, tmp_path, client, solve=made_up).kept == 2


@pytest.mark.parametrize("damage", ["flip", "cut", "swap", "empty"])
def test_damage_to_the_cache_is_noticed_named_mended(tmp_path, client, damage):
    whole = run_study(plan(), tmp_path, client, solve=made_up)
    content = whole.table.read_bytes()
    files = sorted((tmp_path / "cache").rglob("*.json"))
    raw = bytearray(files[3].read_bytes())
    if damage == "flip":
        raw[len(raw) // 2] ^= 4
    elif damage == "swap":
        raw = bytearray(files[4].read_bytes())  # whole, but the answer to another request
    files[3].write_bytes(raw[: {"cut": len(raw) // 2, "empty": 0}.get(damage, len(raw))])
    before = len(sent(tmp_path))
    again = run_study(plan(), tmp_path, client, solve=made_up)
    assert sent(tmp_path)[before:] == [files[3].stem]
    assert [str(files[3]) in message for message in again.damaged] == [True]
    assert again.table.read_bytes() == content


def test_a_point_that_fails_is_a_row_with_its_sentence(tmp_path, client):
    study = plan(thickness=f"[4e-5, {FAILING}]", cross_check="0")
    came = run_study(study, tmp_path, client, solve=made_up)
    found = read_columns(came.table)
    failed = found["status"] == "failed"
    assert failed.tolist() == [False, False, True, True] * 2
    assert came.failed == 4
    assert len(set(found["failure"][failed])) == 1
    assert np.isnan(found["peak_pressure"][failed]).all()
    assert np.isfinite(found["peak_pressure"][~failed]).all()
    # it is an answer like any other: not asked for again
    assert run_study(study, tmp_path, client, solve=made_up).done == 0


def test_what_a_worker_could_not_answer_is_a_row_now_tried_again_later(tmp_path, client):
    study = plan(thickness=f"[4e-5, {CRASHING}]", cross_check="0")
    came = run_study(study, tmp_path, client, solve=made_up)
    assert came.failed == 4
    (lost,) = set(came.lost.values())
    assert lost in read_columns(came.table)["failure"].tolist()
    again = run_study(study, tmp_path, client, solve=partial(made_up, crashing=0.0))
    assert (again.failed, again.done) == (0, 2)


def test_a_scheduler_that_is_not_there_is_one_sentence(monkeypatch):
    monkeypatch.setattr(dask_cluster, "CONNECT_WITHIN", 0.2)
    with (
        pytest.raises(SchedulerError, match="scheduler"),
        connected("tcp://127.0.0.1:9", 1),
    ):
        pass


def test_a_worker_with_other_code_is_refused(tmp_path, client):
    def stranger(request):
        return made_up(request) | {"code": "0" * 64}

    with pytest.raises(SchedulerError, match="coatcheck"):
        run_study(plan(), tmp_path, client, solve=stranger)
    assert not list((tmp_path / "cache").rglob("*.json"))


def test_a_solver_that_raises_answers_with_its_sentence():
    request = next(plan().solves()).request
    for strange, said in (({"numerics": {"patches": 20}}, "patches = 20"), ({"load": -1.0}, "load = -1")):
        try:
            found = answer(request | strange)
        except ValueError as error:  # a problem that is none never reaches a solver
            assert said in str(error)  # noqa: PT017
            continue
        assert {row["status"] for row in found["rows"]} == {"failed"}
        assert all(said in row["failure"] for row in found["rows"])
