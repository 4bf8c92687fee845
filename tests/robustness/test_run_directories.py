"""Run directories under rough treatment: damaged files, full and read-only disks, eight runs at once."""

import json
import os
import random
import re
import resource
import shutil
import subprocess
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest
from malformed import keys_of
from quick_case import COMMAND, QUICK, coatcheck_process

from verification.cases.case_file import parse_case
from verification.commands.common.task_progress import kept_results
from verification.running.case_result import from_json, to_json
from verification.running.case_tasks import case_task, kept_result, result_path
from verification.running.checked_files import (
    StoreError,
    locked,
    read_bounded,
    read_checked,
    write_atomically,
    write_checked,
)
from verification.running.contact_run import judge_case, solve_case
from verification.running.pool.process_pool import run_tasks
from verification.running.provenance import fingerprint
from verification.running.stored_fields import plane_path, write_plane
from verification.sampling.stress_plane import sample_plane


def content(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


@pytest.fixture(scope="module")
def stored(tmp_path_factory):
    """Twenty cases with their results as workers leave them, solved once."""
    folder = tmp_path_factory.mktemp("stored")
    cases = [parse_case(QUICK.encode(), Path(f"case-{n}.toml")) for n in range(20)]
    solved = solve_case(cases[0])
    result = judge_case(cases[0], solved)
    for case in cases:
        own = to_json(replace(result, name=case.name)) | {"made_by": fingerprint()}
        write_checked(result_path(folder, case), own)
        write_plane(plane_path(folder, case.name), sample_plane((), solved.solutions), case.text)
    return folder, cases


def damaged(whole: bytes, rng: random.Random, number: int) -> bytes:
    if number % 2:
        return whole[: rng.randrange(len(whole))]
    flipped = bytearray(whole)
    flipped[rng.randrange(len(whole))] ^= 1 << rng.randrange(8)
    return bytes(flipped)


@pytest.mark.slow
def test_two_hundred_damaged_files_are_named_and_computed_again(tmp_path, stored, capsys):
    origin, cases = stored
    folder = tmp_path / "run"
    shutil.copytree(origin, folder)
    assert len(kept_results(cases, folder)) == len(cases)
    assert capsys.readouterr().err == ""
    rng = random.Random(20261121)
    # Workers that need not compute: what they would leave is known.
    tasks = [
        replace(task, work=partial(shutil.copyfile, origin / "cases" / task.path.name, task.path))
        for task in (case_task(c, folder) for c in cases)
    ]
    for turn in range(10):
        files = [
            result_path(folder, c) if (n + turn) % 3 else plane_path(folder, c.name)
            for n, c in enumerate(cases)
        ]
        for number, file in enumerate(files):
            file.write_bytes(damaged(file.read_bytes(), rng, number))
        kept = kept_results(cases, folder)
        said = capsys.readouterr().err.splitlines()
        assert kept == {}
        assert len(said) == len(files)
        for file, line in zip(files, said, strict=True):
            assert line.startswith(f"coatcheck: {file}: ")
        results = run_tasks(tasks, jobs=4, time_limit=300)
        assert {r.outcome for r in results} == {"AGREES"}
        shutil.rmtree(folder / "planes")
        shutil.copytree(origin / "planes", folder / "planes")
        assert content(folder) == content(origin)


def test_result_of_another_file_version_or_case_is_not_kept(tmp_path, stored):
    origin, (first, second, *_) = stored
    folder = tmp_path / "run"
    shutil.copytree(origin, folder)
    assert kept_result(folder, first) is not None
    shutil.copy(result_path(folder, second), result_path(folder, first))
    with pytest.raises(StoreError, match=r"case-0\.json"):
        kept_result(folder, first)
    with pytest.raises(StoreError, match=r"case-1\.json"):
        kept_result(folder, replace(second, text=second.text + "# changed\n"))
    payload = read_checked(result_path(folder, second))
    write_checked(result_path(folder, second), payload | {"made_by": "0" * 64})
    with pytest.raises(StoreError, match=r"case-1\.json"):
        kept_result(folder, second)


def test_result_of_a_stranger_is_read_or_refused_but_never_trips(stored):
    folder, cases = stored
    payload = read_checked(result_path(folder, cases[0]))
    rng = random.Random(8)
    places = [place for place in keys_of(payload) if len(place) < 6]
    text = json.dumps(payload)
    refused = 0
    for _ in range(300):
        data = json.loads(text)
        *path, last = rng.choice(places)
        node = data
        for step in path:
            node = node[step]
        strange = ["text", 7, None, True, [], {}, [[1]], 1e308, "NaN", "__import__('os')", {"a": []}, -1]
        node[last] = rng.choice(strange)
        try:
            to_json(from_json(data))
        except ValueError:
            refused += 1
    assert refused > 100


def test_pipe_device_or_directory_in_the_place_of_a_file_holds_nobody_up(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "zero").symlink_to("/dev/zero")
    for name in ("pipe", "zero", "."):
        with pytest.raises(StoreError):
            read_bounded(tmp_path / name, 1000)
    (tmp_path / "big").write_text("x" * 11)
    with pytest.raises(StoreError, match="larger"):
        read_bounded(tmp_path / "big", 10)
    (tmp_path / "run").mkdir()
    os.mkfifo(tmp_path / "run" / ".lock")
    with locked(tmp_path / "run"):
        pass


def test_nothing_is_written_through_a_link(tmp_path):
    outside, run = tmp_path / "outside", tmp_path / "run"
    outside.mkdir()
    run.mkdir()
    (outside / "precious").write_text("precious")
    (run / "a.json").symlink_to(outside / "precious")
    write_atomically(run / "a.json", "new")
    assert (run / "a.json").read_text() == "new"
    (run / ".lock").symlink_to(outside / "lock")
    with pytest.raises(StoreError, match="written"), locked(run):
        pass
    (run / ".lock").unlink()
    (run / "cases").symlink_to(outside)
    with pytest.raises(StoreError, match="cases"), locked(run):
        pass
    assert content(outside) == {"precious": b"precious"}


@pytest.mark.slow
def test_limit_on_file_size_is_one_sentence_and_the_earlier_results_stay(tmp_path):
    # What a full disk does, on any machine: no file may grow beyond 60 kB, which a result exceeds.
    (tmp_path / "quick.toml").write_text(QUICK)
    earlier = {name: b"earlier" for name in ("report.html", "report.json", "junit.xml")}
    (tmp_path / "out").mkdir()
    for name, text in earlier.items():
        (tmp_path / "out" / name).write_bytes(text)

    def small():
        resource.setrlimit(resource.RLIMIT_FSIZE, (60_000, 60_000))

    done = coatcheck_process("run", "quick.toml", "-q", "-o", "out", cwd=tmp_path, preexec_fn=small)
    assert done.returncode == 2, done.stderr
    assert re.fullmatch("coatcheck: .*File too large.*\n", done.stderr)
    found = content(tmp_path / "out")
    assert {name: found[name] for name in earlier} == earlier
    assert found.keys() - earlier <= {".lock", "cases/quick.json", "planes/quick.json"}


@pytest.mark.slow
def test_of_eight_runs_at_once_one_works_and_the_others_say_why_not(tmp_path):
    (tmp_path / "quick.toml").write_text(QUICK.replace("hertz", "fem_reference").replace("1e-6", "1e-2"))
    runs = [
        subprocess.Popen(
            [*COMMAND, "run", "quick.toml", "-q", "-o", "out"],
            cwd=tmp_path,
            stderr=subprocess.PIPE,
            text=True,
        )
        for _ in range(8)
    ]
    ends = [(run.communicate(timeout=300)[1], run.returncode) for run in runs]
    worked = [said for said, code in ends if code == 0]
    refused = [said for said, code in ends if code == 2]
    assert len(worked) + len(refused) == 8
    assert len(worked) >= 1
    assert set(worked) == {""}
    assert all(said.startswith("coatcheck: out: ") and said.count("\n") == 1 for said in refused)
    assert read_checked(tmp_path / "out" / "cases" / "quick.json")["outcome"] == "AGREES"
    assert json.loads((tmp_path / "out" / "report.json").read_text())
