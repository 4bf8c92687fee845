"""Energy of axisymmetric fields whose unknowns are tensor products of functions of r with functions of z."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from energy_bounds.spline_elements import Pieces, Points
from verification.problem.array_types import Array


@dataclass(frozen=True, eq=False)
class Term:
    """What unknown ``field`` adds to ``component`` (rr, tt, zz, rz): functions of r, of z at the points."""

    field: int
    component: int
    r: Array
    z: Array


@dataclass(frozen=True, eq=False)
class Bound:
    """Bilinear form of a solution for each of the two displacements 1 and r^2/2 of the contact.

    matrix : (2, 2), above or below the exact one.   rounding : of its evaluation, to first order.
    components : of both solutions at the Gauss points, (2, 4, r, z).
    """

    matrix: Array
    rounding: Array
    components: Array
    unknowns: int


@dataclass(frozen=True, eq=False)
class Energy:
    """B(e, f) = int e : C f dV of the components that ``terms`` add up to; ``moduli`` C at each depth."""

    fields: Sequence[tuple[Pieces, Pieces]]
    terms: Sequence[Term]
    points: tuple[Points, Points]
    moduli: Array

    @property
    def weights(self) -> tuple[Array, Array]:
        """Of the points; dV = 2 pi r dr dz."""
        r, z = self.points
        return 2 * np.pi * r.place * r.weight, z.weight

    def matrix(self) -> sparse.csc_array:
        """Of B among all unknowns."""
        sizes = [r.size * z.size for r, z in self.fields]
        blocks = [[sparse.csr_array((n, m)) for m in sizes] for n in sizes]
        r_weight, z_weight = self.weights
        for one in self.terms:
            for two in self.terms:
                modulus = self.moduli[one.component, two.component]
                if modulus.any():
                    r, z = (one.r * r_weight) @ two.r.T, (one.z * z_weight * modulus) @ two.z.T
                    blocks[one.field][two.field] += sparse.kron(
                        sparse.csr_array(r), sparse.csr_array(z), "csr"
                    )
        return sparse.block_array(blocks, format="csc")

    def components(self, x: Array) -> tuple[Array, Array]:
        """Of the unknowns ``x``, (4, r, z); then the sum of the magnitudes of what each is added up from."""
        found = np.zeros((2, 4, *(points.place.size for points in self.points)))
        start = np.cumsum([0, *(r.size * z.size for r, z in self.fields)])
        for term in self.terms:
            r, z = self.fields[term.field]
            X = x[start[term.field] : start[term.field + 1]].reshape(r.size, z.size)
            found[0, term.component] += term.r.T @ X @ term.z
            found[1, term.component] += np.abs(term.r).T @ np.abs(X) @ np.abs(term.z)
        return found[0], found[1]

    def derivative(self, x: Array) -> Array:
        """B(x, .) of every unknown, from the components at the points; loses less than ``matrix() @ x``."""
        r_weight, z_weight = self.weights
        found = [np.zeros((r.size, z.size)) for r, z in self.fields]
        stress = np.einsum("ijk,jrk->irk", self.moduli, self.components(x)[0]) * r_weight[:, None] * z_weight
        for term in self.terms:
            found[term.field] += term.r @ stress[term.component] @ term.z.T
        return np.concatenate([part.ravel() for part in found])

    def bound(self, solutions: Array, unknowns: int) -> Bound:
        """B of the columns of ``solutions``, evaluated from the components at the points."""
        found = [self.components(x) for x in solutions.T]
        e, size = (np.stack(part) for part in zip(*found, strict=True))
        r, z = self.weights
        matrix = _form(e, self.moduli, e, r, z)
        # each sum over points of one coordinate rounds at most once a point
        one_sided = (
            (r.size + z.size) * np.finfo(float).eps * _form(np.abs(e), np.abs(self.moduli), size, r, z)
        )
        return Bound(matrix, one_sided + one_sided.T, e, unknowns)


def _form(e: Array, moduli: Array, f: Array, r: Array, z: Array) -> Array:
    return np.einsum("aijk,bijk->ab", e * r[:, None] * z, np.einsum("ijk,bjrk->birk", moduli, f))


def virtual_work(stress: Array, strain: Array, weights: tuple[Array, Array]) -> Array:
    """int sigma : e dV of all pairs."""
    return np.einsum("aijk,bijk->ab", stress * weights[0][:, None] * weights[1], strain)


def solver(matrix: sparse.csc_array) -> Callable[[Array], Array]:
    """Solves a positive definite system, scaled to a unit diagonal; no bound relies on its accuracy."""
    scale = 1 / np.sqrt(matrix.diagonal())[:, None]
    scaled = sparse.csc_array(sparse.diags_array(scale[:, 0]) @ matrix @ sparse.diags_array(scale[:, 0]))
    factors = splu(scaled, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return lambda right: scale * factors.solve(scale * right)
