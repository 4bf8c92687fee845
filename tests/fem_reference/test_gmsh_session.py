"""gmsh leaves no trace: not in the process, not on the terminal, not between threads."""

import builtins
import os
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import gmsh
import numpy as np
import pytest

from fem_reference import solve, write_vtu
from fem_reference.meshing.gmsh_session import session
from fem_reference.meshing.mesh import Grading, meridian_mesh

COARSE = Grading(size=0.6, edge_rate=0.6, edge_size=1e-3, axis_size=0.6, far_size=1.0)


def mesh(a=1.0, thicknesses=(0.5,)):
    return meridian_mesh(contact_radius=a, thicknesses=thicknesses, far=500.0, grading=COARSE)


def test_triangles_grow_more_slowly_beyond_a_deep_stack():
    def growth(depth):
        """Size of triangles a unit of the stretched plane beyond the uniform ones, over theirs."""
        graded = Grading(size=0.12, edge_rate=0.6, edge_size=1e-3, axis_size=0.3, far_size=1.0, rows=1.0)
        made = meridian_mesh(contact_radius=1.0, thicknesses=(depth,), far=500.0, grading=graded)
        corners = np.arcsinh((made.points - [[1.0], [0.0]]) / made.length)[:, made.triangles]
        side, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        size, (x, y) = np.sqrt(np.abs(side[0] * other[1] - side[1] * other[0])), corners.mean(axis=1)
        beyond = np.hypot(x, y) - max(np.arcsinh(3.0), np.arcsinh(depth))
        clear = y < 0.5 * np.arcsinh(depth)  # of the interface, which has smaller ones
        before, after = (np.median(size[clear & (np.abs(beyond - at) < 0.25)]) for at in (-0.3, 1.0))
        return after / before

    assert growth(2.9) > 1.3
    assert 1.05 < growth(30.0) < 1.25


def arguments(thickness):
    return {
        "radius": 1e-2,
        "load": 20.0,
        "coatings": ((420e9, 0.3, thickness),),
        "substrate": (210e9, 0.3),
        "size": 0.4,
        "order": 2,
        "estimate_uncertainty": False,
    }


def quick(thickness=5e-5, **keywords):
    return solve(**arguments(thickness) | keywords)


def radius_of(thickness):
    return quick(thickness).contact_radius


def test_gmsh_is_shut_down_and_signals_are_untouched():
    before = signal.getsignal(signal.SIGINT)
    mesh()
    assert not gmsh.isInitialized()
    assert signal.getsignal(signal.SIGINT) is before


def test_without_pipes_that_close_gmsh_meshes_the_same(monkeypatch):
    """As on Windows, where there is no such signal."""
    expected = mesh()
    try:
        with monkeypatch.context() as patch:
            patch.delattr(signal, "SIGPIPE")
            found = mesh()
    finally:
        signal.signal(signal.SIGPIPE, signal.SIG_IGN)  # which gmsh resets
    np.testing.assert_array_equal(found.points, expected.points)
    assert not gmsh.isInitialized()


@pytest.mark.slow
def test_threads_and_processes_get_the_same_answers():
    # Another number of threads sums in another order.
    environment = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    thicknesses = [2e-5, 9e-5]
    expected = [radius_of(h) for h in thicknesses]
    with ThreadPoolExecutor(2) as threads:
        assert list(threads.map(radius_of, thicknesses)) == expected
    texts = [
        f"from fem_reference import solve; print(solve(**{arguments(h)!r}).contact_radius.hex())"
        for h in thicknesses
    ]
    processes = [
        subprocess.Popen([sys.executable, "-c", text], env=environment, stdout=subprocess.PIPE, text=True)
        for text in texts
    ]
    assert [float.fromhex(process.communicate(timeout=120)[0]) for process in processes] == expected


def test_a_running_session_of_the_caller_survives():
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.Algorithm", 5)
        gmsh.model.add("mine")
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.add("other")
        gmsh.model.setCurrent("mine")
        mesh()
        assert gmsh.isInitialized()
        assert gmsh.model.getCurrent() == "mine"
        assert sorted(gmsh.model.list()) == ["", "mine", "other"]
        assert gmsh.option.getNumber("Mesh.Algorithm") == 5
        assert len(gmsh.model.getEntities(3)) == 1
    finally:
        gmsh.finalize()
        signal.signal(signal.SIGPIPE, signal.SIG_IGN)  # which gmsh resets


def test_a_failing_mesh_leaves_nothing_behind():
    with pytest.raises(RuntimeError, match="on purpose"), session("broken"):
        raise RuntimeError("on purpose")
    assert not gmsh.isInitialized()
    assert mesh().layer.size > 0


