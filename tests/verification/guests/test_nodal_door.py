"""Files of nodes, written by elements of coatcheck's own, are judged as the elements themselves are."""

import csv

import numpy as np
import pytest
from guest_exams import guest_in, prepared, question
from quick_case import coatcheck

import fem_reference
from fem_reference.vtu import write_vtu
from verification.guests.doors.file_door import place_of, read_answer
from verification.guests.exam_subjects import DISC
from verification.guests.guest_protocol import ProtocolError
from verification.problem.coated_contact import keywords
from verification.problem.quantity import DISPLACEMENTS, STRESSES

CASE = "05_ratio_4"
TOML = """name = "g"
results = "answers"
claim = 0.01
supports = { coatings = 50, stress = true, loads = ["disc"] }
"""
NAMES = {name: c for name, c in STRESSES.items() if c[0] == c[1] or name == "sigma_xz"}


class Elements:
    """The disc on a coated solid by finite elements, and at its points the exact values and their own."""

    def __init__(self, folder):
        self.case, self.exam = prepared(CASE, folder, DISC)
        self.solution = fem_reference.solve_prescribed(**keywords(self.case.loaded))
        self.folder = folder

    def guest(self, axes='["r", "t", "z"]'):
        guest = guest_in(self.folder, f"{TOML}[nodes]\naxes = {axes}\n")
        asked = question(self.case, self.exam, guest)
        place = place_of(guest, self.case, asked)
        place.mkdir(parents=True, exist_ok=True)
        for path in place.iterdir():
            path.unlink()
        return guest, asked, place

    def mesh(self):
        """r, z, stress, displacement and layer of each node, a row for each of its layers; triangles."""
        import meshio

        read = meshio.read(write_vtu(self.solution, self.folder / "own.vtu"))
        cells, layer = read.cells[0].data, read.cell_data["layer"][0]
        of = np.zeros(len(read.points), dtype=int)
        of[cells[layer == 1]] = 1
        fields = {name.split(" [")[0]: value for name, value in read.point_data.items()}
        return read.points[:, 0], read.points[:, 2], fields, of, cells

    def errors(self, answer, asked):
        """The largest error over the largest value of each quantity on each line, with the own one."""
        exact = {(p.quantity, p.line): p.value for p in self.exam.profiles}
        found = {}
        for line in asked.lines:
            x, y, z, layer = (np.array(v) for v in (line.x, line.y, line.z, line.layer))
            own = np.empty((9, x.size))
            for k in set(line.layer):
                at = layer == k
                sigma = self.solution.stress(x[at], y[at], z[at], layer=k)
                own[:6, at] = [sigma[c] for c in STRESSES.values()]
            own[6:] = self.solution.displacement(x, y, z)
            by = dict(zip((*STRESSES, *DISPLACEMENTS), own, strict=True))
            for q in line.quantities:
                scale = self.case.problem.p_h if q in STRESSES else self.case.problem.delta_h
                values = (answer.values[line.line][q], by[q])
                gaps = [np.abs(np.array(v) - exact[q, line.line]).max() / scale for v in values]
                U = answer.uncertainty[line.line][q]
                found[q, line.line] = (*gaps, np.max(U) / scale)
        return found


@pytest.fixture(scope="module")
def elements(tmp_path_factory):
    return Elements(tmp_path_factory.mktemp("nodes"))


def written(path, heads, columns):
    with path.open("w", newline="") as file:
        csv.writer(file).writerows([heads, *np.array(columns).T.tolist()])


def frd(path, r, up, sigma, u, cells):
    """What CalculiX writes: nodes, triangles of six nodes, displacements, stresses in fixed columns."""

    def rows(*columns):
        lines = (
            f" -1{n:10d}" + "".join(f"{v:12.5E}" for v in row)
            for n, row in enumerate(zip(*columns, strict=True), 1)
        )
        return [*lines, " -3"]

    text = [f"    2C{len(r):30d}{1:38d}", *rows(r, up, 0 * r), f"    3C{len(cells):30d}{1:38d}"]
    for n, nodes in enumerate(cells, 1):
        text += [f" -1{n:10d}    8    0    1", " -2" + "".join(f"{i + 1:10d}" for i in nodes)]
    text += [" -3", "  100CL  101 1.000000000", " -4  DISP        4    1", *rows(*u)]
    text += ["  100CL  101 1.000000000", " -4  STRESS      6    1", *rows(*sigma), " 9999"]
    path.write_text("\n".join(text) + "\n")


def put(elements, place, kind):
    """The nodes in a file of that kind."""
    r, z, fields, layer, cells = elements.mesh()
    s, u = {name[-2:]: fields[name] for name in STRESSES}, fields["displacement"].T
    if kind == "vtu":
        (place / "own.vtu").write_bytes((elements.folder / "own.vtu").read_bytes())
    elif kind == "csv":
        heads = ["r", "z", "layer", "sigma_rr", "sigma_tt", "sigma_zz", "sigma_rz", "u_r", "u_z"]
        written(place / "nodes.csv", heads, [r, z, layer, s["xx"], s["yy"], s["zz"], s["xz"], u[0], u[2]])
    else:
        o = 0 * r
        frd(place / "own.frd", r, -z, (s["xx"], s["zz"], s["yy"], -s["xz"], o, o), (u[0], -u[2], o), cells)


