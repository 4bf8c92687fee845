"""Mutants: the set of a small source, trials of a toy, the draw, the record, the command."""

import os
from dataclasses import replace
from pathlib import Path

import pytest
from mutation import campaign, trial
from mutation.campaign import ROOMS, ROOT, annotated, drawn
from mutation.command import mutants as command
from mutation.sites import mutants, mutated
from mutation.trial import kept_trial, main, try_mutant
from synthetic_results import INFO

from verification.evidence import mutant_record as records
from verification.evidence.mutant_record import Catch, MutantRecord, Trial
from verification.report.credibility import detection_sections as page
from verification.report.report_material import Evidence, Material
from verification.report.sections.first_page import worth
from verification.running.checked_files import StoreError, read_checked
from verification.running.json_records import decode

GUARD = "verification/running/pool/fork_guard.py"
SMALL = '''"""A module of 3 words."""
from dataclasses import dataclass
__all__ = ["f", "g"]
LIMIT: float = 0.5
Either = int | None


@dataclass(frozen=True)
class C:
    def f(self, x, axis=0) -> float:
        """The 2nd line."""
        if x[1] < 0 and x.any():
            raise ValueError(f"x = {x[1]} after {2 + 3} steps")
        assert x[1] > 0
        return abs(x[:, 1]).max(axis=0) - min(x[: self.n])


def text(n) -> str:
    return "a" * (n + 1)


def g(a, b):
    a += 2.0
    for i, j in zip(a, b, strict=True):
        a = a if i else -b * "".join("x" for _ in range(3))
    return not a
'''
EXPECTED = [
    (4, "constant", "LIMIT: float = 1.0"),
    (10, "default", "def f(self, x, axis=1) -> float:"),
    (12, "comparison", "if (x[1] < 0 or x.any()):"),
    (12, "comparison", "if (x[1] <= 0) and x.any():"),
    (12, "comparison", "if (x[1] >= 0) and x.any():"),
    (12, "index", "if x[2] < 0 and x.any():"),
    (12, "constant", "if x[1] < 1 and x.any():"),
    (12, "extreme", "if x[1] < 0 and x.all():"),
    (15, "sign", "return (-(abs(x[:, 1]).max(axis=0) - min(x[:self.n])))"),
    (15, "term", "return abs(x[:, 1]).max(axis=0)"),
    (15, "arithmetic", "return (abs(x[:, 1]).max(axis=0) + min(x[:self.n]))"),
    (15, "extreme", "return abs(x[:, 1]).min(axis=0) - min(x[: self.n])"),
    (15, "abs", "return x[:, 1].max(axis=0) - min(x[: self.n])"),
    (15, "index", "return abs(x[:, 2]).max(axis=0) - min(x[: self.n])"),
    (15, "axis", "return abs(x[:, 1]).max(axis=1) - min(x[: self.n])"),
    (15, "extreme", "return abs(x[:, 1]).max(axis=0) - max(x[:self.n])"),
    (15, "slice", "return abs(x[:, 1]).max(axis=0) - min(x[: (self.n - 1)])"),
    (23, "arithmetic", "a -= 2.0"),
    (23, "constant", "a += 4.0"),
    (25, "negation", 'a = a if (not i) else -b * "".join("x" for _ in range(3))'),
    (25, "arithmetic", "a = a if i else (-b / ''.join(('x' for _ in range(3))))"),
    (25, "negation", 'a = a if i else b * "".join("x" for _ in range(3))'),
    (26, "negation", "return a"),
]
TOY = """def area(a, h):
    while a < 0:
        a = a + 1
    return a * h + SMALLEST


SMALLEST = 1e-300
"""
CHECKS = """import json
from semianalytic import area
area(3, 0)
wrong = area(-0.5, 4) > 5
print(json.dumps(["checks" if wrong else "survived", "an area", 0.5, "area"]))
"""


def test_a_small_source_has_the_known_mutants_and_no_other():
    found = mutants(SMALL, "m.py")
    assert sorted((m.line, m.operator, m.after.strip()) for m in found) == sorted(EXPECTED)
    assert {m.function for m in found} == {"", "C.f", "g"}


