"""Bad case files by the thousand: one message with file and key, exit code 2, nothing written."""

import io
import re
import shutil
import tomllib
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from functools import cache
from pathlib import Path

import pytest
from case_texts import case_text
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from malformed import dump, garbled, malformed

from verification.cases.case_file import shipped_cases
from verification.cases.published_file import published_cases, read_published
from verification.cases.toml_file import CaseError, spoken
from verification.commands import run as command
from verification.running.pool import process_slot
from verification.study.study_plan import read_study_file, shipped_studies

CLAIM = {
    "quantity": "sigma_xx",
    "line": "interface 1, upper side",
    "between": ["semianalytic", "fem_reference"],
    "cap": 0.005,
    "why": "the peak",
    "edge": 0.05,
}
KNOBS = {
    "semianalytic": {"patches": 129, "conversion": "split", "max_iterations": 300, "edge_correction": True},
    "fem_reference": {"order": 3, "quality": "fast"},
}
CASES = [tomllib.loads(path.read_text(encoding="utf-8")) for path in shipped_cases().values()]
CASES += [tree | KNOBS | {"claim": [CLAIM, CLAIM]} for tree in CASES if tree["problem"].get("coatings")][:4]
PUBLISHED = [published_cases()[name] for name in ("jones_1962", "hermanowicz_2021", "ellea1_halfspace_axis")]
read_baseline = cache(command.read_baseline)  # a quarter of a second, once


def generated(number: int) -> settings:
    """So many examples, the same every time, none of them hunted down or remembered."""
    return settings(
        max_examples=number,
        derandomize=True,
        database=None,
        deadline=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )


class Accepted(Exception):
    """Raised where solving would begin."""


def complaint_of(path: Path, monkeypatch: pytest.MonkeyPatch) -> str | None:
    """What ``coatcheck run PATH`` says of a bad file, checked to be as promised; None where it is good."""
    folder = path.parent

    def accept(*_: object, **__: object) -> None:
        raise Accepted

    monkeypatch.setattr(process_slot.Slot, "start", accept)
    monkeypatch.setattr(command, "read_baseline", read_baseline)
    said, printed = io.StringIO(), io.StringIO()
    try:
        with redirect_stderr(said), redirect_stdout(printed):
            code = command.run(str(path), output=folder / "out", quiet=True)
    except Accepted:
        shutil.rmtree(folder / "out")
        return None
    message = said.getvalue()
    assert code == 2
    assert message.endswith("\n")
    assert message.count("\n") == 1
    assert message[:-1].isprintable()
    assert len(message) < 1100
    assert printed.getvalue() == ""
    assert not (folder / "out").exists()
    return message.removeprefix("coatcheck: ").strip()


def names(message: str, path: Path, keys: tuple[str, ...]) -> bool:
    """True where the file is named, and one of ``keys``, or the part of the file around it, or a line."""
    if not message.startswith(f"{path}: "):
        return False
    said = message.removeprefix(f"{path}: ")
    if not keys or said.startswith(("not TOML", "not UTF-8", "line ", "larger than")):
        return bool(re.search(r"line \d+|column|document|bytes|nested|digits|[a-z_]+", said))
    shown = [re.sub(r"[^ -~]", "", spoken(key))[:30] for key in keys]
    if any(re.sub(r"\\x1b|[^ -~]", "", said).startswith(key) for key in shown):
        return True
    # What concerns two keys at once is told of the part that holds both: "problem: moduli differ".
    first = re.split(r"[ ,:=]", said)[0]
    # A claim names a line that only a coating has, and resolve requires one.
    parts = ("problem", "load", "coating", "coatings", "ball", "claim", "resolve")
    return any(first in (key.split(".")[0], *parts * key.startswith("problem")) for key in keys)


@pytest.mark.parametrize("wanted", [50, pytest.param(2000, marks=pytest.mark.slow)])
def test_generated_case_files(tmp_path, monkeypatch, wanted):
    refused = 0
    path = tmp_path / "mine.toml"

    # Some changes leave a file good; a quarter more than wanted makes up for them.
    @generated(wanted * 5 // 4)
    @given(malformed(CASES))
    def each(made):
        nonlocal refused
        raw, keys = made
        path.write_bytes(raw)
        message = complaint_of(path, monkeypatch)
        refused += message is not None
        assert message is None or names(message, path, keys), (message, keys)
        assert [entry.name for entry in tmp_path.iterdir()] == ["mine.toml"]

    each()
    assert refused >= wanted


def test_files_that_were_not_changed_are_accepted(tmp_path, monkeypatch):
    for tree in CASES:
        (tmp_path / "mine.toml").write_text(dump(tree), encoding="utf-8")
        assert complaint_of(tmp_path / "mine.toml", monkeypatch) is None


def refusal(read: Callable[[Path], object], path: Path) -> str | None:
    """The message ``read`` refuses a file with; None where it is good."""
    try:
        read(path)
    except CaseError as error:
        return str(error)
    return None


@pytest.mark.parametrize(("files", "texts"), [(120, 60), pytest.param(600, 300, marks=pytest.mark.slow)])
def test_generated_published_cases_and_tables_are_refused_in_one_sentence(tmp_path, files, texts):
    refused = 0
    trees = [tomllib.loads(path.read_text(encoding="utf-8")) for path in PUBLISHED]
    tables = {}
    for path in sorted(PUBLISHED[0].parent.glob("*.csv")):
        shutil.copy(path, tmp_path)
        tables[path.name] = path.read_bytes()

    def read(raw, named):
        nonlocal refused
        (tmp_path / "mine.toml").write_bytes(raw)
        message = refusal(read_published, tmp_path / "mine.toml")
        refused += message is not None
        assert message is None or re.match(named, message), message

    @generated(files)
    @given(malformed(trees))
    def each_case(made):
        read(made[0], rf"{tmp_path}/mine\.toml: |\w+\.csv[:,] ")

    @generated(texts)
    @given(st.sampled_from(trees), st.data())
    def each_table(tree, data):
        name = tree["table"][0]["file"]
        (tmp_path / name).write_bytes(data.draw(garbled(tables[name])))
        read(dump(tree).encode(), rf"{tmp_path}/mine\.toml: |{re.escape(name)}[:,] ")
        (tmp_path / name).write_bytes(tables[name])

    each_case()
    each_table()
    assert refused >= texts


@pytest.mark.parametrize("files", [60, pytest.param(300, marks=pytest.mark.slow)])
def test_generated_study_files_are_refused_in_one_sentence(tmp_path, files):
    refused = 0
    trees = [tomllib.loads(path.read_text(encoding="utf-8")) for path in shipped_studies().values()]
    path = tmp_path / "mine.toml"

    @generated(files)
    @given(malformed(trees))
    def each(made):
        nonlocal refused
        path.write_bytes(made[0])
        message = refusal(read_study_file, path)
        refused += message is not None
        assert message is None or message.startswith(f"{path}: "), message

    each()
    assert refused >= 2 * files / 3


GOOD = case_text("E = 420e9; nu = 0.3; thickness = 70e-6")


def test_name_that_no_file_should_have_is_refused(tmp_path, monkeypatch):
    for name in ("two\nlines", "\x1b[31mred", "x" * 120, "\udcff"):
        path = tmp_path / f"{name}.toml"
        path.write_text(GOOD)
        message = complaint_of(path, monkeypatch)
        assert message is not None, repr(name)
