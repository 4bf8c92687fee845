"""Published tables: read as printed, converted at the border, refused where malformed."""

import numpy as np
import pytest

from verification.cases.published_file import published_cases, read_published
from verification.cases.published_table import RECOMPUTED
from verification.cases.toml_file import CaseError
from verification.problem.coated_contact import PrescribedLoad

TOML = """
title = "A disc"
source = "nobody"
year = 1900

[problem]
length_unit = "in"
stress_unit = "ksi"
pressure = 0.1
load_radius = 6.0
substrate = { E = 10.0, nu = 0.45 }
coatings = [ { E = 40.0, nu = 0.4, thickness = "254 mm" } ]

[[table]]
file = "t.csv"
seen = "primary"
read = "written for this test"
at = { z = "depth", unit = "in" }
column = [
    { name = "s", quantity = "sigma_zz", unit = "psi", factor = -1.0 },
    { name = "w", quantity = "u_z", unit = "in", uncertainty = 0.0003 },
]
"""
CSV = "# a note\ndepth,s,w,s_departure\n0,100,0.05,\n2.5,90.25,0.0400,\n10,60.5,0.031,-0.7\n"


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


def test_significant_digits_give_each_row_its_own_rounding(files):
    toml = TOML.replace('"psi", factor = -1.0', '"psi", factor = -1.0, significant = 3')
    found = files(toml).columns[0].profile.uncertainty / 6894.757293168361
    assert found == pytest.approx([0.5, 0.05, 0.05])


@pytest.mark.parametrize("cell", ["90.25", "190.25", "00.01", "-90.25"])
def test_uncertainty_of_a_cell_depends_on_no_value_of_its_column(files, cell):
    before = [item.profile.uncertainty for item in files().columns]
    after = [item.profile.uncertainty for item in files(csv=CSV.replace("90.25", cell)).columns]
    assert all((old == new).all() for old, new in zip(before, after, strict=True))


def test_uncertainty_above_the_ceiling_is_refused_unless_the_file_states_why(files):
    # 1 % of the largest displacement, 0.05 in.
    assert files(TOML.replace("0.0003", "0.0005"))
    coarse = TOML.replace("0.0003", "0.00051")
    with pytest.raises(CaseError, match=r"t\.csv, column w, line 3"):
        files(coarse)
    ceiling = 'file = "t.csv"\nceiling = { fraction = 0.02, why = "a figure" }'
    assert files(coarse.replace('file = "t.csv"', ceiling)).claims
    # A value printed in steps of 1000 psi, under a load of 100 psi.
    with pytest.raises(CaseError, match=r"t\.csv, column s, line 2"):
        files(csv="depth,s,w\n0,1e3,0.05\n")


@pytest.mark.parametrize(
    ("csv", "said"),
    [
        (CSV.replace("90.25", "ninety"), r"t\.csv, line 4, column s"),
        (CSV.replace("90.25", "nan"), r"t\.csv, line 4, column s"),
        (CSV.replace("90.25", "inf"), r"t\.csv, line 4, column s"),
        (CSV.replace("90.25", ""), r"t\.csv, line 4, column s"),
        (CSV.replace("\n0,", "\nzero,"), r"t\.csv, line 3, column depth"),
        (CSV.replace(",s,", ",t,"), r"t\.csv"),
        (CSV.replace(",s,", ",w,"), r"t\.csv"),
        (CSV.replace("90.25,", ""), r"t\.csv, line 4"),
        ("# nothing but notes\n", r"t\.csv"),
        ("depth,s,w,s_departure\n", r"t\.csv"),
    ],
)
def test_malformed_table_is_refused_with_file_row_and_column(files, csv, said):
    with pytest.raises(CaseError, match=said):
        files(csv=csv)


def test_lines_are_named_by_where_they_run(files):
    toml = TOML.replace('at = { z = "depth"', 'at = { x = "depth", z = 1.0')
    assert {item.profile.line.split(",")[0] for item in files(toml).columns} == {"z = 1 in"}
    toml = TOML.replace('at = { z = "depth"', 'at = { x = 3.0, y = -2.0, z = "depth"')
    item = files(toml).columns[0]
    assert item.profile.line.startswith("x = 3 in, y = -2 in, ")
    assert item.profile.position.tolist() == item.at.z.tolist()


SHIPPED = published_cases()
COUNTS = (463, 239, 550)  # published values that count, that depart; values of recomputed tables


def test_values_of_the_shipped_cases_are_counted_as_stated_in_the_readme():
    columns = [item for path in SHIPPED.values() for item in read_published(path).columns]
    assert all((item.profile.uncertainty > 0).all() for item in columns)
    cells = sum(len(item.text) for item in columns)
    counted = sum(int(item.counted.sum()) for item in columns)
    recomputed = sum(len(item.text) for item in columns if item.seen == RECOMPUTED)
    assert (counted, cells - counted - recomputed, recomputed) == COUNTS


def test_a_column_read_twice_stands_on_lines_of_its_own(files):
    again = ', at = { z = 0.0, x = "depth", unit = "in" }, '
    twice = TOML.replace(
        "column = [",
        'column = [\n{ name = "s", quantity = "sigma_xx", unit = "psi"' + again.rstrip(", ") + " },"
        '\n{ name = "s", quantity = "sigma_zz", unit = "psi", factor = 2.0 },',
    )
    lines = [(c.profile.quantity, c.profile.line) for c in files(twice).columns if c.column == "s"]
    assert len(set(lines)) == 3
    assert lines[1][1] == "axis, t, column s"
    assert lines[2] == ("sigma_zz", "axis, t, column s as sigma_zz")


@pytest.mark.parametrize("name", published_cases())
def test_a_name_of_a_line_has_one_set_of_points_and_each_quantity_once(name):
    profiles = [item.profile for item in read_published(published_cases()[name]).columns]
    assert len({(p.quantity, p.line) for p in profiles}) == len(profiles)
    assert len({(p.line, p.position.tobytes()) for p in profiles}) == len({p.line for p in profiles})
