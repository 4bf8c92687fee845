"""Several coatings from one table, many layers, the answer of a notebook: each is what solve says."""

import csv
import json

import pytest
from quick_case import coatcheck

import verification
from verification.cases.case_file import parse_case
from verification.cases.toml_file import CaseError
from verification.desk.answer_stresses import Extreme
from verification.desk.case_wording import case_text
from verification.desk.coating_table import HEADS, VERDICT, read_rows, solved_row, table_csv, table_page
from verification.desk.contact_answer import answer
from verification.desk.many_layers import worst_of_each
from verification.desk.stack_text import stack

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
    film, bare = csv.DictReader(table_csv(rows).splitlines())
    assert list(film) == [*HEADS, *VERDICT]
    assert film["sigma_1 coatings [MPa]"] == f"{tension / 1e6:.3g}"
    assert film["governing"] == "coating 1 (DLC) cracks"
    assert float(film["used"]) == pytest.approx(tension / 0.2e9, rel=5e-3)
    assert float(bare["p0 [MPa]"]) == pytest.approx(cases[1].problem.p_h / 1e6, rel=5e-3)
    assert (bare["governing"], bare["sigma_1 coatings [MPa]"]) == ("", "")
    page = table_page(rows, cases, "mine.csv")
    assert "0 of 1 coatings with strengths hold" in page
    assert "&lt;b&gt;bare" in page
    assert "<svg" in page
    assert "Robertson" in page


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
