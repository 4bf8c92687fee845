"""Lower bounds: stresses in equilibrium everywhere in the infinite half-space.

For the true p under the displacement w of the contact and any admissible stress with pressure q

    <p, w> >= 2 <q, w> - B*(sigma, sigma),   B*(sigma, tau) = int sigma : S tau dV

Equilibrium holds identically with a stress function phi and s = r sigma_rr:

    sigma_zz = phi_r/r,   sigma_rz = -phi_z/r,   sigma_rr = s/r,   sigma_tt = s_r - phi_zz

phi is continuous with its derivatives, s is continuous along r: all tractions are continuous. On the surface
phi_z = 0, and phi is constant outside the contact. Beyond z = L the load -2 pi c of phi = c G(r/rho), with
rho = (1 + z^2)^(1/2) and its tangent at L continued, runs down a cone of radial stress. Nothing is stressed
beside the cone, nor beyond r = rho(L) above it:

    G = 6 x^2 - 8 x^3 + 3 x^4,  m = rho'(L),  B*_far = 2 pi c^2/(E m rho(L)) int_0^1 (1 + m^2 x^2)^2 G'^2/x dx
"""

import numpy as np
from numpy.polynomial import Polynomial
from scipy import sparse

from energy_bounds.half_space_mesh import HalfSpace, compliance
from energy_bounds.spline_elements import Numbers, Pieces, Points
from energy_bounds.tensor_energy import Bound, Energy, Term, solver
from verification.problem.array_types import Array

X = Polynomial([0, 1])
CONE = 6 * X**2 - 8 * X**3 + 3 * X**4
FADE = (1 - X) ** 2 * (1 + 2 * X)  # from 1 to 0 on [0, 1], without slope at either end
DEPTH = 0.7  # to which the pressure's part of phi reaches at least
CORRECTIONS = 2  # of the solution, which loses digits to the fourth derivative of phi in thin pieces


def stress_energy(solid: HalfSpace, r: Points, z: Points) -> Energy:
    """Stresses of the unknowns phi, s at the points ``r`` and ``z``."""
    phi = Pieces(solid.r, solid.degree, 1), Pieces(solid.z, solid.degree, 1)
    s = Pieces(solid.r, solid.degree - 1, 0), Pieces(solid.z, solid.degree - 2, -1)
    R0, R1 = (phi[0].table(r, k) for k in (0, 1))
    Z0, Z1, Z2 = (_depth_table(phi[1], z, k) for k in (0, 1, 2))
    S0, S1, D = s[0].table(r), s[0].table(r, 1), s[1].table(z)
    terms = [
        Term(1, 0, S0 / r.place, D),
        Term(1, 1, S1, D),
        Term(0, 1, -R0, Z2),
        Term(0, 2, R1 / r.place, Z0),
        Term(0, 3, -R0 / r.place, Z1),
    ]
    return Energy([phi, s], terms, (r, z), solid.moduli(compliance, z.place))


def _fade_end(knots: Array) -> float:
    return float(knots[np.searchsorted(knots, DEPTH)])


def _depth_table(Z: Pieces, z: Points, derivative: int) -> Array:
    """As of ``Z``, the value at the surface carried by one function through all thin pieces below it.

    Otherwise phi_zz would be the difference of numbers that are larger by 1/thickness^2.
    """
    found, end = Z.table(z, derivative), _fade_end(Z.knots)
    found[0] = np.where(z.place < end, FADE.deriv(derivative)(z.place / end) / end**derivative, 0)
    return found


