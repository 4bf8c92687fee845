"""A measured surface as indenter, against Hertz, tamaas, and itself turned, tilted, in another unit."""

import importlib.util
import sys
from math import pi
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest
from map_of_heights import write_sdf
from quick_case import coatcheck

from verification.cases.case_file import parse_case
from verification.cases.toml_file import CaseError
from verification.desk.case_wording import case_text
from verification.desk.measured.surface_contact import pressed
from verification.desk.measured.surface_map import levelled, read_map

N, L, R = 96, 200e-6, 5e-3
X = (np.arange(N) + 0.5) / N * L - L / 2
CAP = -(X[:, None] ** 2 + X[None, :] ** 2) / (2 * R)
ROUGH = 30e-9 * np.cos(2 * pi * 9 * X / L)[:, None] * np.cos(2 * pi * 7 * X / L + 1)[None, :]
LOAD, E_STAR = 5.0, 210e9 / (1 - 0.3**2)
A = (3 * LOAD * R / (4 * E_STAR)) ** (1 / 3)
P0 = 3 * LOAD / (2 * pi * A * A)


def case_of(*coatings, ball=f"{R!r}", substrate="210 GPa, 0.3"):
    return parse_case(case_text(ball, f"{LOAD} N", substrate, coatings).encode(), Path("words"))


def map_of(heights):
    return levelled(heights, [L, L], "um", Path("map"))


def value(contact, quantity, where):
    return next(at for at in contact.answer.extremes if (at.quantity, at.where) == (quantity, where))


@pytest.fixture
def reader(monkeypatch):
    """Stands in for SurfaceTopography: a file's text is the unit, ``heights`` its content in that unit."""
    held = SimpleNamespace(heights=CAP / 1e-6, sizes=(L / 1e-6, L / 1e-6), unit="µm")

    def opened(path):
        channel = SimpleNamespace(unit=held.unit, nb_grid_pts=held.heights.shape, physical_sizes=held.sizes)

        def topography(physical_sizes=held.sizes):
            return SimpleNamespace(physical_sizes=physical_sizes, heights=lambda: held.heights)

        return SimpleNamespace(channels=[channel], topography=topography)

    module = ModuleType("SurfaceTopography")
    module.open_topography = opened
    monkeypatch.setitem(sys.modules, "SurfaceTopography", module)
    return held


def test_a_tilted_cap_presses_as_the_sphere_of_hertz():
    found = pressed(map_of(CAP + 3e-3 * X[:, None] - 1e-3 * X[None, :]), case_of())
    p0, U = found.answer.numbers["peak_pressure"]
    assert abs(p0 - P0) < U + 1e-4 * P0  # the spline through the pixels
    assert found.area[0] == pytest.approx(pi * A * A, rel=1e-3)
    # Johnson (1985) 3.4: von Mises 0.62 p0 at 0.48 a on the axis
    deep = value(found, "von_mises", "substrate")
    assert deep.value == pytest.approx(0.62 * P0, rel=5e-3)
    assert deep.z == pytest.approx(0.48 * A, rel=0.05)
    # the tension of the rim, (1 - 2 nu)/3 p0, is at the edge between patches
    rim = value(found, "sigma_1", "substrate")
    assert rim.value == pytest.approx(0.4 / 3 * P0, abs=max(rim.uncertainty, 0.1 * 0.4 / 3 * P0))


def test_a_flat_map_on_a_ball_is_that_ball_and_roughness_makes_less_contact():
    smooth, rough = (pressed(map_of(h).on_ball(R), case_of()) for h in (0 * CAP, ROUGH))
    assert smooth.solution.peak_pressure == pytest.approx(P0, rel=1e-5)
    assert rough.area[0] < 0.9 * smooth.area[0]
    assert rough.solution.peak_pressure > 1.2 * smooth.solution.peak_pressure
    assert sum(rough.solution.patch_pressure.ravel()) * (L / 97) ** 2 == pytest.approx(LOAD, rel=1e-6)


@pytest.mark.slow
def test_a_residual_stress_adds_to_the_tension_at_the_surface():
    words = "3 um, 300 GPa, 0.25"
    without, with_it = (
        value(pressed(map_of(CAP), case_of(w)), "sigma_1", "coating 1")
        for w in (words, f"{words}, residual 1 GPa")
    )
    assert with_it.value == pytest.approx(without.value + 1e9, rel=0.05)