@pytest.mark.parametrize("kind", ["vtu", "csv", "frd"])
def test_nodes_say_what_the_elements_say_up_to_the_interpolation_error(elements, kind):
    axes = {"vtu": '["r", "t", "z"]', "csv": '["r", "z"]', "frd": '["r", "-z"]'}[kind]
    guest, asked, place = elements.guest(axes)
    put(elements, place, kind)
    answer = read_answer(guest, elements.case, asked)
    assert (answer.error, answer.failed, answer.missing, answer.warnings) == (None, {}, {}, [])
    for key, (error, own, U) in elements.errors(answer, asked).items():
        assert error <= 1.2 * own + 2 * U + 1e-5, key  # six digits of an .frd
        assert error < 2e-3, key


def test_a_quarter_of_a_body_is_mirrored(elements):
    guest, asked, place = elements.guest('["x", "y", "z"]')
    a, h = elements.case.loaded.load_radius, elements.case.problem.coatings[0][2]
    steps = 6 * a * np.linspace(0, 1, 17) ** 2
    rows = []
    for layer, depths in enumerate((np.linspace(0, h, 9), h + 6 * a * np.linspace(0, 1, 9) ** 2)):
        x, y, z = (v.ravel() for v in np.meshgrid(steps, steps, depths, indexing="ij"))
        sigma, u = elements.solution.stress(x, y, z, layer=layer), elements.solution.displacement(x, y, z)
        rows.append([x, y, z, layer + 0 * x, *(sigma[c] for c in STRESSES.values()), *u])
    written(place / "nodes.csv", ["x", "y", "z", "material", *STRESSES, *DISPLACEMENTS], np.hstack(rows))
    answer = read_answer(guest, elements.case, asked)
    assert (answer.error, answer.failed, answer.missing, answer.warnings) == (None, {}, {}, [])
    found = elements.errors(answer, asked)
    assert all(error <= own + 3 * U + 1e-3 for error, own, U in found.values())
    assert np.median([error for error, *_ in found.values()]) < 0.02


def test_one_value_for_two_materials_is_named(elements):
    guest, asked, place = elements.guest('["r", "z"]')
    r, z, fields, layer, _ = elements.mesh()
    h = elements.case.problem.coatings[0][2]
    shared = np.isclose(z, h, rtol=1e-9)
    keep = ~(shared & (layer == 1))
    mean = {}
    for name in NAMES:
        upper, lower = (
            fields[name][shared & (layer == k)][np.argsort(r[shared & (layer == k)])] for k in (0, 1)
        )
        value = fields[name].copy()
        order = np.flatnonzero(shared & (layer == 0))[np.argsort(r[shared & (layer == 0)])]
        value[order] = (upper + lower) / 2
        mean[name] = value[keep]
    heads = ["r", "z", "sigma_rr", "sigma_tt", "sigma_zz", "sigma_rz"]
    columns = [mean[n] for n in ("sigma_xx", "sigma_yy", "sigma_zz", "sigma_xz")]
    written(place / "nodes.csv", heads, [r[keep], z[keep], *columns])
    answer = read_answer(guest, elements.case, asked)
    assert len(answer.warnings) == 1
    assert "averaged across it" in answer.warnings[0]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("r,z,sigma_rr,sigma_zz\n1e-6,1e-6,1,1\n", "sigma_tt is missing"),
        ("r,z,other\n1e-6,1e-6,1\n", "its fields are other"),
        ("r,sigma_rr\n1e-6,1\n", "'z'"),
        ("r,z,u_r,u_z\n1e-6,-1e-6,1,1\n", '"-z"'),
        ("r,z,u_r,u_z\n1e-6,1e-6,1,1\n", "1 nodes in layer 0"),
        ("r,z,layer,u_r,u_z\n1e-6,1e-6,0,1,1\n", "of 1 layers; this problem has 2"),
        ("r,z,u_r,u_z\n1e-6,1e-6,much,1\n", "row 2, u_r: 'much'"),
    ],
)
def test_nodes_that_cannot_be_used_are_refused_with_a_reason(elements, text, words):
    guest, asked, place = elements.guest('["r", "z"]')
    (place / "nodes.csv").write_text(text)
    with pytest.raises(ProtocolError, match=words):
        read_answer(guest, elements.case, asked)


def test_pack_shows_where_the_points_lie(tmp_path):
    done = coatcheck("guest", "pack", "mine", CASE, "--mesh-hint", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "8.662e-05" in done.stdout.replace("\n", "")