def lower_bound(solid: HalfSpace) -> tuple[Bound, Array]:
    """Of <p, w> for w = 1 and r^2/2; then the work <q, w> of the pressure of each stress in each w."""
    energy = stress_energy(solid, *solid.points())
    column, free = admissible(energy)
    far = far_energy(solid)
    unit = sparse.eye_array(column.size, format="csc")
    basis = sparse.hstack([column[:, None], unit[:, free]], format="csc")
    A = sparse.csc_array(basis.T @ energy.matrix() @ basis)
    A[0, 0] += far
    load = pressure_work(energy)
    solve = solver(A)
    y = solve(basis.T @ load)
    for _ in range(CORRECTIONS):
        rest = load - np.stack([energy.derivative(x) for x in (basis @ y).T], axis=1)
        y = y + solve(basis.T @ rest - far * np.eye(y.shape[0], 1) * y[0])
    x = basis @ y
    inside, work = energy.bound(x, free.size + 1), x.T @ load
    rounded = np.finfo(float).eps * energy.points[0].place.size * (np.abs(x).T @ np.abs(load))
    matrix = work + work.T - inside.matrix - far * np.outer(y[0], y[0])
    return Bound(matrix, inside.rounding + rounded + rounded.T, inside.components, inside.unknowns), work


def pressure_work(energy: Energy) -> Array:
    """<q, w> = -2 pi int_0^1 phi_r w dr of each unknown in w = 1 and r^2/2."""
    (R, Z), r = energy.fields[0], energy.points[0]
    weight = np.where(r.place < 1, r.weight, 0)
    found = np.zeros((R.size, Z.size, 2))
    w = np.stack([np.ones_like(weight), r.place**2 / 2], axis=1)
    found[:, 0] = -2 * np.pi * (R.table(r, 1) * weight) @ w
    rest = sum(r.size * z.size for r, z in energy.fields[1:])
    return np.concatenate([found.reshape(-1, 2), np.zeros((rest, 2))])


def far_energy(solid: HalfSpace) -> float:
    """B*_far of c = 1, E = 1."""
    rho, L = float(solid.r[-1]), float(solid.z[-1])
    m = L / rho
    density = (1 + (m * X) ** 2) ** 2 * (144 * X * (1 - X) ** 4)
    return float(2 * np.pi / (m * rho) * density.integ()(1))


def admissible(energy: Energy) -> tuple[Array, Numbers]:
    """Unknowns of phi = G(r/rho(z)) - 1, which joins the cone, then the numbers of the free unknowns."""
    (R, Z), s = energy.fields
    rho = np.hypot(1, Z.knots)
    slope, x = Z.knots / rho, np.minimum(R.knots[:, None] / rho, 1)
    G, G1, G2 = CONE(x), CONE.deriv()(x), CONE.deriv(2)(x)
    end = _fade_end(Z.knots)
    part = np.minimum(Z.knots / end, 1)
    fade, fade1 = FADE(part), FADE.deriv()(part) / end
    fade[0] = 0  # the value at the surface itself
    phi, free = np.zeros((R.size, Z.size)), np.ones((R.size, Z.size), dtype=bool)
    phi[np.ix_(R.values, Z.values)] = G - 1 - (G[:, :1] - 1) * fade
    phi[np.ix_(R.slopes, Z.values)] = G1 / rho - G1[:, :1] * fade
    phi[np.ix_(R.values, Z.slopes)] = -x * G1 * slope / rho - (G[:, :1] - 1) * fade1
    phi[np.ix_(R.slopes, Z.slopes)] = -(x * G2 + G1) * slope / rho**2 - G1[:, :1] * fade1
    # at z = L exact: G'''' = 72, that of the first function of a piece is 3
    fourth = 24 * (np.diff(R.knots) / 2 / rho[-1]) ** 4
    phi[R.inner[:, 0], Z.values[-1]] = fourth
    phi[R.inner[:, 0], Z.slopes[-1]] = -4 * slope[-1] / rho[-1] * fourth
    outside = int(np.searchsorted(R.knots, 1.0))
    free[[0, R.slopes[0], R.values[-1], R.slopes[-1]]] = False
    free[:, [Z.slopes[0], Z.values[-1], Z.slopes[-1]]] = False
    free[[*R.values[outside:], *R.slopes[outside:], *R.inner[outside:].ravel()], 0] = False
    free_s = np.ones((s[0].size, s[1].size), dtype=bool)
    free_s[[0, s[0].values[-1]]] = False
    return np.append(phi.ravel(), np.zeros(free_s.size)), np.flatnonzero([*free.ravel(), *free_s.ravel()])
