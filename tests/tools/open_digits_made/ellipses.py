"""Ellipsoids on an uncoated solid: numbers of Hertz's contact, stresses below its centre in closed form.

With half-axes a >= b, along and across, e^2 = 1 - b^2/a^2, zeta = z/a = cot phi,
T^2 = (b^2 + z^2)/(a^2 + z^2), and F, E the incomplete elliptic integrals of phi and e,

    sigma_along  = (2 b/(e^2 a)) p0 (O_1 + nu O_1'),   O_1 = -(1 - T)/2 + zeta (F - E),
        O_1' = 1 - (a/b)^2 T + zeta ((a/b)^2 E - F),
    sigma_across = (2 b/(e^2 a)) p0 (O_2 + nu O_2'),   O_2 = 1/2 + 1/(2 T) - (a/b)^2 T
        + zeta ((a/b)^2 E - F),   O_2' = -1 + T + zeta (F - E),
    sigma_zz = -(b/(e^2 a)) p0 (1 - T^2)/T.

A. Sackfield and D. A. Hills, J. Strain Anal. 18 (1983), the note on standard formulae of Hertz's contact;
K. L. Johnson, Contact Mechanics, 1985, section 4.2. At z = 0 they are Johnson's for the surface; below,
both methods give the same (``checked``).
"""

from collections.abc import Iterator
from typing import Any

import numpy as np
from scipy.special import ellipeinc, ellipkinc

from open_digits_made.row import DEPTH, INSIDE, SCALARS, Row, places
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact
from verification.problem.point_answers import Points
from verification.sources.references.hertz_ellipse import HertzEllipse, pressed_ellipsoid

ROUNDING = 1e-12  # relative, of the closed forms
AXIS = ("sigma_xx", "sigma_yy", "sigma_zz")


def exact(problem: CoatedContact) -> HertzEllipse:
    """Hertz's contact of an ellipsoid. Raises ValueError for coatings, friction or another indenter."""
    if problem.indenter is None or problem.coatings or problem.friction:
        raise ValueError(f"{problem}: no ellipsoid at rest on an uncoated solid")
    along, across = problem.indenter[1]
    return pressed_ellipsoid(along, across, problem.load, *problem.substrate)


def axis_stresses(contact: HertzEllipse, nu: float, z: Array) -> dict[str, Array]:
    """Stresses [Pa] at depths z [m] below the centre of a contact that is no circle."""
    a, b = max(contact.axes), min(contact.axes)
    m, zeta, T = 1 - (b / a) ** 2, z / a, np.sqrt((b**2 + z**2) / (a**2 + z**2))
    phi = np.arctan2(a, z)
    F, E = ellipkinc(phi, m), ellipeinc(phi, m)
    round_, long = zeta * (F - E), 1 - (a / b) ** 2 * T + zeta * ((a / b) ** 2 * E - F)
    scale = 2 * b / (m * a) * contact.peak_pressure
    along = scale * (-(1 - T) / 2 + round_ + nu * long)
    across = scale * (long - 0.5 + 0.5 / T + nu * (T - 1 + round_))
    pair = (along, across) if contact.axes[0] >= contact.axes[1] else (across, along)
    return dict(zip(AXIS, (*pair, -scale / 2 * (1 - T**2) / T), strict=True))


def rows(problem: CoatedContact) -> Iterator[Row]:
    """Every value of an ellipsoid: numbers, p along x, stresses on the axis."""
    found, zero = exact(problem), np.zeros(1)
    numbers = {name: getattr(found, name) for name in SCALARS}
    numbers |= dict(zip(("half_axis_x", "half_axis_y"), found.axes, strict=True))
    for name, number in numbers.items():
        yield _row(name, zero, zero, np.array([number]))
    x = places(INSIDE, found.axes[0])
    yield _row("pressure", x, 0 * x, found.pressure(x))
    z = places((0.0, *DEPTH), found.contact_radius)
    for name, value in axis_stresses(found, problem.substrate[1], z).items():
        yield _row(name, 0 * z, z, value)


def _row(quantity: str, x: Array, z: Array, value: Array) -> Row:
    return Row(quantity, x, z, 0, value, ROUNDING * np.abs(value).max() * np.ones(value.size))


def by_method(solution: Any, row: Row) -> tuple[Array, Array] | None:
    """The value of a method with its uncertainty at the points of a row; None of the half-axes."""
    if row.quantity in SCALARS:
        value, U = solution.sample(None, row.quantity)
        return np.array([value]), np.array([U])
    if row.quantity == "pressure":
        value, U = solution.sample(Points(row.x), "pressure")
        return value, U
    if row.quantity not in AXIS:
        return None
    k = AXIS.index(row.quantity)
    sigma, U = solution.sample(Points(row.x, 0.0, row.z), "stress")
    return sigma[k, k], U[k, k]
