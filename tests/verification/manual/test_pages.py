"""Pages of the manual: what is kept, what is generated, how docstrings and formulas are typeset."""

import json
import re

import pytest

from verification.cases.case_file import default_cases, read_case
from verification.guests.vectors.open_digits import FILE, shipped
from verification.manual import manual_build
from verification.manual.baseline_numbers import baseline, largest, stored
from verification.manual.generated_blocks import BLOCKS
from verification.manual.sphinx_extension import restructured
from verification.page.number_text import scientific
from verification.problem.line_profile import EDGE_LINE
from verification.problem.quantity import PEAKS
from verification.running.case_result import describe
from verification.sources.source_registry import METHODS

SLOW = ("solved",)  # solves a problem


def test_an_unknown_block_is_refused_with_the_page(tmp_path, monkeypatch):
    (tmp_path / "kept").mkdir()
    (tmp_path / "kept" / "page.md").write_text("# Page\n\n```{generated} nothing\n```\n")
    monkeypatch.setattr(manual_build, "SOURCE", tmp_path / "kept")
    with pytest.raises(manual_build.ManualError, match=r"page\.md"):
        manual_build.assemble(tmp_path / "out")


def test_a_docstring_shows_its_formulas_and_lists_what_each_name_means():
    text = "|A - B| of *both*,\nsee ``compare``.\n\n    u = E* p\n\na, b : first [m].   c : its\nsecond."
    assert restructured(text).split("\n\n") == [
        r"\|A - B\| of \*both\*, see ``compare``.",
        "::",
        "        u = E* p",
        ":a, b: first [m].",
        ":c: its second.\n",
    ]


def test_a_folder_with_something_else_is_not_written_to(tmp_path):
    (tmp_path / "letter.txt").write_text("mine")
    with pytest.raises(manual_build.ManualError, match="something"):
        manual_build.build(tmp_path)


def test_every_block_of_the_manual_has_content():
    empty = [name for name, block in BLOCKS.items() if name not in SLOW and not block().strip()]
    assert empty == []


def test_every_cell_of_the_accuracy_table_is_that_of_its_column():
    head, _, *rows = (line for line in BLOCKS["headline"]().splitlines() if line.startswith("|"))
    heads = [cell.strip() for cell in head.strip("|").split("|")]
    symbols = {"$p_0$": "peak_pressure", "$a$": "contact_radius", r"$\delta$": "approach"}
    assert len(rows) == len(default_cases())
    missing = 0
    for name, line in zip(default_cases(), rows, strict=True):
        cells = dict(zip(heads, (cell.strip() for cell in line.strip("|").split("|")), strict=True))
        result = stored(name)
        assert cells["comparisons"] == str(len(result.verdicts))
        for symbol, quantity in symbols.items():
            (found,) = [
                v.difference for c, v in result.verdicts if (c.quantity, c.between) == (quantity, METHODS)
            ] or [None]
            missing += found is None
            assert cells[symbol] == scientific(found, 1), (name, quantity)
        exact = largest(name, ("fem_reference", "integral_equation"), "stress", "pressure", "displacement")
        assert cells["finite elements, exact"] == scientific(exact, 1)
    assert missing  # of a contact whose radius is not compared


def test_the_zones_left_out_are_those_of_the_cases():
    said = BLOCKS["zones"]()
    zoned = tension = 0
    for name, path in default_cases().items():
        claims = read_case(path).claims
        tension += any(claim.quantity in PEAKS for claim in claims)
        if "indenter" in describe(read_case(path).problem):
            zoned += sum(claim.line not in ("contact", "surface", EDGE_LINE, "axis") for claim in claims)
        zoned += sum(claim.edge > 0 for claim in claims)
        assert (f"/{name}.md" in said) is not any(claim.quantity in PEAKS for claim in claims)
    assert said.startswith(f"{zoned} of ")
    assert f" {tension} of {len(default_cases())} cases" in said


@pytest.mark.parametrize(("name", "most"), [("README.md", 900), ("paper.md", 1000)])
def test_the_numbers_of_the_readme_and_the_paper_are_those_of_the_baseline_and_the_records(name, most):
    text = " ".join((manual_build.SOURCE.parents[2] / name).read_text(encoding="utf-8").split())
    assert len(text.split()) <= most
    known = baseline()
    contacts = {name: case.manifest for name, case in known.cases.items() if not case.published}
    comparisons = sum(len(c.pairs) for manifest in contacts.values() for c in manifest.comparisons)
    invariants = sum(len(manifest.invariants) for manifest in contacts.values())
    assert f"all {comparisons} " in text
    assert f"all {invariants} " in text
    between = ("fem_reference", "integral_equation")
    error = max(largest(name, between, "stress") or 0.0 for name in contacts)
    assert f" {scientific(error, 2)} " in text
    assert f" {len(shipped()['problems'])} problems" in text
    guests = json.loads((FILE.parent / "guests.json").read_text(encoding="utf-8"))
    for name, stated in re.findall(r"(tamaas|slippy|CalculiX)[^,.]*? (\de-\d)", text):
        (found,) = (one for one in guests if one["guest"].startswith(name))
        assert f"{found['differences']['peak_pressure']:.0e}".replace("e-0", "e-") == stated


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.*Check CHANGES for Sphinx API modifications")  # of MyST by Sphinx
def test_the_manual_builds_without_a_warning_and_loads_nothing(tmp_path):
    pytest.importorskip("sphinx")
    first = manual_build.build(tmp_path / "manual")
    pages = {path: path.read_text(encoding="utf-8") for path in first.parent.rglob("*.html")}
    assert len(pages) > 20
    loaded = r'<(?:script|img|link|iframe)[^>]+(?:src|href)="(?:https?:)?//'
    assert [path.name for path, text in pages.items() if re.search(loaded, text)] == []
