"""Published tables: read as printed, converted at the border, refused where malformed."""

import shutil

import numpy as np
import pytest

from verification.cases.contact import shipped_cases
from verification.cases.published import is_published, published_cases, read_published
from verification.cases.table import FOLDER, PublishedError, read_table
from verification.cases.toml import CaseError
from verification.problem.contact import CoatedContact, PrescribedLoad

TOML = """
title = "A disc"
source = "nobody"
year = 1900
primary_read = true
read = "written for this test"

[problem]
length_unit = "in"
stress_unit = "ksi"
pressure = 0.1
load_radius = 6.0
substrate = { E = 10.0, nu = 0.45 }
coatings = [ { E = 40.0, nu = 0.4, thickness = 10.0 } ]

[[table]]
file = "t.csv"
at = { z = "depth", unit = "in" }
flag = "flag"
column = [
    { name = "s", quantity = "sigma_zz", unit = "psi", factor = -1.0 },
    { name = "w", quantity = "u_z", unit = "in", uncertainty = 0.003 },
]
"""
CSV = "# a note\ndepth,s,w,flag\n0,100,0.05,\n2.5,90.25,0.0400,\n10,60.5,0.031,TYPO\n"


@pytest.fixture
def files(tmp_path):
    """Writes a case of one table and reads it."""

    def read(toml=TOML, csv=CSV):
        (tmp_path / "t.csv").write_text(csv)
        (tmp_path / "disc.toml").write_text(toml)
        return read_published(tmp_path / "disc.toml")

    return read


def test_units_and_signs_are_converted_at_the_border(files):
    case = files()
    inch, psi = 0.0254, 6894.757293168361
    assert isinstance(case.problem, PrescribedLoad)
    assert (case.problem.pressure, case.problem.load_radius) == pytest.approx((100 * psi, 6 * inch))
    assert case.problem.coatings[0] == pytest.approx((40e3 * psi, 0.4, 10 * inch))
    assert case.problem.substrate == pytest.approx((10e3 * psi, 0.45))
    stress, sink = case.columns
    assert stress.profile.value == pytest.approx(-np.array([100, 90.25, 60.5]) * psi)
    assert stress.profile.position == pytest.approx(np.array([0, 2.5, 10]) * inch)
    # The deepest point lies on the interface and belongs to the upper layer.
    assert stress.at.layer.tolist() == [0, 0, 0]
    assert sink.profile.value == pytest.approx(np.array([0.05, 0.04, 0.031]) * inch)


def test_reading_uncertainty_is_half_the_last_digit_of_the_column_unless_stated(files):
    stress, sink = files().columns
    assert stress.profile.uncertainty == pytest.approx(np.full(3, 0.005 * 6894.757293168361))
    assert sink.profile.uncertainty == pytest.approx(np.full(3, 0.003 * 0.0254))


def test_error_of_the_program_comes_on_top_of_the_rounding(files):
    toml = TOML.replace('"psi", factor = -1.0', '"psi", factor = -1.0, program_error = 0.02')
    assert files(toml).columns[0].profile.uncertainty == pytest.approx(np.full(3, 0.025 * 6894.757293168361))


def test_significant_digits_give_each_row_its_own_rounding(files):
    toml = TOML.replace('"psi", factor = -1.0', '"psi", factor = -1.0, significant = 3')
    found = files(toml).columns[0].profile.uncertainty / 6894.757293168361
    assert found == pytest.approx([0.5, 0.05, 0.05])


def test_spread_of_several_programs_is_their_uncertainty(files):
    toml = TOML.replace("uncertainty = 0.003", 'uncertainty = "range"')
    # 0.05 to 0.0400, without the flagged row, and half of the fourth decimal.
    assert files(toml).columns[1].profile.uncertainty == pytest.approx(np.full(3, 0.01005 * 0.0254))


def test_rows_marked_as_misprints_stay_but_do_not_count(files):
    stress, _ = files().columns
    assert stress.counted.tolist() == [True, True, False]
    assert stress.text == ("100", "90.25", "60.5")
    misprint = '[[table.misprint]]\nrow = { depth = 2.5 }\ncolumn = "w"\nwhy = "digits swapped"\n'
    stress, sink = files(TOML + misprint).columns
    assert stress.counted.tolist() == [True, True, False]
    assert sink.counted.tolist() == [True, False, False]


