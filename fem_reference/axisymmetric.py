"""Linear elasticity of a body of revolution under loads of Fourier harmonic 0 or 1.

Harmonic 0 has two fields on the meridian plane, harmonic 1 has three:

    0:  u_r = U,             u_theta = 0,             u_z = Z
    1:  u_r = U cos(theta),  u_theta = V sin(theta),  u_z = Z cos(theta),     with S = U + V

Harmonic 1 is solved for (S, V, Z): regularity on the axis, u_theta = -u_r and u_z = 0, then reads S = Z = 0,
and only fields that vanish there are divided by r. Each strain is linear in the fields,

    eps = A_r du/dr + A_z du/dz + A_0 u / r,

with engineering shear. Components in the order rr, theta theta, zz, rz (harmonic 0), then r theta, theta z
(harmonic 1, these two times sin(theta), the others times cos(theta)).
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
    FacetBasis,
    LinearForm,
    MeshTri,
    asm,
)

from .dissection import bisected, unknowns
from .factorisation import Elimination, elimination, factorised
from .integrals import ELEMENTS, reference_integrals
from .location import Locator
from .mesh import MeridianMesh

__all__ = ["ELEMENTS", "Discretisation", "Stiffness", "constrained_solve", "elasticity", "strain_operator"]


def strain_operator(harmonic: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The matrices (A_r, A_z, A_0), each of shape (strains, fields).

    Harmonic 0, fields (U, Z):  rr = U,r   tt = U/r   zz = Z,z   rz = U,z + Z,r
    Harmonic 1, fields (S, V, Z), U = S - V:
        rr = U,r   tt = S/r   zz = Z,z   rz = U,z + Z,r   rt = V,r - S/r   tz = V,z - Z/r
    """
    if harmonic == 0:
        A_r, A_z, A_0 = np.zeros((3, 4, 2))
        A_r[0, 0] = A_r[3, 1] = 1
        A_z[2, 1] = A_z[3, 0] = 1
        A_0[1, 0] = 1
        return A_r, A_z, A_0
    A_r, A_z, A_0 = np.zeros((3, 6, 3))
    A_r[0, 0], A_r[0, 1], A_r[3, 2], A_r[4, 1] = 1, -1, 1, 1
    A_z[2, 2], A_z[3, 0], A_z[3, 1], A_z[5, 1] = 1, 1, -1, 1
    A_0[1, 0], A_0[4, 0], A_0[5, 2] = 1, -1, -1
    return A_r, A_z, A_0


def elasticity(E: float, nu: float, harmonic: int) -> np.ndarray:
    """Hooke's law as a matrix from strain to stress, in the component order of the module.

    sigma = lambda tr(eps) I + 2 G eps;  engineering shears carry G alone. Units of ``E``.
    """
    G = E / (2 * (1 + nu))
    lame = 2 * G * nu / (1 - 2 * nu)
    D = np.diag([2 * G] * 3 + [G] * (1 if harmonic == 0 else 3))
    D[:3, :3] += lame
    return D


