"""Integrals of products of shape functions, exact on the reference triangle.

On a triangle with straight sides the derivatives of the reference coordinates X_A by r and z are constant and
r = sum_k r_k L_k of the corners, so that with area the doubled one

    int d_a phi_i d_b phi_j r dr dz = sum_kAB  area r_k X_A,a X_B,b  int L_k phi_i,A phi_j,B dX,
    int d_a phi_i phi_j dr dz       = sum_A    area X_A,a            int phi_i,A phi_j dX,
    int phi_i phi_j / r dr dz       = sum_q    area w_q / r_q        phi_i(X_q) phi_j(X_q),

the last one by quadrature. The stiffness of all triangles is one product of their factors on the left with
the integrals on the right. R. C. Kirby and A. Logg, ACM Trans. Math. Softw. 32 (2006) 417-444.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from skfem import ElementTriP2, ElementTriP3, ElementTriP4
from skfem.quadrature import get_quadrature

__all__ = ["ELEMENTS", "ReferenceIntegrals", "reference_integrals", "shape_functions"]

ELEMENTS = {2: ElementTriP2, 3: ElementTriP3, 4: ElementTriP4}


@dataclass(frozen=True, eq=False)
class ReferenceIntegrals:
    """Integrals over the reference triangle of ``n`` shape functions.

    slopes : (3, 2, 2, n, n), int L_k phi_i,A phi_j,B.   mixed : (2, n, n), int phi_i,A phi_j
    products : (q, n, n), phi_i phi_j at the points of quadrature
    corners : (q, 3), L_k at these.   weights : (q,)
    """

    slopes: np.ndarray
    mixed: np.ndarray
    products: np.ndarray
    corners: np.ndarray
    weights: np.ndarray

    def factors(self, points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
        """Factors of the rows of ``coupled``, (m, rows), for ``triangles`` (3, m) of vertices ``points``."""
        (r0, r1, r2), (z0, z1, z2) = points[:, triangles]
        r = np.stack([r0, r1, r2])
        det = (r1 - r0) * (z2 - z0) - (r2 - r0) * (z1 - z0)
        area = np.abs(det)
        by_r, by_z = np.stack([z2 - z0, z0 - z1]) / det, np.stack([r0 - r2, r1 - r0]) / det
        weight = area * r
        pairs = (by_r, by_r), (by_z, by_z), (by_r, by_z)
        rows = [np.einsum("km,am,bm->mkab", weight, *pair).reshape(r0.size, -1) for pair in pairs]
        rows += [(area * by_r).T, (area * by_z).T, (self.weights[:, None] * area / (self.corners @ r)).T]
        return np.concatenate(rows, axis=1)

    def coupled(self, coupling: np.ndarray) -> np.ndarray:
        """Integrals for fields coupled by ``coupling``, (rows, size * size), unknowns by node, then field.

        coupling : (3, 3, fields, fields), kinds a and b = d/dr, d/dz, 1/r of two shape functions
        """
        (rr, rz, r0), (zr, zz, z0), (_0r, _0z, _00) = coupling
        swapped = self.slopes.transpose(0, 1, 2, 4, 3)
        other = self.mixed.transpose(0, 2, 1)
        fields, n = len(rr), self.mixed.shape[-1]

        def rows(*terms: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
            total = sum(np.einsum("...ij,fg->...ifjg", integral, C) for integral, C in terms)
            return np.reshape(total, (-1, (n * fields) ** 2))

        return np.concatenate(
            [
                rows((self.slopes, rr)),
                rows((self.slopes, zz)),
                rows((self.slopes, rz), (swapped, zr)),
                rows((self.mixed, r0), (other, _0r)),
                rows((self.mixed, z0), (other, _0z)),
                rows((self.products, _00)),
            ]
        )


@lru_cache
def reference_integrals(order: int) -> ReferenceIntegrals:
    """Those of the shape functions of polynomial ``order``."""
    shape = ELEMENTS[order]()
    X, weights = get_quadrature(shape.refdom, 2 * order)
    found = [shape.lbasis(X, i) for i in range(len(shape.doflocs))]
    phi, slope = np.stack([value for value, _ in found]), np.stack([gradient for _, gradient in found])
    corners = np.stack([1 - X[0] - X[1], *X])
    slopes = np.einsum("q,kq,iaq,jbq->kabij", weights, corners, slope, slope, optimize=True)
    mixed = np.einsum("q,iaq,jq->aij", weights, slope, phi)
    # The shape functions add up to one: rounding of that would resist a translation of the whole solid.
    for axis in (3, 4):
        slopes -= slopes.mean(axis=axis, keepdims=True)
    mixed -= mixed.mean(axis=1, keepdims=True)
    return ReferenceIntegrals(slopes, mixed, np.einsum("iq,jq->qij", phi, phi), corners.T, weights)


def shape_functions(order: int, X: np.ndarray) -> tuple[np.ndarray, ...]:
    """Values of the shape functions at X (2, n), derivatives by both reference coordinates; (i, n) each."""
    powers, coefficients = _monomials(order)
    x = np.cumprod([np.ones(X.shape), *[X] * order], axis=0)
    lower = np.maximum(powers - 1, 0)
    (k, m), (k_1, m_1) = powers, lower
    terms = x[k, 0] * x[m, 1], k[:, None] * x[k_1, 0] * x[m, 1], m[:, None] * x[k, 0] * x[m_1, 1]
    return tuple(coefficients @ term for term in terms)


@lru_cache
def _monomials(order: int) -> tuple[np.ndarray, np.ndarray]:
    """Powers (2, terms) of the monomials up to ``order``, coefficients (i, terms) of each shape function."""
    powers = np.array([(k, m) for k in range(order + 1) for m in range(order + 1 - k)]).T
    shape = ELEMENTS[order]()
    X = np.array(shape.doflocs).T
    values = np.stack([shape.lbasis(X, i)[0] for i in range(X.shape[1])])
    return powers, np.linalg.solve((X[0] ** powers[0][:, None] * X[1] ** powers[1][:, None]).T, values.T).T
