"""Ellipsoids on an uncoated solid, at rest or sliding: Hertz's contact, stresses and displacements below it.

With half-axes a >= b, along and across, e^2 = 1 - b^2/a^2, zeta = z/a = cot phi,
T^2 = (b^2 + z^2)/(a^2 + z^2), and F, E the incomplete elliptic integrals of phi and e,

    sigma_along  = (2 b/(e^2 a)) p0 (O_1 + nu O_1'),   O_1 = -(1 - T)/2 + zeta (F - E),
        O_1' = 1 - (a/b)^2 T + zeta ((a/b)^2 E - F),
    sigma_across = (2 b/(e^2 a)) p0 (O_2 + nu O_2'),   O_2 = 1/2 + 1/(2 T) - (a/b)^2 T
        + zeta ((a/b)^2 E - F),   O_2' = -1 + T + zeta (F - E),
    sigma_zz = -(b/(e^2 a)) p0 (1 - T^2)/T.

A. Sackfield and D. A. Hills, J. Strain Anal. 18 (1983), the note on standard formulae of Hertz's contact;
K. L. Johnson, Contact Mechanics, 1985, section 4.2. At z = 0 they are Johnson's for the surface; below,
both methods give the same (``checked``). Off the axis, and under friction q = f p, displacements are those of
point forces, Johnson (3.18) and (3.75), integrated over the ellipse by Gauss points and angles; the strains
are derivatives by a complex step, exact to rounding.
"""

from collections.abc import Iterator

import numpy as np
from scipy.special import ellipeinc, ellipkinc

from open_digits_made.row import DEPTH, INSIDE, SCALARS, Row, off_plane, places, rows_at
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact
from verification.problem.gauss_legendre import gauss_legendre
from verification.problem.point_answers import Answer, Points
from verification.problem.quantity import DISPLACEMENTS, STRESSES
from verification.sources.references.hertz_ellipse import HertzEllipse, pressed_ellipsoid

ROUNDING = 1e-12  # relative, of the closed forms
NODES = 220  # along the radii of a circle, twice as many angles; more of an ellipse by the root of a/b
AXIS = ("sigma_xx", "sigma_yy", "sigma_zz")


def exact(problem: CoatedContact) -> HertzEllipse:
    """Hertz's contact of an ellipsoid. Raises ValueError for coatings or another indenter."""
    if problem.indenter is None or problem.coatings:
        raise ValueError(f"{problem}: no ellipsoid on an uncoated solid")
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
    """Every value of an ellipsoid: numbers, p along x, stresses on the axis, all fields off y = 0."""
    found = exact(problem)
    numbers = {name: getattr(found, name) for name in SCALARS}
    numbers |= dict(zip(("half_axis_x", "half_axis_y"), found.axes, strict=True))
    for name, number in numbers.items():
        yield _row(name, None, np.array([number]))
    x = places(INSIDE, found.axes[0])
    yield _row("pressure", Points(x, 0 * x, 0 * x, 0), found.pressure(x))
    z = places((0.0, *DEPTH), found.contact_radius)
    axis = Points(0 * z, 0 * z, z, 0)
    for name, value in axis_stresses(found, problem.substrate[1], z).items():
        yield _row(name, axis, value)

    nodes = int(NODES * (found.a / found.b) ** 0.5)

    def sample(points: Points, kind: str) -> Answer:
        fine, coarse = (below(found, problem, points, kind, n) for n in (nodes, 3 * nodes // 4))
        return Answer(fine, 2 * np.abs(fine - coarse) + 10 * ROUNDING * np.abs(fine).max())

    if problem.friction:
        z = places(DEPTH[1:], found.contact_radius)
        yield from rows_at(Points(0 * z, 0 * z, z, 0), ("sigma_xz",), sample)
    for points in off_plane(found.contact_radius, ()):
        yield from rows_at(points, (*STRESSES, *DISPLACEMENTS), sample)


def below(contact: HertzEllipse, problem: CoatedContact, points: Points, kind: str, nodes: int) -> Array:
    """Stress [Pa] or displacement [m] at depth: point forces over the ellipse, ``nodes`` along its radii."""
    (E, nu), step = problem.substrate, 1e-30 * contact.contact_radius
    at = np.stack([np.ravel(v) for v in (points.x, points.y, points.z)]).astype(complex)
    if kind == "displacement":
        return _displaced(contact, at, E, nu, problem.friction, nodes).real
    moved = [at + 1j * step * np.eye(3)[:, [j]] for j in range(3)]
    gradient = np.stack(
        [_displaced(contact, m, E, nu, problem.friction, nodes).imag / step for m in moved], 1
    )
    strain = (gradient + gradient.swapaxes(0, 1)) / 2
    dilatation = nu / (1 - 2 * nu) * np.einsum("kkn->n", strain)
    return E / (1 + nu) * (strain + dilatation * np.eye(3)[:, :, None])


def _displaced(contact: HertzEllipse, at: Array, E: float, nu: float, friction: float, nodes: int) -> Array:
    """Displacement [m] at complex places, (3, points). Johnson (3.18) and (3.75)."""
    t, weight = gauss_legendre(nodes)
    t, weight = np.pi / 4 * (1 + t), np.pi / 4 * weight  # p = p0 cos t at sin t of the way to the rim
    theta = np.arange(2 * nodes) * np.pi / nodes
    (a, b), s = contact.axes, np.sin(t)[:, None]
    load = contact.peak_pressure * a * b * np.pi / nodes * (np.cos(t) ** 2 * np.sin(t) * weight)[:, None]
    found = []
    for x, y, z in at.T:
        X, Y = x - a * s * np.cos(theta), y - b * s * np.sin(theta)
        rho = np.sqrt(X**2 + Y**2 + z**2)
        c, near, forces = 1 - 2 * nu, rho + z, load * (1 + nu) / (2 * np.pi * E)
        sink = z / rho**3 - c / (rho * near)
        pressed = X * sink, Y * sink, z**2 / rho**3 + 2 * (1 - nu) / rho
        along = 1 / rho**3 - c / (rho * near**2)
        slid = 1 / rho + c / near + X**2 * along, X * Y * along, X * (z / rho**3 + c / (rho * near))
        found.append([(forces * (p + friction * q)).sum() for p, q in zip(pressed, slid, strict=True)])
    return np.array(found).T


def _row(quantity: str, points: Points | None, value: Array) -> Row:
    return Row(quantity, points, value, ROUNDING * np.abs(value).max() * np.ones(value.size))
