"""What a newcomer types: the README's lines, the pinned versions, what continuous integration runs."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PINNED = [line for line in (ROOT / "constraints.txt").read_text().splitlines() if line]


def test_continuous_integration_runs_the_test_line_of_the_readme():
    lines = [
        line for line in (ROOT / "README.md").read_text().splitlines() if ".venv/bin/pytest -n 2" in line
    ]
    assert len(lines) == 1
    assert lines[0] in (ROOT / ".ci" / "run").read_text().splitlines()


def test_lock_constraints_and_uv_pin_the_same_versions():
    lock = (ROOT / "requirements.lock").read_text()
    locked = [
        re.sub(r" \\$", "", line) for line in lock.splitlines() if "==" in line and not line.startswith(" ")
    ]
    # who installs the lock does not get the 680 MB of the extra "fast"
    assert locked == [line for line in PINNED if "platform_machine" not in line]
    pyproject = tomllib.loads((ROOT / "pyproject.toml").read_text())
    assert [line.replace("'", '"') for line in pyproject["tool"]["uv"]["constraint-dependencies"]] == [
        line.replace("'", '"') for line in PINNED
    ]


def test_what_is_cited_and_what_is_installed_have_one_version():
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    assert f"version: {version}\n" in (ROOT / "CITATION.cff").read_text()
    assert f"## {version.split('.dev')[0]}, " in (ROOT / "CHANGELOG.md").read_text()


def test_every_dependency_is_pinned():
    pyproject = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    asked = pyproject["dependencies"] + [
        d
        for extra in pyproject["optional-dependencies"].values()
        for d in extra
        if not d.startswith("coatcheck[")
    ]
    names = {re.split(r"[=<>;\[ ]", line)[0] for line in PINNED}
    assert {re.split(r"[=<>;\[ ]", dependency)[0] for dependency in asked} <= names


def test_nothing_that_installs_names_a_place_on_the_network_or_on_one_machine():
    for path in (
        ROOT / "requirements.lock",
        ROOT / "constraints.txt",
        ROOT / "pyproject.toml",
        ROOT / ".ci" / "run",
    ):
        assert not re.search(r"://|index-url|find-links|/opt/|/root/", path.read_text()), path.name


def test_no_test_changes_the_environment_of_a_process_with_threads():
    """putenv moves the variables while another thread may read them: ``environment`` replaces os.environ."""
    changing = re.compile(r"monkeypatch\.(set|del)env|os\.environ\[[^]]*\] =|os\.putenv|processes=False")
    files = [path for path in (ROOT / "tests").rglob("test_*.py") if path != Path(__file__)]
    assert [path.name for path in files if changing.search(path.read_text())] == []


def test_every_file_of_the_packages_is_installed():
    patterns = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]["package-data"]
    for package in ("semianalytic", "fem_reference", "verification"):
        files = (path for path in (ROOT / package).rglob("*") if path.is_file() and path.name != ".lock")
        data = {path for path in files if path.suffix[:3] != ".py"}
        data.add(ROOT / package / "py.typed")
        assert data == {path for pattern in patterns[package] for path in (ROOT / package).glob(pattern)}
