"""Fields of the semi-analytical method under a given pressure on a disc, beside the exact ones.

A uniform pressure and Hertz's, which slides, on the surface, inside, on both sides of each interface. Nothing
is iterated, so the error is that of the stress coefficients, of the influence coefficients and of the
convolution, each apart.
"""

from dataclasses import dataclass, replace

import numpy as np

from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact
from verification.problem.line_profile import lines_of
from verification.sources.references.axisymmetric_pressure import AbelPressure
from verification.sources.references.hankel_field import HankelField
from verification.sources.references.uniform_disc import UniformDisc

UNIFORM, HERTZ = "uniform pressure", "Hertz's pressure"
# Of the radius: beside the rim, where the stress under a uniform pressure is infinite, not on it.
SURFACE = np.array([-1.7, -1.15, -0.97, -0.8, -0.5, -0.2, 0.0, 0.3, 0.6, 0.9, 1.02, 1.3])
DEPTHS = (0.02, 0.15, 0.48, 1.2, 2.5)
PLANE = 0.6  # depth of the plane by FFT, over ten patches, where patches of a pressure without steps suffice


@dataclass(frozen=True)
class DiscError:
    """Largest ``error`` of ``quantity`` under ``pressure`` on ``solid``: stress and plane over the largest
    pressure, displacements over the exact one at the centre."""

    pressure: str
    solid: str
    quantity: str
    error: float


def disc_errors(problem: CoatedContact, solid: str, friction: float, patches: int = 257) -> list[DiscError]:
    """Errors under both pressures on a disc as wide as the contact of Hertz, Hertz's with ``friction``."""
    a, p_h = problem.a_h, problem.p_h
    hertz = AbelPressure(a, p_h * a / 3 * np.array([1.0, -1.0]))
    found = []
    for name, disc, f in ((UNIFORM, UniformDisc(a, p_h), 0.0), (HERTZ, hertz, friction)):
        exact = HankelField(disc, problem.coatings, problem.substrate, f)
        found += [
            DiscError(name, solid, quantity, error)
            for quantity, error in _errors(replace(problem, friction=f), exact, p_h, patches).items()
        ]
    return found


def _errors(problem: CoatedContact, exact: HankelField, p_h: float, patches: int) -> dict[str, float]:
    import semianalytic

    a = exact.pressure.a
    given = exact.pressure.pressure
    solution = semianalytic.solve_prescribed(
        pressure=p_h if isinstance(exact.pressure, UniformDisc) else given,
        load_radius=a,
        coatings=problem.coatings,
        substrate=problem.substrate,
        friction=problem.friction,
        patches=patches,
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
            np.array([[0.1, 0.3, 0.5, 0.62, 0.87], [0.5, 0.15, 0.62, 0.25, 0.94]]) * (patches - 1)
        ).astype(int)
        z = PLANE * a
        at = solution.nodes[i], solution.nodes[j], np.full(i.shape, z)
        errors["stress on a plane"] = (
            _largest([solution.stress_plane(z)[:, :, i, j] - exact.stress(*at)]) / p_h
        )
        plane = solution.displacement_plane(z)[:, i, j]
        errors["displacement on a plane"] = _largest([plane - exact.displacement(*at)]) / sink
    return errors


def _largest(fields: list[Array]) -> float:
    return float(np.max([np.abs(field).max() for field in fields]))