@dataclass(frozen=True, eq=False)
class Discretisation:
    """Lagrange elements of one ``order`` on a meridian mesh, and everything assembled from them.

    A field vector stacks the fields one after the other: entry ``field * N + i`` is the value of that field
    at ``locations[:, i]``.
    """

    mesh: MeridianMesh
    order: int

    def __getstate__(self) -> dict[str, object]:
        # pickled without the cached properties, which are computed again on use: a hundred times smaller
        return {"mesh": self.mesh, "order": self.order}

    def moved(self, mesh: MeridianMesh) -> "Discretisation":
        """The same elements on another ``mesh``; one of the same triangles keeps the order of elimination."""
        d = Discretisation(mesh, self.order)
        if mesh.triangles is self.mesh.triangles:
            kept = vars(self)
            vars(d).update({name: kept[name] for name in ("leaf", "elimination") if name in kept})
        return d

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
        return Locator(self.mesh, self.triangulation.t)

    @property
    def N(self) -> int:
        """Unknowns per field."""
        return int(self.basis.N)

    @property
    def locations(self) -> np.ndarray:
        """Positions (r, z) of the unknowns, shape (2, N)."""
        return np.asarray(self.basis.doflocs)

    def facets(self, where: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
        """Boundary edges whose midpoint satisfies ``where``."""
        return np.asarray(self.triangulation.facets_satisfying(where, boundaries_only=True))

    def unknowns_on(self, facets: np.ndarray) -> np.ndarray:
        """Numbers of the unknowns (of one field) on the edges ``facets``."""
        return np.asarray(self.basis.get_dofs(facets).all())

    @cached_property
    def contact_vertices(self) -> np.ndarray:
        """Increasing radii of the surface vertices from the axis to the contact edge."""
        r, z = self.mesh.points
        return np.sort(r[(z == 0) & (r <= self.mesh.contact_radius)])

    @cached_property
    def surface(self) -> np.ndarray:
        """Unknowns of one field on z = 0, by increasing radius."""
        numbers = self.unknowns_on(self.facets(lambda x: x[1] == 0))
        return numbers[np.argsort(self.locations[0, numbers])]

    @cached_property
    def contact(self) -> np.ndarray:
        """Unknowns of one field on the contact, by increasing radius."""
        return self.surface[self.locations[0, self.surface] <= self.mesh.contact_radius]

    @cached_property
    def axis(self) -> np.ndarray:
        return self.unknowns_on(self.facets(lambda x: x[0] == 0))

    @cached_property
    def outer(self) -> np.ndarray:
        far = self.locations.max(axis=1)[:, None] * (1 - 1e-9)
        return self.unknowns_on(self.facets(lambda x: np.any(x >= far, axis=0)))

    @cached_property
    def leaf(self) -> np.ndarray:
        """Leaf of each triangle in a tree of bisections, (triangles,)."""
        xi, zeta = self.mesh.plane(*self.mesh.points[:, self.triangulation.t].mean(axis=1))
        return bisected(self.triangulation.t, np.stack([xi, zeta, np.hypot(xi, zeta)]))

    @cached_property
    def elimination(self) -> Elimination:
        """Order of elimination of the unknowns of one field."""
        return elimination(np.asarray(self.basis.element_dofs).T, lambda: self.leaf)

    def stiffness(self, materials: tuple[tuple[float, float], ...], harmonic: int) -> "Stiffness":
        """Stiffness matrix with its order of elimination, see ``element_stiffness``."""
        nodes = np.asarray(self.basis.element_dofs).T
        return Stiffness(self.element_stiffness(materials, harmonic), nodes, self.elimination)

    def element_stiffness(
        self, materials: tuple[tuple[float, float], ...], harmonic: int, out: np.ndarray | None = None
    ) -> np.ndarray:
        """Stiffness of the triangles: virtual work over the angular factor common to all terms.

            v^T K u = int eps(v) : D(layer) eps(u) r dr dz

        That factor is 2 pi for harmonic 0, pi for harmonic 1. ``materials`` = (E, nu) per layer. With
        s = (dphi/dr, dphi/dz, phi/r) of the shape functions and a, b = r, z, 0, the fields f and g of the
        functions i and j are coupled by

            K_if,jg = sum_ab (A_a^T D A_b)_fg int s_ai s_bj r dr dz.

        Returns shape (triangles, size, size), unknowns by node, then field; in ``out`` where that is given.
        """
        A = np.stack(strain_operator(harmonic))
        integrals = reference_integrals(self.order)
        factors = integrals.factors(self.mesh.points, self.triangulation.t)
        size = self.basis.Nbfun * A.shape[2]
        K = np.empty((len(factors), size, size)) if out is None else out
        layer = self.mesh.layer
        begins = np.flatnonzero(np.diff(layer, prepend=-1))
        for begin, end in zip(begins, [*begins[1:], layer.size], strict=True):
            E, nu = materials[layer[begin]]
            coupling = np.einsum("asf,st,btg->abfg", A, elasticity(E, nu, harmonic), A, optimize=True)
            np.matmul(factors[begin:end], integrals.coupled(coupling), out=K[begin:end].reshape(-1, size**2))
        return K

    def surface_basis(self, facets: np.ndarray) -> FacetBasis:
        """Shape functions on surface edges, with quadrature exact for products of two and r."""
        return FacetBasis(
            self.triangulation, ELEMENTS[self.order](), facets=facets, intorder=2 * self.order + 1
        )

    def surface_mass(self, facets: np.ndarray) -> sp.csr_matrix:
        """Mass matrix of the surface edges ``facets``, int phi_i phi_j r dr; shape (N, N)."""
        return asm(_mass, self.surface_basis(facets)).tocsr()

    def surface_load(self, facets: np.ndarray, traction: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
        """Load vector of one field, int traction(r) v r dr over the surface edges ``facets``; shape (N,)."""
        return np.asarray(
            asm(LinearForm(lambda v, w: traction(w.x[0]) * v * w.x[0]), self.surface_basis(facets))
        )


@BilinearForm
def _mass(u: Any, v: Any, w: Any) -> Any:
    return u * v * w.x[0]


@dataclass(frozen=True, eq=False)
class Stiffness:
    """Symmetric positive definite matrix as the sum of those of its triangles.

    elements : (triangles, size, size), unknowns by node, then field
    nodes : (triangles, nodes) of one field
    elimination : its order, shared by all matrices on the same triangles
    """

    elements: np.ndarray
    nodes: np.ndarray
    elimination: Elimination

    @property
    def fields(self) -> int:
        return self.elements.shape[1] // self.nodes.shape[1]

    def __matmul__(self, u: np.ndarray) -> np.ndarray:
        """Product with a field vector or several, (n,) or (n, columns)."""
        columns = u.reshape(len(u), -1)
        numbers = unknowns(self.nodes, self.fields, len(u) // self.fields)
        force = self.elements @ columns[numbers]
        total = [np.bincount(numbers.ravel(), one.ravel(), len(u)) for one in np.moveaxis(force, 2, 0)]
        return np.stack(total, axis=1).reshape(u.shape)


def constrained_solve(
    K: Stiffness, given: np.ndarray, fixed: np.ndarray, load: np.ndarray | None = None
) -> np.ndarray:
    """Solve K u = load with u = ``given`` at the unknowns ``fixed``; several columns share one factorisation.

    given, load : (n,) or (n, columns).  Returns u of the shape of ``given``.
    Raises numpy.linalg.LinAlgError where K is not positive definite on the other unknowns.
    """
    held = np.zeros(len(given), dtype=bool)
    held[fixed] = True
    factor = factorised(K.elimination, K.elements, held)
    u = np.where(held[:, None] if given.ndim == 2 else held, given, 0.0)
    for _ in range(2):  # the second time for the rounding of the factor
        residual = -(K @ u) if load is None else load - K @ u
        residual[held] = 0.0
        u += factor.solve(residual)
    return u
