"""Upper bounds: continuous displacements, prescribed under the contact, zero far away.

For the true u under the displacement w of the contact, frictionless, and any other admissible v

    <p, w> = B(u, u) <= B(v, v),   B(u, v) = int e(u) : C e(v) dV

v is extended by zero beyond the mesh, so that the bound holds in the infinite half-space.
"""

import numpy as np

from energy_bounds.half_space_mesh import HalfSpace, stiffness
from energy_bounds.spline_elements import Numbers, Pieces
from energy_bounds.tensor_energy import Bound, Energy, Term, solver
from verification.problem.array_types import Array


def strain_energy(solid: HalfSpace) -> Energy:
    """Strains of the unknowns u_r, u_z; u_r = 0 on the axis keeps u_r/r a polynomial in the first piece."""
    r, z = solid.points()
    R, Z = Pieces(solid.r, solid.degree, 0), Pieces(solid.z, solid.degree, 0)
    (R0, R1), (Z0, Z1) = ([space.table(at, k) for k in (0, 1)] for space, at in ((R, r), (Z, z)))
    terms = [
        Term(0, 0, R1, Z0),
        Term(0, 1, R0 / r.place, Z0),
        Term(1, 2, R0, Z1),
        Term(0, 3, R0, Z1),
        Term(1, 3, R1, Z0),
    ]
    return Energy([(R, Z)] * 2, terms, (r, z), solid.moduli(stiffness, z.place))


def upper_bound(solid: HalfSpace) -> Bound:
    """Of <p, w> for w = 1 and r^2/2."""
    energy = strain_energy(solid)
    given, free = admissible(energy)
    A = energy.matrix()
    x = given.copy()
    x[free] += solver(A[free][:, free])(-(A @ given)[free])
    return energy.bound(x, free.size)


def admissible(energy: Energy) -> tuple[Array, Numbers]:
    """Unknowns of two displacements with w = 1, r^2/2 on r < 1, then the numbers of the free unknowns."""
    R, Z = energy.fields[0]
    given, free = np.zeros((2, R.size, Z.size, 2)), np.ones((2, R.size, Z.size), dtype=bool)
    inside = int(np.searchsorted(R.knots, 1.0))
    given[1, : inside + 1, 0, 0], given[1, : inside + 1, 0, 1] = 1, R.knots[: inside + 1] ** 2 / 2
    # (x^2 - 1)/2 is the first function of a piece, r^2/2 has (l/2)^2 of it
    given[1, R.inner[:inside, 0], 0, 1] = (np.diff(R.knots)[:inside] / 2) ** 2
    free[1, [*R.values[: inside + 1], *R.inner[:inside].ravel()], 0] = False
    free[:, R.values[-1]] = free[:, :, Z.values[-1]] = free[0, 0] = False
    return given.reshape(-1, 2), np.flatnonzero(free)
