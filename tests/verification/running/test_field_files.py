"""Boxes for ParaView: the stresses of the Solutions with names, units, case file and checksum."""

import numpy as np
import pytest
from case_texts import case_text

import fem_reference
import semianalytic
from verification.cases.case_file import parse_case
from verification.problem.coated_contact import keywords
from verification.problem.quantity import STRESSES
from verification.running.checked_files import StoreError
from verification.running.stored_fields import confirm_fields, write_fields
from verification.sampling import vtk_files
from verification.sources.references.hertz import Hertz

pv = pytest.importorskip("pyvista")

CASE = case_text("E = 420e9; nu = 0.25; thickness = 40e-6", more="friction = 0.3").encode()
FIELDS = {"displacement [m]", "von_mises [Pa]", *(f"{name} [Pa]" for name in STRESSES)}


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    return parse_case(CASE, tmp_path_factory.mktemp("case") / "one.toml")


@pytest.fixture(scope="module")
def solutions(case):
    problem = keywords(case.problem)
    return {
        "semianalytic": semianalytic.solve(**problem, patches=65, estimate_uncertainty=False),
        "fem_reference": fem_reference.solve(**problem, size=0.5, estimate_uncertainty=False),
    }


@pytest.fixture(scope="module")
def folder(tmp_path_factory, case, solutions):
    folder = tmp_path_factory.mktemp("run")
    write_fields(case, solutions, folder)
    confirm_fields(folder, "one", case.text)
    return folder / "fields"


BOXES = [f"{which}-layer-{k}.vtr" for which in ("fem", "fem-far", "semi") for k in (0, 1)]


@pytest.fixture(scope="module", params=BOXES)
def grid(request, folder):
    """Each file that holds stresses."""
    return pv.read(folder / f"one-{request.param}")


class SideBySide:
    """Two equal sliding contacts at x = +-``apart`` [m], whose fields add: four edges on y = 0."""

    def __init__(self, one, apart):
        self.one, self.ends = one, (-apart, apart)
        self.contact_radius, self.approach = 2**0.5 * one.contact_radius, one.approach
        self.peak_pressure = one.peak_pressure

    def pressure(self, x, y=0.0):
        return sum(self.one.pressure(x + end, y) for end in self.ends)

    def stress(self, x, y, z, layer=None):
        return sum(self.one.stress(x + end, y, z) for end in self.ends)

    def displacement(self, x, y, z):
        return sum(self.one.displacement(x + end, y, z) for end in self.ends)


def solved(case):
    return fem_reference.solve(**keywords(case.problem), estimate_uncertainty=False)


def beside(case):
    one = Hertz(case.problem.radius, case.problem.load, *case.problem.substrate, case.problem.friction)
    return SideBySide(one, 1.7 * one.contact_radius)


@pytest.mark.parametrize(
    ("coating", "friction", "solve", "files"),
    [
        ((420e9, 0.3), 0.0, solved, ("fem", "fem-far")),
        pytest.param((420e9, 0.25), 0.3, solved, ("fem", "fem-far"), marks=pytest.mark.slow),
        ((210e9, 0.3), 0.2, beside, ("fem",)),
    ],
    ids=["coated", "sliding", "not round"],
)
def test_a_line_sampled_as_pyvista_does_by_default_has_the_stresses_of_the_solution(
    coating, friction, solve, files, tmp_path, monkeypatch
):
    monkeypatch.setattr(vtk_files, "PLANES", dict(list(vtk_files.PLANES.items())[: len(files)]))
    text = case_text("E = {}; nu = {}; thickness = 70e-6".format(*coating), more=f"friction = {friction}")
    case = parse_case(text.encode(), tmp_path / "one.toml")
    solution = solve(case)
    write_fields(case, {"fem_reference": solution}, tmp_path)
    a, h = solution.contact_radius, 70e-6
    x = np.linspace(0, 2 * a, 201)
    for file in files:
        blocks = pv.read(tmp_path / "fields" / f"one-{file}.vtm")
        assert blocks.n_blocks == 2
        for z, layer in ((0, 0), (h, 0), (h, 1), (0.48 * a, 0), (0.3 * h, 0), (1.5 * a, 1)):
            ends = (0, 0, 1e6 * z), (2e6 * a, 0, 1e6 * z)
            line = blocks[layer].sample_over_line(*ends, resolution=200).point_data
            assert line["vtkValidPointMask"].all()
            sigma = solution.stress(x, 0.0, z, layer=layer)
            for name, component in STRESSES.items():
                error = line[f"{name} [Pa]"] - sigma[component]
                assert np.abs(error).max() < 1e-3 * solution.peak_pressure
            u = solution.displacement(x, 0.0, z)
            assert np.abs(line["displacement [m]"] - u.T).max() < 1e-3 * solution.approach


