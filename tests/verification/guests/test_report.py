"""The report of a guest: what is wrong and why, in one page."""

import shutil
import xml.etree.ElementTree as ET
from pathlib import Path

from html_document import Document
from quick_case import coatcheck

import verification

EXAMPLES = Path(verification.__file__).parent / "guests" / "examples"


def test_the_page_names_the_slips_of_the_wrong_example(tmp_path):
    words = ("guest", "run", str(EXAMPLES / "wrong"), "01_uncoated_steel", "-o", "out")
    done = coatcheck(*words, cwd=tmp_path)
    assert done.returncode == 1
    slips = ("E*", "MPa", "compression", "transposed")
    assert all(text in done.stdout for text in slips)
    page = (tmp_path / "out" / "report.html").read_text()
    Document(page)
    assert all(text in page for text in ("MPa", "<svg"))
    ET.parse(tmp_path / "out" / "badge.svg")
    assert "of" in (tmp_path / "out" / "badge.svg").read_text()


def test_convergence_against_the_exact_solution_is_shown(tmp_path):
    shutil.copytree(EXAMPLES / "start", tmp_path / "g")
    adapter = tmp_path / "g" / "adapter.py"
    text = adapter.read_text().replace("friction=0.0):", "friction=0.0, patches=1):")
    # An error of second order in the parameter.
    adapter.write_text(text.replace('"contact_radius": a,', '"contact_radius": a * (1 + patches**-2.0),'))
    description = tmp_path / "g" / "guest.toml"
    description.write_text(description.read_text() + "\n[refine]\npatches = [32, 64, 128]\n")
    done = coatcheck("guest", "run", "g", "01_uncoated_steel", cwd=tmp_path)
    assert done.returncode == 0, done.stdout
    page = (tmp_path / "g" / "report" / "report.html").read_text()
    assert "Convergence" in page
    assert "patches = 32" in page
