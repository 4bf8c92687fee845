"""Several coatings from one table, many layers, the answer of a notebook: each is what solve says."""

import json
from dataclasses import replace
from zipfile import ZIP_DEFLATED, ZipFile

import pytest
from quick_case import coatcheck

import verification
from verification.cases.case_file import parse_case
from verification.cases.toml_file import CaseError
from verification.desk.answer_stresses import Extreme
from verification.desk.case_wording import case_text
from verification.desk.coating_table import HEADS, VERDICT, read_rows, solved_row, table_page, table_rows
from verification.desk.contact_answer import answer
from verification.desk.many_layers import worst_of_each
from verification.desk.stack_text import stack
from verification.desk.table_file import read_cells, write_cells

TABLE = """name;ball;load;substrate;friction;coating 1;coating 2
film;100Cr6 d = 6 mm;20 N;100Cr6, yield 2 GPa;0.1;DLC 2 um, strength 0.2 GPa;Cr 200 nm, adhesion 300 MPa
<b>bare;6 mm;20 N;210 GPa, 0.3;;;
"""


@pytest.fixture
def table(tmp_path):
    path = tmp_path / "mine.csv"
    path.write_text(TABLE)
    return path


def test_a_row_is_what_solve_answers_with_the_mode_nearest_to_its_strength(table):
    cases = read_rows(table)
    rows = [solved_row(case) for case in cases]
    own = answer(cases[0].problem, "semianalytic", {"estimate_uncertainty": False})
    tension = max(e.value for e in own.extremes if e.quantity == "sigma_1" and e.where.startswith("coating"))
    heads, *told = table_rows(rows)
    film, bare = (dict(zip(heads, one, strict=True)) for one in told)
    assert list(film) == [*HEADS, *VERDICT]
    assert film["sigma_1 coatings [MPa]"] == float(f"{tension / 1e6:.3g}")
    assert film["governing"] == "coating 1 (DLC) cracks"
    assert film["used"] == pytest.approx(tension / 0.2e9, rel=5e-3)
    assert bare["p0 [MPa]"] == pytest.approx(cases[1].problem.p_h / 1e6, rel=5e-3)
    assert (bare["governing"], bare["sigma_1 coatings [MPa]"]) == ("", None)
    page = table_page(rows, cases, "mine.csv")
    assert "0 of 1 coatings with strengths hold" in page
    assert "&lt;b&gt;bare" in page
    assert "<svg" in page
    assert "Robertson" in page


COLUMNS = """name;ball;ball diameter [mm];ball E [GPa];ball nu;load [N];friction;\
substrate;substrate E [GPa];substrate nu;substrate yield strength [GPa];\
coating 1;coating 1 thickness [um];coating 1 E [GPa];coating 1 nu;coating 1 strength [GPa];\
coating 2;coating 2 adhesion [MPa]
film;100Cr6;6;210;0.3;20;0.1;100Cr6;210;0.3;2;DLC;2;150;0.25;0.2;Cr 200 nm;300
"""


@pytest.mark.parametrize("suffix", [".csv", ".xlsx"])
def test_a_column_for_each_number_is_the_same_problem_in_csv_and_in_a_workbook(table, suffix):
    words = read_rows(table)[0]
    path = table.with_suffix(suffix)
    if suffix == ".xlsx":
        pytest.importorskip("openpyxl")
        rows = [[_number(cell) for cell in line.split(";")] for line in COLUMNS.splitlines()]
        write_cells(path, rows)
        assert read_cells(path)[1][2] == "6"
    else:
        path.write_text(COLUMNS)
    (case,) = read_rows(path)
    assert replace(case, text="", source="") == replace(words, text="", source="")


def _number(cell):
    try:
        return float(cell)
    except ValueError:
        return cell


def test_a_workbook_is_read_within_bounds(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    broken = tmp_path / "broken.xlsx"
    broken.write_bytes(b"PK\x03\x04 no workbook")
    with pytest.raises(CaseError, match="not an XLSX workbook"):
        read_cells(broken)
    bomb = tmp_path / "bomb.xlsx"
    with ZipFile(bomb, "w", ZIP_DEFLATED) as archive:
        archive.writestr("xl/worksheets/sheet1.xml", b"0" * 60_000_000)
    with pytest.raises(CaseError, match="unpacks to more than"):
        read_cells(bomb)
    book = openpyxl.Workbook()
    book.active.append(["a", None, 1.5, "=1+1"])
    book.save(tmp_path / "mine.xlsx")
    assert read_cells(tmp_path / "mine.xlsx") == [["a", "", "1.5", ""]]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("load;", "laod;", "no column load"),
        ("friction", "mu", "unknown column 'mu'"),
        ("20 N;100Cr6, yield", "20 um;100Cr6, yield", "line 2"),
        ("210 GPa, 0.3", "stel", "line 3"),
        (TABLE.partition("\n")[2], "", "0 coatings"),
    ],
)
def test_a_bad_table_is_one_message_with_its_line(table, old, new, said):
    table.write_text(TABLE.replace(old, new, 1))
    with pytest.raises(CaseError, match=said) as error:
        read_rows(table)
    assert str(error.value).startswith(str(table))
    assert "\n" not in str(error.value)


def test_of_many_layers_the_worst_of_each_material_and_interface_stands(tmp_path):
    layers = "10 x (TiN 100 nm, 450 GPa, 0.25 / CrN 100 nm, 250 GPa, 0.22)"
    case = parse_case(case_text("3 mm", "20 N", "210 GPa, 0.3", [layers]).encode(), tmp_path / "many")
    assert stack(case).split(" / ", 1)[1].startswith("10 x (TiN 0.1 um / CrN 0.1 um) / ")
    places = [f"{kind} {i}" for kind in ("coating", "interface") for i in range(1, 21)] + ["substrate"]
    found = [Extreme("flat", "any", where, float(i), 0.0, 0.0, 0.0) for i, where in enumerate(places)]
    worst = [at.where for at in worst_of_each(case, found)]
    assert worst == ["coating 19", "coating 20", "interface 20", "substrate"]
    text = case_text("3 mm", "20 N", "210 GPa, 0.3", [layers.replace("10 x", "3 x")])
    few = parse_case(text.encode(), tmp_path / "few")
    assert worst_of_each(few, found[:6]) == tuple(found[:6])


@pytest.mark.slow
def test_the_answer_in_python_is_that_of_the_command(tmp_path):
    words = {"ball": "6 mm", "load": "20 N", "substrate": "100Cr6, yield 1 GPa", "friction": 0.2}
    found = verification.answer(**words, coatings=["<i> 2 um, 450 GPa, 0.25"])
    options = [word for key, value in words.items() for word in (f"--{key}", str(value))]
    done = coatcheck("solve", *options, "--coating", "<i> 2 um, 450 GPa, 0.25", "--json", cwd=tmp_path)
    content = json.loads(done.stdout)
    assert content["verdict"] == found.verdict
    assert str(found).endswith(found.verdict)
    values = [at["value"] for at in content["answer"]["extremes"]]
    assert values == pytest.approx([at.value for at in found.found.extremes], nan_ok=True)
    page = found._repr_html_()
    assert page.count("<tr>") == len(found.rows()) + 1
    assert "data:image/png" in page
    assert "<i>" not in page
    with pytest.raises(ValueError, match="--substrate"):
        verification.answer(ball="6 mm", load="20 N")
