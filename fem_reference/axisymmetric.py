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

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla
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

from .location import Locator
from .mesh import MeridianMesh

__all__ = ["ELEMENTS", "Discretisation", "constrained_solve", "elasticity", "strain_operator"]

BLOCK = 64  # triangles whose stiffness is computed together
ELEMENTS = {2: ElementTriP2, 3: ElementTriP3, 4: ElementTriP4}


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

    @cached_property
    def triangulation(self) -> MeshTri:
        # sort_t: scikit-fem needs ascending vertex numbers to match edge unknowns of order 3 and above
        return MeshTri(self.mesh.points, self.mesh.triangles, sort_t=True)

    @cached_property
    def basis(self) -> Basis:
        return Basis(self.triangulation, ELEMENTS[self.order](), intorder=2 * self.order)

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
    def axis(self) -> np.ndarray:
        return self.unknowns_on(self.facets(lambda x: x[0] == 0))

    @cached_property
    def outer(self) -> np.ndarray:
        far = self.locations.max(axis=1)[:, None] * (1 - 1e-9)
        return self.unknowns_on(self.facets(lambda x: np.any(x >= far, axis=0)))

    def stiffness(self, materials: tuple[tuple[float, float], ...], harmonic: int) -> sp.csc_matrix:
        """Stiffness matrix: virtual work over the angular factor common to all terms.

            v^T K u = int eps(v) : D(layer) eps(u) r dr dz

        That factor is 2 pi for harmonic 0, pi for harmonic 1. ``materials`` = (E, nu) per layer.
        """
        A_r, A_z, A_0 = strain_operator(harmonic)
        fields = A_r.shape[1]
        r = np.asarray(self.basis.global_coordinates())[0]
        weight = r * self.basis.dx
        triangles, points = weight.shape
        local = len(self.basis.basis)
        phi = np.stack([np.broadcast_to(np.asarray(b[0]), r.shape) for b in self.basis.basis], axis=-1)
        d_r, d_z = (np.stack([b[0].grad[i] for b in self.basis.basis], axis=-1) for i in (0, 1))
        hoop = phi / r[..., None]
        D = np.stack([elasticity(E, nu, harmonic) for E, nu in materials])[self.mesh.layer]
        K = np.empty((triangles, fields * local, fields * local))
        # in blocks that stay in the cache of the processor
        for begin in range(0, triangles, BLOCK):
            block = slice(begin, begin + BLOCK)
            # strain of every (field, shape function) at every quadrature point
            B = np.zeros((len(K[block]), points, A_r.shape[0], fields, local))
            for A, shape in ((A_r, d_r[block]), (A_z, d_z[block]), (A_0, hoop[block])):
                for s, field in zip(*np.nonzero(A), strict=True):
                    B[:, :, s, field] += A[s, field] * shape
            flat = B.reshape(-1, points, A_r.shape[0], fields * local)
            stress = np.matmul(D[block, None], flat) * weight[block, :, None, None]
            rows = points * A_r.shape[0]
            transposed = flat.reshape(-1, rows, fields * local).transpose(0, 2, 1)
            K[block] = np.matmul(transposed, stress.reshape(-1, rows, fields * local))
        # 32 bits as in the sparse matrix: it would copy others
        dofs = np.asarray(self.basis.element_dofs, dtype=np.int32).T
        numbers = (np.arange(fields, dtype=np.int32)[:, None] * self.N + dofs[:, None, :]).reshape(
            triangles, -1
        )
        i = np.repeat(numbers, numbers.shape[1], axis=1)
        j = np.tile(numbers, (1, numbers.shape[1]))
        shape = (fields * self.N, fields * self.N)
        return sp.coo_matrix((K.ravel(), (i.ravel(), j.ravel())), shape=shape).tocsc()

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
def _mass(u, v, w):
    return u * v * w.x[0]


def constrained_solve(
    K: sp.csc_matrix, given: np.ndarray, fixed: np.ndarray, load: np.ndarray | None = None
) -> np.ndarray:
    """Solve K u = load with u = ``given`` at the unknowns ``fixed``; several columns share one factorisation.

    given, load : (n,) or (n, columns).  Returns u of the shape of ``given``.
    """
    u = np.array(given, dtype=float)
    free = np.setdiff1d(np.arange(K.shape[0]), fixed)
    rows = K[free]
    rhs = -(rows[:, fixed] @ u[fixed])
    if load is not None:
        rhs = rhs + load[free]
    A = rows[:, free].tocsc()
    # symmetric mode with a symmetric minimum degree ordering: K is positive definite and needs no pivoting
    lu = sla.splu(A, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    x = lu.solve(rhs)
    u[free] = x + lu.solve(rhs - A @ x)
    return u