def test_the_boxes_carry_stress_and_displacement_layer_by_layer(folder, solutions):
    index = pv.read(folder / "one-semi.vtm")
    assert [index.get_block_name(k) for k in range(index.n_blocks)] == ["layer 0", "layer 1"]
    solution, p0 = solutions["semianalytic"], solutions["semianalytic"].peak_pressure
    for layer, grid in enumerate(index):
        assert set(grid.point_data) == FIELDS
        assert set(grid.cell_data["layer"]) == {layer}
        x, y, z = grid.points.T / vtk_files.UM
        assert np.abs(x).min() < 1e-9 * solution.contact_radius
        # each box reaches beyond its layer, with the values on the side of its interface
        z = np.where(z < 0, 0.0, np.minimum(z, 40e-6) if layer == 0 else np.maximum(z, 40e-6))
        # Below eight patches whole patches are as good as the halved ones that single points stand on.
        deep = np.flatnonzero((z > 8 * solution.diagnostics.patch_size) | (z == 0))
        some = np.random.default_rng(layer).choice(deep, 60, replace=False)
        sigma = solution.stress(x[some], y[some], z[some], layer=layer)
        u = solution.displacement(x[some], y[some], z[some])
        for name, component in STRESSES.items():
            given = grid.point_data[f"{name} [Pa]"][some]
            np.testing.assert_allclose(given, sigma[component], atol=2e-4 * p0)
        given = grid.point_data["displacement [m]"][some]
        # a box is sampled on planes of patches, least accurate at the contact edge on the surface
        np.testing.assert_allclose(given, u.T, rtol=0, atol=1e-4 * solution.approach)
    upper, lower = (grid.points[:, 2] for grid in index)
    assert lower.min() < 40 < upper.max()
    assert lower.min() == pytest.approx(upper.max(), rel=3e-6)


def test_von_mises_is_that_of_the_six_stresses(grid):
    data = grid.point_data
    xx, yy, zz, xy, yz, xz = (data[f"sigma_{name} [Pa]"] for name in ("xx", "yy", "zz", "xy", "yz", "xz"))
    square = ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * (xy**2 + yz**2 + xz**2)
    np.testing.assert_allclose(data["von_mises [Pa]"], np.sqrt(square), rtol=1e-6, atol=1.0)


@pytest.mark.slow
def test_damage_and_other_case_files_are_noticed(tmp_path, case, solutions):
    write_fields(case, {"fem_reference": solutions["fem_reference"]}, tmp_path)
    with pytest.raises(StoreError, match="another"):
        confirm_fields(tmp_path, "one", "another")
    mesh = tmp_path / "fields" / "one-fem-layer-1.vtr"
    data = bytearray(mesh.read_bytes())
    data[len(data) // 2] ^= 4
    mesh.write_bytes(data)
    for _ in ("damaged", "missing"):
        with pytest.raises(StoreError, match=r"one-fem-layer-1\.vtr"):
            confirm_fields(tmp_path, "one", case.text)
        mesh.unlink(missing_ok=True)