@pytest.mark.skipif(not importlib.util.find_spec("tamaas"), reason="extra bench")
@pytest.mark.filterwarnings("ignore")
def test_pressures_are_those_of_tamaas_on_the_same_rough_surface():
    import tamaas

    surface, case = map_of(ROUGH).on_ball(R), case_of()
    found = pressed(surface, case).solution
    n = found.nodes.size
    tamaas.set_log_level(tamaas.LogLevel.error)
    sides = [2 * surface.half_width] * 2
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, sides, [n, n])
    model.E, model.nu = 210e9, 0.3
    heights = -surface.gap(found.nodes[:, None], found.nodes[None, :])
    solver = tamaas.PolonskyKeerRey(model, heights, 1e-10)
    tamaas.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver.setIntegralOperator("dcfft")
    solver.solve(LOAD / (2 * surface.half_width) ** 2)
    peers = np.asarray(model.traction).reshape(n, n)
    assert np.abs(peers - found.patch_pressure).max() < found.uncertainty.peak_pressure
    assert np.count_nonzero(peers > 0) == pytest.approx(found.diagnostics.patches, rel=0.02)


def test_unit_and_size_are_of_the_file_or_given_once(reader, tmp_path):
    path = tmp_path / "map.sdf"
    path.write_text("")
    np.testing.assert_allclose(read_map(path).heights, map_of(CAP).heights, atol=1e-15)
    reader.heights, reader.sizes, reader.unit = CAP / 1e-9, (L / 1e-9, L / 1e-9), "nm"
    np.testing.assert_allclose(read_map(path).heights, map_of(CAP).heights, atol=1e-15)
    for unit, size, said in (("um", None, "leave out --unit"), (None, L, "leave out --size")):
        with pytest.raises(CaseError, match=said):
            read_map(path, unit, size)
    reader.sizes = reader.unit = None
    for unit, size, said in ((None, L, "give --unit"), ("nm", None, "--size")):
        with pytest.raises(CaseError, match=said):
            read_map(path, unit, size)
    assert read_map(path, "nm", L).half_width == pytest.approx(L / 2)


def test_points_without_data_are_filled_and_counted_and_too_many_refused(reader, tmp_path):
    path = tmp_path / "map.sdf"
    path.write_text("")
    without = np.zeros(CAP.shape, dtype=bool)
    without[40:43, 50:54] = True
    reader.heights = np.ma.masked_array(CAP / 1e-6, without)
    found = read_map(path)
    assert found.filled == 12
    assert np.isfinite(found.heights).all()
    reader.heights = np.ma.masked_less(CAP / 1e-6, np.median(CAP) / 1e-6)
    with pytest.raises(CaseError, match="no data"):
        read_map(path)


def test_a_map_that_is_upside_down_is_named_and_turned(reader, tmp_path):
    (tmp_path / "map.sdf").write_text("")
    words = ["surface", "map.sdf", "--load", f"{LOAD} N", "--substrate", "210 GPa, 0.3"]
    upright = coatcheck(*words, cwd=tmp_path)
    assert upright.returncode == 0
    assert f"Peak pressure {P0 / 1e6:.4g}"[:17] in upright.stdout
    reader.heights = -reader.heights
    refused = coatcheck(*words, cwd=tmp_path)
    assert refused.returncode == 2
    assert "upside down" in refused.stderr
    turned = coatcheck(*words, "--turn", "--plot", "map.png", cwd=tmp_path)
    assert turned.stdout.split("time:")[0] == upright.stdout.split("time:")[0]
    assert (tmp_path / "map.png").stat().st_size > 10_000


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--ball", "stel"], "'stel' is not among"),
        (["--load", "5000 N"], "rim of the map"),
        (["--size", "100 um"], "leave out --size"),
        (["--plot", "map.doc"], "--plot"),
    ],
)
def test_wrong_words_are_one_message_and_write_nothing(words, said, reader, tmp_path):
    (tmp_path / "map.sdf").write_text("")
    given = {"--load": "5 N", "--substrate": "Si"} | dict(zip(words[::2], words[1::2], strict=True))
    done = coatcheck("surface", "map.sdf", *(part for pair in given.items() for part in pair), cwd=tmp_path)
    assert done.returncode in (2, 3)
    assert said in done.stderr
    assert done.stderr.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["map.sdf"]


@pytest.mark.skipif(not importlib.util.find_spec("SurfaceTopography"), reason="extra surfaces")
@pytest.mark.filterwarnings("ignore")
def test_a_file_of_iso_25178_is_read_by_surfacetopography(tmp_path):
    write_sdf(tmp_path / "map.sdf", CAP, L)
    np.testing.assert_allclose(read_map(tmp_path / "map.sdf").heights, map_of(CAP).heights, atol=1e-12)
    (tmp_path / "no.txt").write_text("this is no map\n")
    with pytest.raises(CaseError, match="does not read it"):
        read_map(tmp_path / "no.txt")