@pytest.mark.parametrize(
    "file", ["", "verification/judging/verdict.py", "verification/sampling/stress_plane.py"]
)
def test_every_mutant_differs_and_compiles(file):
    source = (ROOT / file).read_text("utf-8") if file else SMALL
    for mutant in mutants(source, file):
        changed = mutated(source, mutant)
        compile(changed, file, "exec")
        assert changed != source
        assert mutant.change


@pytest.fixture(scope="module")
def toy(tmp_path_factory):
    """A source tree whose only method, unit test and check of the default run are toys."""
    root = tmp_path_factory.mktemp("toy")
    for name, text in {
        "pyproject.toml": "[tool.pytest.ini_options]\n",
        "semianalytic/__init__.py": TOY,
        "tests/tools/mutation/__init__.py": "",
        "tests/tools/mutation/trial.py": CHECKS,
        "tests/semianalytic/test_toy.py": "from semianalytic import area\n\n\ndef test_area():\n"
        "    assert area(0, 3) < 1e-9\n    assert area(-0.5, 4) == 2\n",
    }.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    (root / "verification").mkdir()
    (root / "fem_reference").mkdir()
    return root


@pytest.mark.parametrize(
    ("after", "catch", "by"),
    [
        ("", Catch.SURVIVED, "passed"),
        ("SMALLEST = 2e-300", Catch.SURVIVED, "passed"),
        ("a = (a - 1)", Catch.TIME, ""),
        ("a = a + 2", Catch.CHECKS, "an area"),
        ("while (a <= 0):", Catch.TESTS, "test_toy.py"),
        ("return (a / h) + SMALLEST", Catch.CRASH, "ZeroDivisionError"),
    ],
)
def test_a_mutant_of_a_toy_is_caught_or_survives_as_known(toy, after, catch, by):
    known = {m.after.strip(): m for m in mutants(TOY, "semianalytic/__init__.py")}
    mutant = known[after] if after else None
    limit = 1 if catch is Catch.TIME else 4  # s of processor time, which an endless loop uses up
    found = try_mutant("semianalytic", mutant, toy, limit, toy)
    assert found.catch is catch
    assert by in found.by
    assert found.seconds > 0


def test_a_trial_sees_no_process_but_its_own(tmp_path):
    if not trial._namespace():
        pytest.skip("the system gives unshare(1) no process namespace")
    found = trial._run(("-c", "import os; print(os.getppid())"), tmp_path, 10, Catch.TESTS)
    assert found == (Catch.SURVIVED, ["1"])


def test_a_trial_that_waits_for_ever_ends(tmp_path, monkeypatch):
    monkeypatch.setattr(trial, "WAITING", 0.3)
    catch, lines = trial._run(("-c", "import time; time.sleep(60)"), tmp_path, 1, Catch.TESTS)
    assert (catch, len(lines)) == (Catch.TIME, 1)


def test_a_mutant_that_may_kill_others_is_not_tried_where_they_are_in_sight(toy, tmp_path, monkeypatch):
    monkeypatch.setattr(trial, "_namespace", tuple)
    mutant = next(m for m in mutants((ROOT / GUARD).read_text("utf-8"), GUARD) if "killpg" in m.after)
    main("running", mutant, toy, 1.0, tmp_path / "trial.json")
    assert "unshare" in decode(Trial, read_checked(tmp_path / "trial.json")["trial"]).by


def test_a_draw_repeats_and_a_larger_one_adds_to_it():
    few, again, more = (
        drawn(["judging", "sampling"], 5, 7),
        drawn(["judging", "sampling"], 5, 7),
        drawn(["judging", "sampling"], 9, 7),
    )
    assert few == again
    assert [room for room, _ in few] == ["judging"] * 3 + ["sampling"] * 2
    assert set(few) < set(more)
    assert few != drawn(["judging", "sampling"], 5, 8)
    for room in ROOMS.values():
        assert all((ROOT / place).exists() for place in (room.folder, *room.tests))


