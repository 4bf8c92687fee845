"""What comes from a stranger is data: never run, never a way out of the output directory, never markup."""

import ast
import json
import shutil
import time
from pathlib import Path

import pytest
from quick_case import QUICK, coatcheck

from verification.cases.case_file import read_case
from verification.cases.published_file import read_any_case
from verification.cases.toml_file import CaseError
from verification.commands.common.terminal import one_line
from verification.running.case_result import RunInfo
from verification.running.case_tasks import result_path
from verification.running.checked_files import StoreError
from verification.running.stored_fields import fields_path, plane_path
from verification.running.stored_run import read_run

HOUSE = Path(__file__).parents[2]
PACKAGES = ("semianalytic", "fem_reference", "verification")
SOURCES = sorted(path for package in PACKAGES for path in (HOUSE / package).rglob("*.py"))
# Modules that make objects out of bytes, and calls that make code out of text.
UNSAFE = {"pickle", "cPickle", "dill", "cloudpickle", "joblib", "marshal", "shelve", "yaml", "xmlrpc"}
CODE = {"eval", "exec", "compile", "__import__"}
# A task goes to a child of this process through a pipe of its own: no file, nobody else's.
PIPE = tuple(f"verification/running/pool/{name}.py" for name in ("process_slot", "fork_guard"))


def called(node: ast.Call) -> str:
    """The dotted name of what is called."""
    names, function = [], node.func
    while isinstance(function, ast.Attribute):
        names.append(function.attr)
        function = function.value
    names.append(function.id if isinstance(function, ast.Name) else "")
    return ".".join(reversed(names))


def test_nothing_makes_code_or_objects_out_of_files():
    found = []
    for path in SOURCES:
        name = path.relative_to(HOUSE).as_posix()
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            modules = []
            if isinstance(node, ast.Import):
                modules = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                modules = [node.module or ""]
            found += [(name, m) for m in modules if m.split(".")[0] in UNSAFE and name not in PIPE]
            if not isinstance(node, ast.Call):
                continue
            words = {w.arg: str(w.value.value) for w in node.keywords if isinstance(w.value, ast.Constant)}
            if called(node) in CODE:
                found.append((name, ast.unparse(node)))
            if called(node).endswith((".load", ".loads", ".load_module")) and not called(node).startswith(
                ("json.", "tomllib.", "MeshTri.", "Mesh.", "image.", *(("pickle.",) if name in PIPE else ()))
            ):
                found.append((name, ast.unparse(node)))
            if words.get("allow_pickle") == "True" or words.get("shell") == "True":
                found.append((name, ast.unparse(node)))
            if called(node) in ("os.system", "os.popen", "subprocess.getoutput"):
                found.append((name, ast.unparse(node)))
            if called(node).endswith("Environment") and words.get("autoescape") != "True":
                found.append((name, ast.unparse(node)))
    assert len(SOURCES) > 80
    assert found == []


NAMES = ["..", "...", "-rf", "con", "a b", "*", "%2e%2e%2f", "a\\b", "~", "$HOME", "β-Si₃N₄", "x" * 100]


def test_no_name_of_a_case_leads_out_of_the_output_directory(tmp_path):
    for name in NAMES:
        (tmp_path / f"{name}.toml").write_text(QUICK)
        case = read_case(tmp_path / f"{name}.toml")
        for path in (
            result_path(tmp_path, case),
            plane_path(tmp_path, case.name),
            fields_path(tmp_path, case.name),
        ):
            assert path.resolve().parent.parent == tmp_path.resolve()
            assert path.name == f"{case.name}.json"


def test_run_with_strange_names_writes_into_its_output_directory_only(tmp_path):
    for name in ("..", "../-rf"):
        (tmp_path / "here").mkdir(exist_ok=True)
        (tmp_path / "here" / f"{name}.toml").write_text(QUICK)
    before = sorted(tmp_path.rglob("*"))
    done = coatcheck("run", "...toml", "../-rf.toml", "-q", "-o", "out", cwd=tmp_path / "here")
    assert done.returncode == 0, done.stderr
    after = sorted(
        path for path in tmp_path.rglob("*") if tmp_path / "here" / "out" not in (path, *path.parents)
    )
    assert after == before
    assert sorted(path.stem for path in (tmp_path / "here" / "out" / "cases").iterdir()) == ["-rf", ".."]


@pytest.mark.parametrize(
    ("raw", "said"),
    [
        ("a = " + "[" * 100_000, "nested"),
        ("a." * 100_000 + "a = 1", "dots"),
        ("[[problem.coatings]]\nE = 1.0\nnu = 0.3\nthickness = 1.0\n" * 1_000_000, "larger"),
        ("coatings = [" + "{E=1},\n" * 30_000 + "]", r"mine\.toml: "),
        ("load = " + "9" * 200_000, "TOML"),
        ("a = [" + "1e308," * 40_000 + "]", r"mine\.toml: "),
    ],
    ids=range(6),
)
def test_file_made_to_exhaust_the_reader_is_refused_at_once(tmp_path, raw, said):
    path = tmp_path / "mine.toml"
    path.write_text(raw)
    began = time.process_time()
    with pytest.raises(CaseError, match=said) as error:
        read_any_case(path)
    assert time.process_time() - began < 3
    assert len(one_line(str(error.value))) <= 1000


def test_report_of_a_stranger_is_read_or_refused(tmp_path):
    place = tmp_path / "report.json"
    good = {"schema": "coatcheck-report/1", "cases": [], "run": {}}
    info = RunInfo("c", "s", 1.0, 1, None, "m", {})
    for text in (
        "",
        "[" * 200_000,
        "7",
        json.dumps(good),
        json.dumps(good | {"run": vars(info) | {"seconds": "soon"}}),
        json.dumps(good | {"run": vars(info) | {"versions": 7}}),
        json.dumps(good | {"run": vars(info), "cases": [{"schema": "coatcheck-report/1", "name": []}]}),
        json.dumps(good | {"run": vars(info), "cases": {"a": 1}}),
    ):
        place.write_text(text)
        with pytest.raises(StoreError, match=r"report\.json: "):
            read_run(tmp_path)
    shutil.rmtree(tmp_path)
    with pytest.raises(StoreError, match="cannot"):
        read_run(tmp_path)
