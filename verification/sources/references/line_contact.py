"""Cylinder on layered bodies in plane strain, without friction: the limit of a long elliptical contact.

    p = sqrt(1 - s^2) sum_j d_j U_2j(s),   s = x/b,   P = int p dx = pi b d_0/2,
    phat(k) = int p cos(kx) dx = pi b sum_j (-1)^j (2j + 1) d_j J_{2j+1}(kb)/(kb).

The slope of the surface is that of the parabola, u_z' = -x/R. Projected on T_{2i+1}(s)/sqrt(1 - s^2), where
sin(kx) gives 2 (-1)^i J_{2i+1}(kb), it is, with t = kb,

    d_i + 2 (-1)^i sum_j (-1)^j (2j + 1) d_j int_0^inf [M(t/b) - 1] J_{2i+1}(t) J_{2j+1}(t) dt/t = r_i,

r_0 = E* b/2R, all others 0. Uncoated, M = 1, the pressure is that of Johnson, (4.37) to (4.45). E* and M are
those of both bodies, ``solids_in_contact``. Stresses are transforms of those of ``layered_half_space``:

    sigma_xx, sigma_zz = 1/pi int (ll, S) phat cos(kx) dk,   sigma_xz = -1/pi int T phat sin(kx) dk,
    sigma_yy = nu (sigma_xx + sigma_zz);

on the surface the part of the homogeneous solid, sigma_xx = sigma_zz = -p, is taken in closed form.
K. L. Johnson, Contact Mechanics, 1985, sections 2.5 and 4.2(c); derived here for layers.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq
from scipy.special import eval_chebyu, jv

from verification.problem.array_types import Array, Ball, Coatings
from verification.problem.evaluation_points import layer_at
from verification.problem.gauss_legendre import wavenumber_panels
from verification.sources.references.layered_half_space import Amplitudes, LayeredHalfSpace, bending_length
from verification.sources.references.solids_in_contact import (
    Solid,
    combined_modulus,
    compliance,
    outer_thickness,
    solids_of,
)

TAIL = 40.0  # exponent at which integrands that decay are cut
TERMS = 12, 4.0  # of the pressure: some, and more for each root of b over the outer thickness
NODES = 16  # a panel


@dataclass(frozen=True, eq=False)
class LineContact:
    """Contact of half width ``b`` [m], pressure by its coefficients ``d`` [Pa], on the flat of a pair.

    coatings, substrate : of the flat, as of CoatedContact.
    """

    b: float
    d: Array
    coatings: Coatings
    substrate: tuple[float, float]
    _signs: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_signs", (-1.0) ** np.arange(self.d.size))

    @property
    def load(self) -> float:
        """P [N/m]."""
        return float(np.pi * self.b * self.d[0] / 2)

    @property
    def peak_pressure(self) -> float:
        """p at the middle [Pa]."""
        return float(self._signs @ self.d)

    def pressure(self, x: ArrayLike) -> Array:
        """p [Pa], 0 outside."""
        s = np.asarray(x, dtype=float) / self.b
        inside = np.minimum(np.abs(s), 1.0)
        values = eval_chebyu(2 * np.arange(self.d.size), inside[..., None]) @ self.d
        return np.sqrt(1 - inside**2) * values

    def transform(self, k: Array) -> Array:
        """phat(k) [N/m]."""
        orders = 2 * np.arange(self.d.size) + 1
        t = k * self.b
        return np.pi * self.b / t * (jv(orders, t[:, None]) @ (self._signs * orders * self.d))

    def stress(self, x: ArrayLike, z: ArrayLike, layer: int | None = None) -> Array:
        """xx, yy, zz, xz [Pa], (4,) + points, of the flat; ``layer`` picks the side of an interface."""
        x, z = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (x, z)))
        layers = layer_at(z, self.coatings, layer)
        found = np.zeros((4, *x.shape))
        for depth, number in set(zip(z.ravel().tolist(), layers.ravel().tolist(), strict=True)):
            here = (z == depth) & (layers == number)
            found[:, here] = self._plane(x[here], depth, number)
        return found

    def _plane(self, x: Array, z: float, layer: int) -> Array:
        nu = (*self.coatings, self.substrate)[layer][1]
        found = np.zeros((4, x.size))
        if z == 0:
            found[0] = found[2] = -self.pressure(x)
        if z > 0 or self.coatings:
            reach = z or 2 * self.coatings[0][2]
            k, weight = _wavenumbers(reach, self.b + np.abs(x).max(), self.b, (self._solid,))
            A = self._amplitudes(k, z, layer)
            weighted = weight * self.transform(k) / np.pi
            cosine, sine = np.cos(np.outer(k, x)), np.sin(np.outer(k, x))
            found[0] += (weighted * A[0]) @ cosine
            found[2] += (weighted * A[1]) @ cosine
            found[3] -= (weighted * A[2]) @ sine
        found[1] = nu * (found[0] + found[2])
        return found

    @property
    def _solid(self) -> Solid:
        return self.coatings, self.substrate

    def _amplitudes(self, k: Array, z: float, layer: int) -> Array:
        """ll, S, T of a unit pressure, (3,) + k; on the surface what exceeds the homogeneous solid."""

        def of(solid: LayeredHalfSpace) -> Array:
            found: Amplitudes = solid.amplitudes(z, layer, "normal")
            return np.array([found.ll, found.S, found.T])

        layered = of(LayeredHalfSpace(self.coatings, self.substrate, k))
        if z > 0:
            return layered
        E, nu = self.coatings[0][:2]
        return np.asarray(layered - of(LayeredHalfSpace((), (E, nu), k)))


def line_contact(
    radius: float,
    load: float,
    coatings: Coatings,
    substrate: tuple[float, float],
    ball: Ball | None = None,
    terms: int | None = None,
) -> LineContact:
    """Contact of a cylinder of ``radius`` [m] under a ``load`` per length [N/m].

    ball : solid of the cylinder, None where it is rigid, as of CoatedContact.   terms : of the pressure.
    """
    solids = solids_of(coatings, substrate, ball)
    E_star = combined_modulus(solids)

    def pressed(b: float) -> Array:
        """d [Pa] of a contact of half width b."""
        coated, count = any(layers for layers, _ in solids), terms
        h = outer_thickness(solids, b)
        count = terms or (int(TERMS[0] + TERMS[1] * (b / h) ** 0.5) if coated else 1)
        right, matrix = np.zeros(count), np.eye(count)
        right[0] = E_star * b / (2 * radius)
        if coated:
            k, weight = _wavenumbers(2 * h, 2 * b, b, solids)
            orders = 2 * np.arange(count) + 1
            J = jv(orders, k[:, None] * b) * (-1.0) ** np.arange(count)
            excess = weight / k * (compliance(solids, E_star, k) - 1)
            matrix += 2 * (J.T * excess) @ J * orders
        return np.asarray(np.linalg.solve(matrix, right))

    def excess_load(log_b: float) -> float:
        b = float(np.exp(log_b))
        return float(np.log(np.pi * b * pressed(b)[0] / (2 * load)))

    bare = np.log(4 * load * radius / (np.pi * E_star)) / 2
    soft = float(compliance(solids, E_star, np.array([1e-6 / np.exp(bare)]))[0])
    ends = sorted((bare, bare + np.log(soft) / 2))
    b = float(np.exp(brentq(excess_load, ends[0] - 1.0, ends[1] + 1.0, xtol=1e-14)))
    return LineContact(b, pressed(b), coatings, substrate)


def _wavenumbers(reach: float, extent: float, b: float, solids: tuple[Solid, ...]) -> tuple[Array, Array]:
    """Gauss panels until exp(-k reach) has gone, no wider than a wave over ``extent``, finer near 0."""
    end = (TAIL + 2 * np.log(TAIL)) / reach
    bent = max(bending_length(*solid) if solid[0] else 0.0 for solid in solids)
    return wavenumber_panels(end, 1 / max(bent, reach, b), 8 / extent, NODES)
