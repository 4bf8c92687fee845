"""Errors of the semi-analytical method: discs under given pressures, DC-FFT, films, elliptical contacts.

A uniform pressure and Hertz's, which slides, on the surface, inside, on both sides of each interface. Nothing
is iterated, so the error is that of the stress coefficients, of the influence coefficients and of the
convolution, each apart.

The axes of an ellipse are turned, so that the contact has no mirror plane in common with the grid; it is
Hertz's.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.signal import convolve

from verification.judging.invariants.influence_error import coefficient_error
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, keywords
from verification.problem.line_profile import lines_of
from verification.sources.references.axisymmetric_pressure import AbelPressure
from verification.sources.references.hankel_field import HankelField
from verification.sources.references.hertz_ellipse import HertzEllipse
from verification.sources.references.uniform_disc import UniformDisc

PATCHES = 129  # a side
UNIFORM, HERTZ = "uniform pressure", "Hertz's pressure"
# Of the radius: beside the rim, where the stress under a uniform pressure is infinite, not on it.
SURFACE = np.array([-1.7, -1.15, -0.97, -0.8, -0.5, -0.2, 0.0, 0.3, 0.6, 0.9, 1.02, 1.3])
DEPTHS = (0.02, 0.15, 0.48, 1.2, 2.5)
PLANE = 0.6  # depth of the plane by FFT, over ten patches, where patches of a pressure without steps suffice
INSIDE = np.array([-0.8, -0.55, -0.3, 0.0, 0.21, 0.47, 0.7])  # of the radius, off the patch centres
# Of the half-width of the grid: centres along an axis, off it, in the corner, none beside the rim.
QUARTER = ((0.0, 0.3, 0.75, 0.2, 0.5, 0.6, 0.9, 1.0), (0.0, 0.0, 0.0, 0.7, 0.5, 0.3, 0.9, 1.0))
SIDE = 0.07  # of a patch, over a_h
FILMS = {"film of one patch": 1.0, "film of five patches": 5.0}  # thickness over that
# of the long axis from x, under a given load or approach; the latter's window of the grid is a square that is
# not symmetric
ANGLES = {"load": 0.4, "approach": np.pi / 4}
BESIDE = 4.4  # patches along x and -y between the middles of the grid and of the turned ellipse
WIDE = 1.15  # half-width of the grid over the long semi-axis
MOST = 600  # iterations that are allowed


@dataclass(frozen=True)
class ExactError:
    """Largest ``error`` of ``quantity`` under ``pressure`` on ``solid``: stress and plane over the largest
    pressure, displacements over the exact one at the centre, scalars of an ellipse over themselves; or a
    count that has a limit."""

    pressure: str
    solid: str
    quantity: str
    error: float


def disc_errors(problem: CoatedContact, solid: str, friction: float) -> list[ExactError]:
    """Errors under both pressures on a disc as wide as the contact of Hertz, Hertz's with ``friction``."""
    a, p_h = problem.a_h, problem.p_h
    hertz = AbelPressure(a, p_h * a / 3 * np.array([1.0, -1.0]))
    found = []
    for name, disc, f in ((UNIFORM, UniformDisc(a, p_h), 0.0), (HERTZ, hertz, friction)):
        exact = HankelField(disc, problem.coatings, problem.substrate, f)
        found += [
            ExactError(name, solid, quantity, error)
            for quantity, error in _errors(replace(problem, friction=f), exact, p_h).items()
        ]
    return found


