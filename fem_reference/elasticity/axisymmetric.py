"""Linear elasticity of a body of revolution under loads of one angular harmonic m.

On a body of revolution a load of harmonic m gives displacements of that harmonic,

    u_r = U cos(m theta),   u_theta = V sin(m theta),   u_z = Z cos(m theta),

so a field is a few scalar fields on the meridian plane: U, Z for m = 0 (V is torsion, which no load here
excites), and S = U + V, V, Z for m >= 1. Regularity on the axis reads S = Z = 0 for m = 1, S = V = Z = 0 for
m >= 2, and only fields that vanish there are divided by r. Each strain is linear in the fields,

    eps = A_r du/dr + A_z du/dz + A_0 u / r,

with engineering shear. Components in the order rr, theta theta, zz, rz, then for m >= 1 r theta, theta z
(these two times sin(m theta), the others times cos(m theta)).
O. C. Zienkiewicz and R. L. Taylor, The Finite Element Method for Solid and Structural Mechanics, ch. 9.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp
from skfem import (
    Basis,
    BilinearForm,
    ElementTriP2,
    ElementTriP3,
    ElementTriP4,
    FacetBasis,
    LinearForm,
    MeshTri,
    asm,
)

from fem_reference import element_numbers as chosen
from fem_reference.elasticity.linear_system import minimum_degree
from fem_reference.meshing.location import Locator, Uncached
from fem_reference.meshing.mesh import MeridianMesh

ELEMENTS = {2: ElementTriP2, 3: ElementTriP3, 4: ElementTriP4}


def strain_operator(harmonic: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The matrices (A_r, A_z, A_0), each of shape (strains, fields).

        rr = U,r            tt = (U + m V)/r            zz = Z,z
        rz = U,z + Z,r      rt = V,r - (V + m U)/r      tz = V,z - m Z/r

    with U = S - V in the fields (S, V, Z). For harmonic m = 0 the first four strains of the fields (U, Z).
    """
    m = harmonic
    A_r, A_z, A_0 = A = np.zeros((3, 6, 3))
    A_r[0], A_r[3], A_r[4] = (1, -1, 0), (0, 0, 1), (0, 1, 0)
    A_z[2], A_z[3], A_z[5] = (0, 0, 1), (1, -1, 0), (0, 1, 0)
    A_0[1], A_0[4], A_0[5] = (1, m - 1, 0), (-m, m - 1, 0), (0, 0, -m)
    A_r, A_z, A_0 = A if m else A[:, :4, [0, 2]]
    return A_r, A_z, A_0


def elasticity(E: float, nu: float, harmonic: float) -> np.ndarray:
    """Hooke's law as a matrix from strain to stress, in the component order of the module.

    sigma = lambda tr(eps) I + 2 G eps;  engineering shears carry G alone. Units of ``E``.
    """
    G = E / (2 * (1 + nu))
    lame = 2 * G * nu / (1 - 2 * nu)
    D = np.diag([2 * G] * 3 + [G] * (3 if harmonic else 1))
    D[:3, :3] += lame
    return D