def test_nothing_reaches_the_terminal_and_the_package_alone_does_not_import_gmsh():
    code = (
        "import sys\n"
        "from fem_reference import solve\n"
        "assert 'gmsh' not in sys.modules\n"
        "solve(radius=1e-2, load=20.0, coatings=((4e11, 0.3, 5e-5),), substrate=(2e11, 0.3), "
        "size=0.5, order=2)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_missing_system_libraries_are_named(monkeypatch):
    real = builtins.__import__

    def refuse(name, *args, **keywords):
        if name == "gmsh":
            raise OSError("libGLU.so.1: cannot open shared object file: No such file or directory")
        return real(name, *args, **keywords)

    monkeypatch.setattr(builtins, "__import__", refuse)
    with pytest.raises(ImportError, match=r"libGLU.*apt-get install.*libglu1-mesa") as caught, session("x"):
        pass
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("thicknesses", [(), (0.01,), (20.0,), (0.01,) * 5, (1.0, 0.05, 0.01, 0.3, 2.0)])
@pytest.mark.parametrize("a", [0.3, 3.0])
def test_every_layer_is_filled_and_its_boundaries_are_met(thicknesses, a):
    m = mesh(a, thicknesses)
    corners = m.points[:, m.triangles]
    (r0, z0), (r1, z1), (r2, z2) = corners.transpose(1, 0, 2)
    area = ((r1 - r0) * (z2 - z0) - (r2 - r0) * (z1 - z0)) / 2
    levels = np.array([0.0, *np.cumsum(thicknesses), m.far])
    assert np.all(area > 0)
    for k in range(len(levels) - 1):
        mine = m.layer == k
        # the triangles of a layer tile its rectangle
        assert area[mine].sum() == pytest.approx(m.far * (levels[k + 1] - levels[k]), rel=1e-12)
        assert corners[1][:, mine].min() == levels[k]
        assert corners[1][:, mine].max() == levels[k + 1]
    assert np.any((m.points[0] == a) & (m.points[1] == 0))
    # thick coatings and buried films need no fine triangles
    assert m.layer.size < 2000


@pytest.mark.parametrize(("a", "thicknesses"), [(50.0, ()), (1.0, (250.0,))])
def test_contact_and_coatings_as_large_as_the_solid_are_refused(a, thicknesses):
    with pytest.raises(ValueError, match="far boundary"):
        mesh(a, thicknesses)


def test_stretching_keeps_depths_and_moves_the_edge():
    m = mesh().stretched(1.03)
    assert m.contact_radius == 1.03
    assert np.any((m.points[0] == 1.03) & (m.points[1] == 0))
    assert np.any(m.points[1] == 0.5)
    xi, zeta = m.plane(*m.points)
    np.testing.assert_allclose(1.03 * (1 + m.length * np.sinh(xi)), m.points[0], rtol=0, atol=1e-12)
    np.testing.assert_allclose(m.length * np.sinh(zeta), m.points[1], rtol=0, atol=1e-12)
    assert m.length == pytest.approx(np.sqrt(0.5))


def test_vtu_holds_layers_and_both_sides_of_the_interface(tmp_path):
    import meshio

    s = quick(friction=0.3)
    path = write_vtu(s, tmp_path / "contact.vtu")
    read = meshio.read(path)
    layer = read.cell_data["layer"][0]
    assert set(layer) == {0, 1}
    cells = read.cells_dict["triangle6"]
    x, _, z = read.points.T
    assert 15 * s.contact_radius < x.max() < 20 * s.contact_radius
    on_interface = np.isclose(z, 5e-5, rtol=1e-12, atol=0)
    upper, lower = (np.intersect1d(np.flatnonzero(on_interface), cells[layer == k]) for k in (0, 1))
    assert np.intersect1d(upper, lower).size == 0
    near = upper[np.abs(x[upper]) < 1e-4]
    expected = s.stress(x[near], 0.0, z[near], layer=0)[0, 0]
    np.testing.assert_allclose(read.point_data["sigma_xx [Pa]"][near], expected, rtol=1e-12)
    assert x.min() < 0 < x.max()
    with pytest.raises(ValueError, match=r"\.vtu"):
        write_vtu(s, tmp_path / "contact.txt")


PIPE = """
import os, signal, sys, threading
from fem_reference.meshing.gmsh_session import session
def mesh():
    with session("one"):
        pass
def other_thread():
    threading.Thread(target=mesh).start()
    [one.join() for one in threading.enumerate() if one is not threading.main_thread()]
def default():
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    mesh()
locals()[sys.argv[1]]()
end, begin = os.pipe()
os.close(end)
try:
    os.write(begin, b"x")
except BrokenPipeError:
    print("seen")
"""


@pytest.mark.parametrize(
    ("mesher", "code", "said"),
    [("mesh", 0, "seen\n"), ("other_thread", 0, "seen\n"), ("default", -signal.SIGPIPE, "")],
)
def test_a_write_to_a_closed_pipe_ends_as_before(mesher, code, said):
    done = subprocess.run([sys.executable, "-c", PIPE, mesher], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (code, said), done.stderr