def _errors(problem: CoatedContact, exact: HankelField, p_h: float) -> dict[str, float]:
    import semianalytic

    a = exact.pressure.a
    given = exact.pressure.pressure
    solution = semianalytic.solve_prescribed(
        pressure=p_h if isinstance(exact.pressure, UniformDisc) else given,
        load_radius=a,
        coatings=problem.coatings,
        substrate=problem.substrate,
        friction=problem.friction,
        patches=PATCHES,
        estimate_uncertainty=False,
    )
    angle = 0.35  # off the mirror planes
    x, y = a * SURFACE * np.cos(angle), a * SURFACE * np.sin(angle)
    places: list[tuple[Array, int | None]] = [
        (np.full(x.shape, z), line.layer) for line in lines_of(problem) if (z := line.depth) is not None
    ]
    places += [(np.full(x.shape, z * a), None) for z in DEPTHS]
    stress = [solution.stress(x, y, z, k) - exact.stress(x, y, z, k) for z, k in places]
    u = [solution.displacement(x, y, z) - exact.displacement(x, y, z) for z, _ in places]
    sink = float(exact.displacement(0.0, 0.0, 0.0)[2])
    errors = {
        "stress, surface": _largest(stress[:1]) / p_h,
        "stress, inside": _largest(stress[1:]) / p_h,
        "displacement": _largest(u) / sink,
        "central deflection": abs(solution.approach - sink) / sink,
    }
    if not isinstance(exact.pressure, UniformDisc):
        i, j = (
            np.array([[0.1, 0.3, 0.5, 0.62, 0.87], [0.5, 0.15, 0.62, 0.25, 0.94]]) * (PATCHES - 1)
        ).astype(int)
        z = PLANE * a
        at = solution.nodes[i], solution.nodes[j], np.full(i.shape, z)
        errors["stress on a plane"] = (
            _largest([solution.stress_plane(z)[:, :, i, j] - exact.stress(*at)]) / p_h
        )
        plane = solution.displacement_plane(z)[:, i, j]
        errors["displacement on a plane"] = _largest([plane - exact.displacement(*at)]) / sink
        errors["deflection on a quarter"] = _deflection_error(problem, exact) / sink
        errors["stress of patches"] = _patch_error(problem, exact) / p_h
    return errors


def _patch_error(problem: CoatedContact, exact: HankelField) -> float:
    """Largest error of the stresses [Pa] half a patch and two below the surface, off the edge.

    They are summed over the patches, as under a rough indenter, in place of rings around each point.
    """
    from semianalytic.stresses import patch_field

    grid, mean, body = _under_patches(problem, exact)
    a = exact.pressure.a
    x, z = np.meshgrid(a * INSIDE, grid.d * np.array([0.5, 2.0]))
    y = np.full(x.shape, 0.13 * a)
    found = patch_field.stress(x, y, z, 0, grid_x=grid.x, pressure=mean, body=body)
    return _largest([patch_field.tensor(found) - exact.stress(x, y, z, 0)])


def _deflection_error(problem: CoatedContact, exact: HankelField) -> float:
    """Largest error [m] of the patches' deflection, as a round contact has it: held on a quarter of the grid.

    Influence coefficients and DC-FFT alone, off the edge, where constant patches are of third order.
    """
    from semianalytic.coefficients import influence
    from semianalytic.inputs import Numerics
    from semianalytic.patches import convolution, prescribed

    whole, mean, body = _under_patches(replace(problem, friction=0.0), exact)
    grid = replace(whole, quarter=True)
    K = influence.surface_coefficients(PATCHES, grid.d, body, Numerics())
    u = convolution.even_convolution(K, quarter=True)(grid.held(prescribed.deconvolve(mean)).copy())
    i, j = (np.array(QUARTER) * (len(grid.x) - 1)).astype(int)
    normal = HankelField(exact.pressure, problem.coatings, problem.substrate, 0.0)
    return float(np.abs(u[i, j] - normal.displacement(grid.x[i], grid.x[j], 0 * grid.x[i])[2]).max())


def _under_patches(problem: CoatedContact, exact: HankelField) -> tuple[Any, Any, Any]:
    """The grid over the disc, the mean pressure of each patch, and the solid, as the method takes them."""
    from semianalytic.inputs import Body
    from semianalytic.patches import prescribed
    from semianalytic.patches.grid import Grid

    a = exact.pressure.a
    grid = Grid(PATCHES, 2.04 * a / PATCHES)
    mean = prescribed.patch_mean(prescribed.Prescribed(a, exact.pressure.pressure), grid.x, grid.d)
    return grid, mean, Body(problem.coatings, problem.substrate, problem.friction, None)


