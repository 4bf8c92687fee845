"""Middle sections of long ellipses beside the contact along a line."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from verification.manual.markdown_text import table
from verification.manual.tour_output import STORED
from verification.page.number_text import scientific
from verification.problem.array_types import Array, Coatings
from verification.problem.coated_contact import CoatedContact
from verification.problem.quantity import IN_PLANE
from verification.sampling.along_axis import half_axis
from verification.sources.references.hertz_ellipse import HertzEllipse
from verification.sources.references.line_contact import line_contact
from verification.sources.source_registry import METHODS, solvers

RATIOS = 20, 50, 100
SOLID, HALF_WIDTH, PEAK = (210e9, 0.3), 100e-6, 1e9  # of the uncoated ellipse [m, Pa]
BODIES: dict[str, Coatings] = {"uncoated": (), "coated": ((420e9, 0.25, HALF_WIDTH / 2),)}
# Places over the half width: x and z, on the axis, across it in the coating, on the surface
PLACES = np.array(
    [
        *((0.0, z) for z in (0.2, 0.4, 0.8, 1.2, 2.0, 3.0)),
        *((x, 0.4) for x in (0.3, 0.7, 1.2, 2.0)),
        *((x, 0.0) for x in (0.0, 0.3, 0.6)),
    ]
).T


@dataclass(frozen=True, eq=False)
class MiddleSection:
    """Relative differences of the section of a long ellipse from the contact along a line of its own load.

    stress : |difference| over p0 of xx, yy, zz, xz, (4, places).
    """

    peak: float
    half_width: float
    stress: Array


@cache
def middle_section(ratio: float, coatings: Coatings) -> MiddleSection:
    """An ellipse ``ratio`` times as long as wide where it is uncoated, on ``coatings``, long along y."""
    E, nu = SOLID
    bare = HertzEllipse(ratio * HALF_WIDTH, HALF_WIDTH, PEAK, E / (1 - nu**2), along_y=True)
    along, across = (1 / (2 * c) for c in bare.curvatures)
    problem = CoatedContact(
        (along * across) ** 0.5, bare.load, coatings, SOLID, indenter=("ellipsoid", (across, along))
    )
    found = solvers()[METHODS[0]](problem, {"estimate_uncertainty": False})
    b = half_axis(found, across=False)
    x = np.linspace(-1.1 * b, 1.1 * b, 8001)
    limit = line_contact(across, float(np.trapezoid(found.pressure(x), x)), coatings, SOLID)
    x, z = HALF_WIDTH * PLACES
    stress = np.array([found.stress(x, 0.0, z)[i, j] for i, j in IN_PLANE.values()])
    apart = np.abs(stress / found.peak_pressure - limit.stress(x, z) / limit.peak_pressure)
    return MiddleSection(found.peak_pressure / limit.peak_pressure - 1, b / limit.b - 1, apart)


def line_limit() -> str:
    """Differences of long ellipses from the contact along a line, as stored."""
    return (STORED / "line_limit.txt").read_text(encoding="utf-8")


def solved_limit() -> str:
    """Differences of long ellipses from the contact along a line, solved now."""
    rows = []
    for name, coatings in BODIES.items():
        for ratio in RATIOS:
            one = middle_section(ratio, coatings)
            xx, yy, zz, xz = one.stress.max(axis=1)
            values = (abs(one.peak), abs(one.half_width), xx, yy, max(zz, xz))
            rows.append([f"{ratio} : 1", name, *(scientific(value, 1) for value in values)])
    heads = [
        "$a : b$",
        "",
        "$p_0$",
        "$b$",
        r"$\sigma_{xx}$",
        r"$\sigma_{yy}$",
        r"$\sigma_{zz}$, $\sigma_{xz}$",
    ]
    return table(heads, rows, 2)