@pytest.mark.parametrize(
    ("csv", "said"),
    [
        (CSV.replace("90.25", "ninety"), r"t\.csv, line 4, column s: 'ninety' is not a finite number"),
        (CSV.replace("90.25", "nan"), r"t\.csv, line 4, column s: 'nan' is not a finite number"),
        (CSV.replace("90.25", "inf"), r"t\.csv, line 4, column s: 'inf' is not a finite number"),
        (CSV.replace("90.25", ""), r"t\.csv, line 4, column s: '' is not a finite number"),
        (CSV.replace("\n0,", "\nzero,"), r"t\.csv, line 3, column depth: 'zero'"),
        (CSV.replace(",s,", ",t,"), r"t\.csv: has no column 's'; it has depth, t, w, flag"),
        (CSV.replace(",s,", ",w,"), r"t\.csv: column names must be given and differ"),
        (CSV.replace("90.25,", ""), r"t\.csv, line 4: 3 cells under 4 columns"),
        ("# nothing but notes\n", r"t\.csv: no columns in it"),
        ("depth,s,w,flag\n", r"t\.csv: no rows in it"),
    ],
)
def test_malformed_table_is_refused_with_file_row_and_column(files, csv, said):
    with pytest.raises(CaseError, match=said):
        files(csv=csv)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('unit = "psi"', 'unit = "bar"', r"t\.csv, column s: unit 'bar' is unknown; known are Pa"),
        ('unit = "in" }\n', 'unit = "ell" }\n', r"t\.csv, column s: at: unit 'ell' is unknown"),
        ('stress_unit = "ksi"', 'stress_unit = "bar"', r"disc\.toml: problem\.stress_unit: unit 'bar'"),
        ('"sigma_zz"', '"sigma_rr"', r"t\.csv, column s: quantity 'sigma_rr' is unknown"),
        ('z = "depth"', 'z = "deep"', r"t\.csv: has no column 'deep'"),
        ("year = 1900", 'year = "1900"', r"disc\.toml: year must be a whole number"),
        ('file = "t.csv"', 'file = "../t.csv"', r"disc\.toml: table\.0\.file"),
        ('file = "t.csv"', 'file = "u.csv"', r"u\.csv: cannot be read"),
        ("pressure = 0.1", "radius = 0.1", r"disc\.toml: problem needs pressure and load_radius"),
        ('at = { z = "depth", unit = "in" }', "", r"disc\.toml: table\.0\.column\.0: has no positions"),
        ("nu = 0.4,", "nu = 0.7,", r"disc\.toml: problem\.coatings\.0\.nu"),
    ],
)
def test_malformed_case_is_refused_with_file_and_key(files, old, new, said):
    assert old in TOML
    with pytest.raises(CaseError, match=said):
        files(toml=TOML.replace(old, new))


def test_whole_numbers_are_numbers(files):
    toml = TOML.replace("uncertainty = 0.003", "uncertainty = 1").replace(
        "load_radius = 6.0", "load_radius = 6"
    )
    toml = toml.replace('file = "t.csv"', 'file = "t.csv"\nrows = { depth = 0 }')
    stress, sink = files(toml).columns
    assert sink.profile.uncertainty == pytest.approx([0.0254])
    assert stress.text == ("100",)


def test_only_a_file_with_tables_is_taken_for_a_published_case(tmp_path):
    assert all(is_published(path) for path in SHIPPED.values())
    assert not any(is_published(path) for path in shipped_cases().values())
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe[[table]]")
    (tmp_path / "huge.toml").write_text("[[table]]\n" + "#" * 2_000_000)
    for path in (tmp_path, tmp_path / "absent.toml", tmp_path / "binary.toml", tmp_path / "huge.toml"):
        assert not is_published(path)


def test_row_that_is_not_there_is_named(files):
    with pytest.raises(CaseError, match=r"t\.csv: no row has depth = 3"):
        files(toml=TOML.replace('file = "t.csv"', 'file = "t.csv"\nrows = { depth = 3.0 }'))
    with pytest.raises(PublishedError, match="cannot be read"):
        read_table(FOLDER / "absent.csv")


def test_lines_are_named_by_where_they_run(files):
    toml = TOML.replace('at = { z = "depth"', 'at = { x = "depth", z = 1.0')
    assert {item.profile.line.split(",")[0] for item in files(toml).columns} == {"z = 1 in"}
    toml = TOML.replace('at = { z = "depth"', 'at = { x = 3.0, y = -2.0, z = "depth"')
    item = files(toml).columns[0]
    assert item.profile.line.startswith("x = 3 in, y = -2 in, ")
    assert item.profile.position.tolist() == item.at.z.tolist()


SHIPPED = published_cases()


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_case_states_its_source_and_how_it_was_read(name):
    case = read_published(SHIPPED[name])
    assert case.claims
    assert case.citation["read"]
    assert str(case.citation["year"]) in case.source
    assert case.citation["notes"]
    # Whatever is printed has an uncertainty, and more than nothing.
    assert all((item.profile.uncertainty > 0).all() for item in case.columns)


def test_six_misprints_of_ahlvin_and_ulery_are_marked():
    case = read_published(SHIPPED["ahlvin_ulery_1962"])
    assert sum((~item.counted).sum() for item in case.columns) == 6


def test_contact_units_are_the_hertz_scales_of_the_case():
    case = read_published(SHIPPED["coated_sphere_ratio_2"])
    assert isinstance(case.problem, CoatedContact)
    radius = next(item for item in case.columns if item.profile.quantity == "contact_radius")
    assert radius.profile.value == pytest.approx([0.818478 * case.problem.a_h])
    assert radius.profile.uncertainty == pytest.approx([0.5e-6 * case.problem.a_h])


def test_a_table_is_added_by_two_files_and_no_code(tmp_path):
    for path in FOLDER.glob("jones*"):
        shutil.copy(path, tmp_path / path.name.replace("jones_1962.toml", "mine.toml"))
    assert read_published(tmp_path / "mine.toml").name == "mine"