def convolution_errors(problem: CoatedContact, solid: str) -> list[ExactError]:
    """Errors of DC-FFT against the sum over patches, on a grid loaded up to its rim, and on a quarter of it.

    No contact loads the patches at the rim, from which a padding that is too short wraps around.
    """
    from semianalytic.coefficients import influence
    from semianalytic.inputs import Body, Numerics
    from semianalytic.patches import convolution

    patches, body = 31, Body(problem.coatings, problem.substrate, 0.0, None)
    K = influence.surface_coefficients(patches, problem.a_h / patches, body, Numerics())
    middle = patches // 2
    x = np.arange(patches) - middle
    even = 1.0 + np.add.outer(x**2, 2 * x**2) / patches
    found = []
    for p, quarter in ((even + np.add.outer(x, -3 * x), False), (even, True)):
        exact = convolve(p, np.pad(K, ((patches - 1, 0),) * 2, "reflect"), "valid", "direct")
        held = (slice(middle * quarter, None),) * 2
        u = convolution.even_convolution(K, quarter=quarter)(p[held].copy())
        name = "convolution on a quarter" if quarter else "convolution"
        error = _largest([u - exact[held]]) / float(np.abs(exact).max())
        found.append(ExactError("pressure up to the rim", solid, name, error))
    return found


def film_errors(problem: CoatedContact) -> list[ExactError]:
    """Influence coefficients of the coated solid, and of films thinner than those of any shipped case.

    Patches near the loaded one are integrated by quadrature under such films.
    """
    (E, nu, _), *_ = problem.coatings
    side = SIDE * problem.a_h
    solids = {"coated": problem} | {
        name: replace(problem, coatings=((E, nu, patches * side),)) for name, patches in FILMS.items()
    }
    return [
        ExactError("one patch loaded", name, "influence coefficients", coefficient_error(solid, side))
        for name, solid in solids.items()
    ]


def iteration_counts(problem: CoatedContact, solid: str) -> list[ExactError]:
    """Iterations on patches alone; all that are allowed where the contact is refused."""
    import semianalytic

    numerics: dict[str, Any] = {"patches": PATCHES, "max_iterations": MOST, "edge_correction": False}
    try:
        found = semianalytic.solve(**keywords(problem), **numerics, estimate_uncertainty=False)
        count = found.diagnostics.iterations
    except semianalytic.NotConverged:
        count = MOST
    return [ExactError("patches alone", solid, "iterations", count)]


def grid_ratios(problem: CoatedContact, solid: str) -> list[ExactError]:
    """Patches of the last grid but one over those of the last, from whose change an uncertainty follows."""
    import semianalytic

    found: Any = semianalytic.solve(**keywords(problem), patches=PATCHES, accuracy=None)
    ratio = found.coarser.diagnostics.patches_per_side / PATCHES
    return [ExactError("grids of the uncertainty", solid, "ratio of patches", ratio)]


def turned_ellipse(problem: CoatedContact, given: str) -> list[ExactError]:
    """Errors of a contact of the load and modulus of ``problem``, uncoated; ``given`` is load or approach."""
    import semianalytic

    a, b = 2**0.5 * problem.a_h, problem.a_h / 2**0.5
    exact = HertzEllipse(a, b, problem.p_h, problem.E_star)
    (A, B), c, s = exact.curvatures, np.cos(ANGLES[given]), np.sin(ANGLES[given])
    aside = BESIDE * 2 * WIDE * a / PATCHES

    def height(x: Any, y: Any) -> Any:
        x, y = x - aside, y + aside
        return A * (c * x + s * y) ** 2 + B * (c * y - s * x) ** 2

    one = semianalytic.indent(
        profile=height,
        half_width=WIDE * a,
        load=exact.load if given == "load" else None,
        approach=exact.approach if given == "approach" else None,
        coatings=(),
        substrate=problem.substrate,
        patches=PATCHES,
        estimate_uncertainty=False,
    )
    errors = {
        "peak pressure": one.peak_pressure / exact.p0 - 1,
        "contact radius": one.contact_radius / problem.a_h - 1,
        "approach": one.approach / exact.approach - 1 if given == "load" else 0.0,
        "load": one.diagnostics.load / exact.load - 1,
    }
    what = "ellipse 2 : 1, turned" + ("" if given == "load" else ", given approach")
    return [ExactError(what, "uncoated", name, abs(error)) for name, error in errors.items()]


def _largest(fields: list[Array]) -> float:
    return float(np.max([np.abs(field).max() for field in fields]))
