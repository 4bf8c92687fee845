"""Codes of others on record: each record is its adapter's, and repeats where the code installs."""

import json
import shutil
import subprocess
import sys

import pytest
from guest_records import adapters, digest
from quick_case import coatcheck

from verification.guests.guest_description import read_guest
from verification.guests.pages.guests_section import examined

# Packages of pip besides numpy and scipy, programs.
NEEDS = {
    "tamaas": (["tamaas=={version}"], []),
    "ContactMechanics": (["ContactMechanics=={version}"], []),
    "slippy's coating": ([], []),
    "CalculiX": ([], ["ccx", "gmsh"]),
    "FreeFEM": ([], ["FreeFem++"]),
    "NGSolve": (["ngsolve=={version}"], []),
    "sfepy": (["sfepy=={version}"], []),
    "GetDP": (["gmsh==4.15.2"], ["getdp"]),
    "PyMastic": ([], ["git"]),
    "nanite": (["nanite=={version}"], []),
}

UNCOATED, COATED = "01_uncoated_steel", "05_ratio_4"
CASES = {name: COATED for name in ("GetDP", "sfepy", "PyMastic")}  # of the record


def test_ten_codes_are_on_record_with_their_adapters_as_they_are():
    records = {one["guest"]: one for one in examined()}
    assert records.keys() == NEEDS.keys()
    for name, one in records.items():
        folder = adapters()[name]
        assert one["sha256"] == digest(folder)
        assert one["date"]
        assert one["notes"] == read_guest(folder).notes != []
        assert all(len(path.read_text().splitlines()) <= 60 for path in folder.glob("*.py"))
        assert one["agree"] <= one["answered"]


@pytest.mark.slow
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("name", NEEDS)
def test_a_record_repeats_where_the_code_installs(name, tmp_path):
    packages, programs = NEEDS[name]
    for program in programs:
        if shutil.which(program) is None:
            pytest.skip(f"{name}: there is no {program} on this machine")
    guest, place = read_guest(adapters()[name]), tmp_path / "guest"
    shutil.copytree(guest.folder, place)
    python, pinned = tmp_path / "venv" / "bin" / "python", [p.format(version=guest.version) for p in packages]
    _run(name, sys.executable, "-m", "venv", tmp_path / "venv")
    _run(name, python, "-m", "pip", "install", "--quiet", "numpy", "scipy", *pinned)
    if name == "PyMastic":
        _run(name, "git", "clone", "--quiet", guest.homepage, tmp_path / "code")
        _run(name, "git", "-C", tmp_path / "code", "checkout", "--quiet", guest.version)
        shutil.copytree(tmp_path / "code" / "Main", place / "Main")
    (place / "guest.toml").write_text(f'python = "{python}"\n{guest.text}')
    done = coatcheck("guest", "run", "guest", CASES.get(name, UNCOATED), "--quiet", cwd=tmp_path)
    assert done.returncode in (0, 1, 4), done.stderr
    found = json.loads((place / "report" / "report.json").read_text())
    (record,) = [one for one in examined() if one["guest"] == name]
    assert found["differences"]
    for quantity, difference in found["differences"].items():
        assert difference <= 1.1 * record["differences"][quantity] + 1e-12


def _run(name, *command):
    """Run ``command``; the test is skipped with its last line where it fails, as without a network."""
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=900)
    if done.returncode:
        pytest.skip(f"{name} does not install here: {done.stderr.strip().splitlines()[-1]}")
