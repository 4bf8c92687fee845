"""Linear systems with given values: scikit-fem condenses them, SciPy's SuperLU or Pardiso factorises them.

SuperLU, X. S. Li, ACM Trans. Math. Softw. 31 (2005) 302-325, works in its symmetric mode: pivots on the
diagonal, in an order of minimum degree. Pardiso, O. Schenk and K. Gaertner, Future Gener. Comput. Syst. 20
(2004) 475-487, takes its place where the extra ``fast`` brings pypardiso, Cholesky in such an order.
"""

import os
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from importlib.util import find_spec

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla
from skfem import condense

from fem_reference import element_numbers as chosen

# Solution for a right-hand side (n,) or several in columns (n, columns).
Factor = Callable[[np.ndarray], np.ndarray]

_PARDISO = find_spec("pypardiso") is not None


def factorised(matrix: sp.csc_matrix) -> Factor:
    """Factor of a symmetric positive definite ``matrix``, in its precision."""
    if _PARDISO:
        return _by_pardiso(sp.triu(matrix, format="csr"))
    solve = _by_superlu(matrix, "MMD_AT_PLUS_A").solve
    return lambda load: np.asarray(solve(load.astype(matrix.dtype, copy=False)), dtype=float)


def _by_superlu(matrix: sp.csc_matrix, order: str) -> sla.SuperLU:
    return sla.splu(
        matrix,
        permc_spec=order,
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
        # small blocks: 7 to 28 % less time than with SciPy's defaults and up to a tenth less memory
        relax=1,
        panel_size=4,
    )


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
    """

    u: np.ndarray
    force: np.ndarray
    residual: np.ndarray


def constrained_solve(
    K: sp.csc_matrix, given: np.ndarray, fixed: np.ndarray, load: np.ndarray | None = None
) -> Constrained:
    """Solve K u = load with u = ``given`` at the unknowns ``fixed``; several columns share one factorisation.

    given, load : (n,) or (n, columns)
    """
    fixed = np.unique(fixed)
    load = np.zeros(given.shape) if load is None else load
    A, b, u, free = condense(K, load, x=given, D=fixed)
    A, failed = A.tocsc(), True
    if b.ndim == 1 and not _PARDISO:
        # A factor in single precision takes half the memory and a third less time; for several columns the
        # iterations cost more than that. To rounding, since forces next to the edge are small.
        rough = factorised(A.astype(np.float32))
        M = sla.LinearOperator(A.shape, rough, dtype=float)
        u[free], failed = sla.cg(A, b, rough(b), rtol=1e-15, maxiter=chosen.MOST_STEPS, M=M)
    if failed:
        factor = factorised(A)
        found = factor(b)
        u[free] = found + factor(b - A @ found)  # for the rounding of the factor
    force = K @ u - load
    residual = np.zeros_like(force)
    residual[free], force[free] = force[free], 0.0
    return Constrained(u, force, residual)


def minimum_degree(graph: sp.csc_matrix) -> np.ndarray:
    """Order of elimination of the nodes of a symmetric ``graph`` (n, n) that fills its factor little."""
    joined = abs(graph) + sp.diags(np.ravel(abs(graph).sum(axis=0)) + 1.0)
    return np.argsort(_by_superlu(joined.tocsc(), "MMD_AT_PLUS_A").perm_c)


@dataclass(frozen=True, eq=False)
class ConstrainedFactor:
    """K factorised once, with given values at all unknowns but the ``free``, for loads not known yet.

    free : in the order of elimination.   kept : how many of them, the last, ``compliance`` belongs to
    """

    K: sp.csc_matrix
    free: np.ndarray
    kept: int
    factor: sla.SuperLU

    @classmethod
    def of(cls, K: sp.csc_matrix, order: np.ndarray, kept: np.ndarray) -> "ConstrainedFactor":
        """order : the free unknowns in an order that fills the factor little.   kept : of these, the last."""
        A, _, free = condense(K, I=np.concatenate([order[~np.isin(order, kept)], kept]))
        return cls(K, free, kept.size, _by_superlu(A.tocsc(), "NATURAL"))

    @cached_property
    def compliance(self) -> np.ndarray:
        """Rows and columns ``kept`` of the inverse, (kept, kept).

        The inverse of the Schur complement, which elimination of all others leaves of K (F. Zhang, ed., The
        Schur Complement and Its Applications, Springer 2005, theorem 1.2): the product of the last blocks of
        the factors L D L^T.
        """
        L = self.factor.L[:, -self.kept :].tocsr()[-self.kept :].toarray()
        inverse = np.linalg.inv(L * self.factor.U.diagonal()[-self.kept :] @ L.T)
        return np.asarray(inverse + inverse.T) / 2

    def rows(self, at: np.ndarray) -> np.ndarray:
        """Numbers among the ``free`` unknowns of those ``at``, -1 of one that is given."""
        row = np.full(self.K.shape[0], -1)
        row[self.free] = np.arange(self.free.size)
        return np.asarray(row[at])

    def solve(
        self, at: np.ndarray, load: np.ndarray, given: tuple[np.ndarray, np.ndarray] | None = None
    ) -> np.ndarray:
        """u (free, columns) of K u = load with u = ``given``, or 0, at all others.

        at, load : the unknowns that are loaded (k,), each once, and their loads (k, columns)
        given : (n,), 0 at the ``free``, and how many times that in each column
        To the rounding of the factor: displacements are read, not forces.
        """
        u, row = np.empty((self.free.size, load.shape[1]), order="F"), self.rows(at)
        held, times = np.zeros((self.free.size, 1)), np.zeros(load.shape[1])
        if given is not None:
            held, times = (self.K @ given[0])[self.free, None], given[1]
        for begin in range(0, load.shape[1], chosen.COLUMNS_AT_ONCE):
            some = slice(begin, begin + chosen.COLUMNS_AT_ONCE)
            force = np.asfortranarray(-held * times[some])
            force[row[row >= 0]] += load[row >= 0, some]
            u[:, some] = self.factor.solve(force)
        return u