@dataclass(frozen=True, eq=False)
class Discretisation(Uncached):
    """Lagrange elements of one ``order`` on a meridian mesh, and everything assembled from them.

    A field vector stacks the fields one after the other: entry ``field * N + i`` is the value of that field
    at ``locations[:, i]``.
    """

    mesh: MeridianMesh
    order: int

    @cached_property
    def triangulation(self) -> MeshTri:
        # sort_t: scikit-fem needs ascending vertex numbers to match edge unknowns of order 3 and above
        return MeshTri(self.mesh.points, self.mesh.triangles, sort_t=True)

    @cached_property
    def basis(self) -> Basis:
        """Numbers and places of the unknowns; its quadrature of one point, in the middle, is not used."""
        middle = np.full((2, 1), 1 / 3), np.array([0.5])
        return Basis(self.triangulation, ELEMENTS[self.order](), quadrature=middle)

    @cached_property
    def locator(self) -> Locator:
        return Locator(self.mesh, self.basis)

    @property
    def N(self) -> int:
        """Unknowns per field."""
        return int(self.basis.N)

    @property
    def locations(self) -> np.ndarray:
        """Positions (r, z) of the unknowns, shape (2, N)."""
        return np.asarray(self.basis.doflocs)

    @cached_property
    def contact_vertices(self) -> np.ndarray:
        """Increasing radii of the surface vertices from the axis to the contact edge."""
        return self.locations[0, self.contact][:: self.order]

    @cached_property
    def surface(self) -> np.ndarray:
        """Unknowns of one field on z = 0, by increasing radius."""
        numbers = self.basis.get_dofs(lambda x: x[1] == 0).all()
        return numbers[np.argsort(self.locations[0, numbers])]

    @cached_property
    def contact(self) -> np.ndarray:
        """Unknowns of one field on the contact, by increasing radius."""
        return self.surface[self.locations[0, self.surface] <= self.mesh.contact_radius]

    @cached_property
    def axis(self) -> np.ndarray:
        return np.asarray(self.basis.get_dofs(lambda x: x[0] == 0).all())

    @cached_property
    def outer(self) -> np.ndarray:
        far = self.locations.max(axis=1)[:, None] * (1 - 1e-9)
        return np.asarray(self.basis.get_dofs(lambda x: np.any(x >= far, axis=0)).all())

    @cached_property
    def elimination(self) -> np.ndarray:
        """Unknowns of one field on the sides of triangles, in an order that fills a factor little."""
        sides = self.basis.element_dofs[: self.basis.Nbfun - self.basis.elem.interior_dofs].T
        used, local = np.unique(sides, return_inverse=True)
        local = local.reshape(sides.shape)
        ones = np.ones((*sides.shape, sides.shape[1]))
        return np.asarray(used[minimum_degree(_assembled(ones, local, used.size))])

    def stiffness(self, materials: tuple[tuple[float, float], ...], harmonic: float) -> sp.csc_matrix:
        """Stiffness matrix, (n, n) for field vectors (n,): virtual work over the angular factor of all terms.

            v^T K u = int eps(v) : D(layer) eps(u) r dr dz

        That factor is 2 pi for harmonic 0, pi for others. ``materials`` = (E, nu) per layer.
        """
        return _assembled(
            *self._elements(materials, harmonic, np.arange(self.mesh.layer.size)),
            (3 if harmonic else 2) * self.N,
        )

    def skeleton(
        self, materials: tuple[tuple[float, float], ...], harmonic: float, cells: np.ndarray | None = None
    ) -> "Skeleton":
        """Stiffness without the unknowns inside triangles; of the triangles ``cells`` alone, or of all."""
        cells = np.arange(self.mesh.layer.size) if cells is None else cells
        fields = 3 if harmonic else 2
        inside = np.arange(self.basis.Nbfun) >= self.basis.Nbfun - self.basis.elem.interior_dofs
        i, o = np.flatnonzero(np.tile(inside, fields)), np.flatnonzero(np.tile(~inside, fields))
        triangles = cells.size
        matrix = np.empty((triangles, o.size, o.size))
        extension = np.empty((triangles, i.size, o.size))
        inner, outer = (np.empty((triangles, of.size), dtype=np.int32) for of in (i, o))
        for begin in range(0, triangles, chosen.TRIANGLES_AT_ONCE):
            some = slice(begin, begin + chosen.TRIANGLES_AT_ONCE)
            K, numbers = self._elements(materials, harmonic, cells[some])
            inner[some], outer[some] = numbers[:, i], numbers[:, o]
            K_io = K[:, i[:, None], o]
            extension[some] = -np.linalg.solve(K[:, i[:, None], i], K_io)
            matrix[some] = K[:, o[:, None], o] + K_io.transpose(0, 2, 1) @ extension[some]
        return Skeleton(_assembled(matrix, outer, fields * self.N), inner, outer, extension)

    def _elements(
        self, materials: tuple[tuple[float, float], ...], harmonic: float, cells: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Stiffness (m, size, size) of the triangles ``cells`` and the numbers (m, size) of their unknowns.

        With s = (dphi/dr, dphi/dz, phi/r) of the shape functions and a, b = r, z, 0, the fields f and g of
        the functions i and j are coupled by

            K_fi,gj = sum_ab (A_a^T D A_b)_fg int s_ai s_bj r dr dz,

        by quadrature that is exact but for the terms in 1/r.
        """
        basis = Basis(
            self.triangulation,
            ELEMENTS[self.order](),
            intorder=2 * self.order,
            elements=cells,
            dofs=self.basis.dofs,
        )
        r = np.asarray(basis.global_coordinates())[0]
        root = np.sqrt(r * basis.dx)
        s = np.empty((len(r), basis.Nbfun, 3, r.shape[1]))
        for i, (phi,) in enumerate(basis.basis):
            s[:, i] = np.stack([phi.grad[0] * root, phi.grad[1] * root, phi / r * root], axis=1)

        A = np.stack(strain_operator(harmonic))
        D = np.stack([elasticity(E, nu, harmonic) for E, nu in materials])
        coupling = np.einsum("asf,lst,btg->lfgab", A, D, A, optimize=True)[self.mesh.layer[cells]]
        fields, rows = A.shape[2], s.reshape(*s.shape[:2], -1)
        K = np.empty((len(r), fields, basis.Nbfun, fields, basis.Nbfun))
        for f in range(fields):
            for g in range(f + 1):
                columns = (coupling[:, None, f, g] @ s).reshape(rows.shape)
                K[:, f, :, g] = block = rows @ columns.transpose(0, 2, 1)
                K[:, g, :, f] = block.transpose(0, 2, 1)
        field = basis.N * np.arange(fields, dtype=np.int32)[:, None]
        numbers = field + np.asarray(basis.element_dofs, dtype=np.int32).T[:, None]
        size = fields * basis.Nbfun
        return K.reshape(-1, size, size), numbers.reshape(-1, size)

    def contact_basis(self) -> FacetBasis:
        """Shape functions on the contact, with quadrature exact for products of two and r."""
        mesh, a = self.triangulation, self.mesh.contact_radius
        edges = mesh.facets_satisfying(lambda x: (x[1] == 0) & (x[0] < a), boundaries_only=True)
        return FacetBasis(mesh, ELEMENTS[self.order](), facets=edges, intorder=2 * self.order + 1)

    def contact_mass(self) -> sp.csr_matrix:
        """Mass matrix of the contact, int phi_i phi_j r dr; shape (N, N)."""
        return asm(_mass, self.contact_basis()).tocsr()

    def contact_load(self, traction: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
        """Load vector of one field, int traction(r) v r dr over the contact; shape (N,)."""
        form = LinearForm(lambda v, w: traction(w.x[0]) * v * w.x[0])
        return np.asarray(asm(form, self.contact_basis()))


@BilinearForm
def _mass(u: Any, v: Any, w: Any) -> Any:
    return u * v * w.x[0]


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Stiffness of the unknowns o on the sides of triangles, from which those i inside follow.

        K_oo - K_oi K_ii^-1 K_io,     u_i = -K_ii^-1 K_io u_o

    for loads on the sides alone. E. L. Wilson, Int. J. Numer. Meth. Engng 8 (1974) 198-203. By hand:
    scikit-fem condenses given values, not unknowns of single triangles.

    matrix : (n, n), whose rows and columns i are empty
    inner, outer : numbers (m, k) of the unknowns i and (m, l) of o by triangle.  extension : (m, k, l)
    """

    matrix: sp.csc_matrix
    inner: np.ndarray
    outer: np.ndarray
    extension: np.ndarray

    def extended(self, u: np.ndarray) -> np.ndarray:
        """The field vectors ``u``, (n,) or (n, columns), given their values inside the triangles in place."""
        u[self.inner] = np.einsum("mio,mo...->mi...", self.extension, u[self.outer], optimize=True)
        return u


def _assembled(elements: np.ndarray, numbers: np.ndarray, n: int) -> sp.csc_matrix:
    """Sum (n, n) of the matrices ``elements`` (m, size, size) of the unknowns ``numbers`` (m, size)."""
    rows, columns = np.broadcast_arrays(numbers[:, :, None], numbers[:, None, :])
    return sp.coo_matrix((elements.ravel(), (rows.ravel(), columns.ravel())), shape=(n, n)).tocsc()