def _record(tmp_path) -> MutantRecord:
    (_, one), (_, two), (_, three) = drawn(["judging"], 3, 1)
    listed = tmp_path / "survivors.toml"
    listed.write_text(
        f"[[survivor]]\nfile = {one.file!r}\nfunction = {one.function!r}\nchange = '''{one.change}'''\n"
        "kind = 'equivalent'\nreason = 'the <same> number'\n"
    )
    trials = [Trial("judging", one, Catch.SURVIVED), Trial("judging", two, Catch.SURVIVED)]
    trials.append(Trial("judging", three, Catch.TESTS, "FAILED", seconds=2.0))
    return MutantRecord(1, annotated(trials, listed), 2.0, INFO)


def test_survivors_that_were_read_keep_their_reason_and_equivalent_ones_do_not_count(tmp_path):
    record = _record(tmp_path)
    assert [trial.kind for trial in record.trials] == ["equivalent", "", ""]
    assert record.score() == record.score("judging") == (1, 2)
    assert not record.passed
    assert replace(record, trials=record.trials[::2]).passed
    path = records.write_record(tmp_path, record)
    assert records.read_record(tmp_path) == record
    assert records.read_record(tmp_path / "nowhere") is None
    path.write_text(path.read_text().replace('"judging"', '"judgment"'))
    with pytest.raises(StoreError, match=r"mutants\.json"):
        records.read_record(tmp_path)


def test_the_section_shows_score_and_survivors(tmp_path):
    record = _record(tmp_path)
    section = page.mutants_of(Material([], INFO, Evidence(mutants=record)))
    assert section is not None
    assert "1 of 2" in section.parts[0].text
    cells = [cell.text for row in section.parts[1].tables[0].rows for cell in row.cells]
    assert record.trials[0].reason in cells
    assert page.mutants_of(Material([], INFO)) is None
    (first,) = worth(Material([], INFO, Evidence(mutants=record)))
    assert (first.value, first.href) == ("1 of 2", f"#{section.anchor}")


def test_survivors_on_record_are_of_this_source():
    for row in campaign.load_toml(campaign.SURVIVORS.read_bytes())[1].get("survivor", []):
        known = mutants((ROOT / row["file"]).read_text("utf-8"), row["file"])
        assert (row["function"], row["change"]) in {(m.function, m.change) for m in known}
        assert row["kind"] in ("equivalent", "harmless")
        assert row["reason"]


@pytest.mark.parametrize(
    "words",
    [
        {"rooms": ("judgin",)},
        {"rooms": ("judging",), "record": True},
        {"count": 0},
        {"seed": -1},
        {"jobs": 0},
    ],
)
def test_a_wrong_question_is_bad_input_and_writes_nothing(words, tmp_path, capsys):
    rooms = words.pop("rooms", ())
    assert command(*rooms, output=tmp_path / "out", records=tmp_path / "records", **words) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert os.listdir(tmp_path) == []


def test_a_trial_is_kept_for_the_same_code_and_a_survivor_for_the_same_tests(tmp_path, monkeypatch):
    module, path = "mutation.trial", tmp_path / "trials" / "control_judging.json"
    survived = Trial("judging", None, Catch.SURVIVED, seconds=1.0)
    for one, code in ((survived, "code, tests"), (replace(survived, catch=Catch.TESTS), "code")):
        monkeypatch.setattr(f"{module}.try_mutant", lambda *_, found=one: found)
        monkeypatch.setattr(
            f"{module}.fingerprint", lambda modules: "code" + ", tests" * ("tests" in modules)
        )
        main("judging", None, Path("clean"), 5.0, path)
        assert read_checked(path)["made_by"] == code
        assert kept_trial("judging", None, tmp_path) == one
        assert kept_trial("sampling", None, tmp_path) is None
        monkeypatch.setattr(
            f"{module}.fingerprint", lambda modules: "code" + ", others" * ("tests" in modules)
        )
        assert (kept_trial("judging", None, tmp_path) == one) is one.caught
        monkeypatch.setattr(f"{module}.fingerprint", lambda modules: "other code")
        assert kept_trial("judging", None, tmp_path) is None
