"""Nested iteration of ``indent``: quarter and window of the plane, levels of the heights, what falls back."""

from dataclasses import replace

import numpy as np
import pytest

import semianalytic
from semianalytic.edge import edge_correction
from semianalytic.patches import nested

R, W = 10e-3, 20.0
STEEL = (210e9, 0.3)
E_STAR = STEEL[0] / (1 - STEEL[1] ** 2)
A_H = (0.75 * W * R / E_STAR) ** (1 / 3)
P_H = 1.5 * W / (np.pi * A_H**2)


def indent(profile, **options):
    given = {"load": W, "coatings": (), "substrate": STEEL, "patches": 129, "estimate_uncertainty": False}
    return semianalytic.indent(profile=profile, half_width=2 * A_H, **given | options)


def ellipsoid(x, y):
    return (x**2 + 1.1 * y**2) / (2 * R)


@pytest.mark.parametrize("patches", [66, 65, 68])
@pytest.mark.parametrize("E", [None, 840e9])
@pytest.mark.parametrize(("curved", "edge"), [(1, False), (3, False), (3, True)])
def test_even_indenter_is_solved_on_a_quarter_as_on_the_whole(patches, curved, E, edge):
    """The last digit of a height off the axes keeps the other from being even.

    Of a smooth edge along a diagonal rounding decides how its patches are divided: not of an ellipse.
    """

    def solved(last_digit):
        return indent(
            lambda x, y: (x**2 + y**2 / curved) / (2 * R) * np.where(x + y > 0, last_digit, 1),
            coatings=((E, 0.3, 0.4 * A_H),) if E else (),
            patches=patches,
            edge_correction=edge,
        )

    quarter, whole = solved(1), solved(1 + 2**-52)
    np.testing.assert_array_equal(quarter.patch_pressure, quarter.patch_pressure[::-1, ::-1])
    assert not np.array_equal(whole.patch_pressure, whole.patch_pressure[::-1])
    assert quarter.diagnostics.iterations == whole.diagnostics.iterations
    for name in ("approach", "peak_pressure", "contact_radius"):
        assert getattr(quarter, name) == pytest.approx(getattr(whole, name), rel=1e-12)
    atol = 1e-12 * whole.peak_pressure
    np.testing.assert_allclose(quarter.patch_pressure, whole.patch_pressure, rtol=0, atol=atol)


def test_a_shape_that_is_even_on_coarse_grids_alone_is_solved_on_the_whole_of_the_fine_one():
    """Its last digit differs at a corner beyond the centres of the coarser grid's patches."""

    def profile(x, y):
        beyond = (x > 2 * A_H * (1 - 1 / 100)) & (y > 2 * A_H * (1 - 1 / 100))
        return ellipsoid(x, y) * np.where(beyond, 1 + 2**-52, 1)

    even, whole = indent(ellipsoid), indent(profile)
    assert not np.array_equal(whole.patch_pressure, whole.patch_pressure[::-1])
    np.testing.assert_allclose(whole.patch_pressure, even.patch_pressure, rtol=0, atol=1e-6 * P_H)
    assert whole.approach == pytest.approx(even.approach, rel=1e-9)


@pytest.mark.parametrize("control", [{"load": W}, {"load": None, "approach": A_H**2 / R}])
def test_heights_count_from_any_level(control):
    s, raised = (
        indent(lambda x, y, z=z: z + (x**2 + 1.1 * y**2 + 0.1 * x * y) / (2 * R), **control)
        for z in (0.0, 3 * A_H)
    )
    assert raised.approach == pytest.approx(s.approach, rel=1e-8)
    assert raised.diagnostics.load == pytest.approx(s.diagnostics.load, rel=1e-6)
    np.testing.assert_allclose(raised.patch_pressure, s.patch_pressure, rtol=0, atol=1e-4 * P_H)


@pytest.mark.parametrize("n", [33, 34])
def test_lowest_point_between_the_patches_is_found(n):
    grid, tip = nested.Grid(n, 0.1), (0.523, -0.241)

    def between(x, y):
        return 7 + np.add.outer((x - tip[0]) ** 2, 2 * (y - tip[1]) ** 2)

    indenter = nested.Indenter(lambda grid: between(grid.x, grid.x), 1.0, None, round=False)
    gap = indenter.gap(grid)
    assert nested.lowest_point(grid, gap, indenter) == gap.min() > 7 + 1e-4
    found = nested.lowest_point(grid, gap, replace(indenter, between=between))
    assert 7 <= found < 7 + 1e-5


def test_contact_that_reaches_the_rim_of_its_window_is_solved_on_the_whole_square(monkeypatch):
    """Also where the window ends with the last loaded patch, and its edge lies just beyond."""
    expected, window_around = indent(ellipsoid), nested.window_around
    for cut in (9, 10, 11, 20):

        def small(*given, cut=cut):
            window = window_around(*given)
            return replace(window, i1=window.i1 - cut)

        monkeypatch.setattr(nested, "window_around", small)
        assert indent(ellipsoid).approach == pytest.approx(expected.approach, rel=1e-7)


def test_edge_that_is_lost_on_the_finest_grid_is_left_to_the_patches(monkeypatch):
    expected, rounds, found = indent(ellipsoid, edge_correction=False), edge_correction._rounds, []

    def lost(problem, *given):
        found.append(problem.grid.n)
        return None if problem.grid.n == 129 else rounds(problem, *given)

    monkeypatch.setattr(edge_correction, "_rounds", lost)
    s = indent(ellipsoid)
    assert found.count(129) > 1  # from the coarser shape, then from the patches
    assert s.contact_radius == expected.contact_radius
    # both to the tolerance of the iteration
    np.testing.assert_allclose(s.patch_pressure, expected.patch_pressure, rtol=0, atol=1e-6 * P_H)


@pytest.mark.parametrize("level", [0.0, 1.0])
def test_contacts_beyond_the_window_of_a_quarter_are_found(level):
    """A ring so narrow that the coarser grids, 33 and 65 patches a side, have no patch in it."""
    tip, d = 0.3, 2 / 130
    ring = 50.5 * d

    def profile(x, y):
        spot = (np.abs(np.abs(x) - ring) < 0.1 * d) & (np.abs(np.abs(y) - ring) < 0.1 * d)
        return level + np.where(spot, 0.0, (x**2 + y**2) / (2 * tip))

    s = semianalytic.indent(
        profile=profile,
        half_width=1.0,
        load=None,
        approach=0.1,
        coatings=(),
        substrate=(1.0, 0.0),
        patches=130,
        estimate_uncertainty=False,
    )
    assert s.pressure(ring, ring) > 0
    assert s.diagnostics.penetration_outside < 1e-8
