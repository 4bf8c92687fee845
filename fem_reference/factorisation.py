"""Factorisation of a stiffness matrix: nested dissection, or Pardiso where the extra ``fast`` is installed.

Pardiso is that of Intel's oneMKL, in the wheel ``mkl``: a supernodal Cholesky factorisation in an order of
minimum degree, on one thread. (Its nested dissection takes three times as long to find an order that saves a
tenth of the factorisation.) It is given the pattern of the nodes, whose unknowns are dense blocks, so that
its analysis is as short for three fields as for one.
O. Schenk and K. Gaertner, Future Gener. Comput. Syst. 20 (2004) 475-487.
"""

import ctypes
import weakref
from collections.abc import Callable
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, files
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from .dissection import CholeskyFactor, DissectionTree

__all__ = ["Elimination", "Factor", "elimination", "factorised", "pardiso_library"]

_SEQUENTIAL, _LP64 = 1, 0  # of oneMKL: no threads, integers of 32 bits
_POSITIVE_DEFINITE = 2
_MINIMUM_DEGREE = 0
_ANALYSE, _FACTORISE, _SOLVE, _RELEASE = 11, 22, 33, -1
_NOT_POSITIVE = -4


class Factor(Protocol):
    """Factor of a symmetric positive definite matrix."""

    def solve(self, load: np.ndarray) -> np.ndarray:
        """Solution for ``load``, (unknowns,) or (unknowns, columns), whose entries at ``held`` are zero."""
        ...


class BlockPattern:
    """Places of the nonzero blocks, one for each pair of nodes of a triangle, on and above the diagonal.

    The order of elimination is found with the first factor and kept for all others.
    """

    def __init__(self, elements: np.ndarray) -> None:
        """``elements`` : (triangles, nodes of each)."""
        triangles, k = elements.shape
        self.nodes = N = int(elements.max()) + 1
        first = elements.astype(np.int64)[:, :, None]  # keys exceed 32 bits from 46000 nodes on
        second = first.transpose(0, 2, 1)
        pairs = np.flatnonzero(first <= second)
        keys = (first * N + second).ravel()[pairs]
        order = np.argsort(keys, kind="stable")
        begins = np.flatnonzero(np.diff(keys[order], prepend=-1))
        blocks = keys[order[begins]]
        self.rows = blocks // N
        self.columns = (blocks % N).astype(np.int32)
        self.begins = np.searchsorted(blocks, np.arange(N + 1) * N).astype(np.int32)
        # sum of the blocks of the triangles that share a pair
        ends = np.append(begins, pairs.size)
        self.sums = sp.csr_matrix((np.ones(pairs.size), pairs[order], ends), (blocks.size, triangles * k**2))
        self.order: np.ndarray | None = None

    def assembled(self, elements: np.ndarray, held: np.ndarray) -> np.ndarray:
        """Blocks (blocks, fields, fields), with the rows and columns ``held`` those of the unit matrix."""
        fields = held.size // self.nodes
        k = elements.shape[1] // fields
        # each row of a block moved as one item: half of the time of its numbers one by one
        rows = elements.view(f"V{elements.itemsize * fields}").reshape(-1, k, fields, k)
        split = np.ascontiguousarray(rows.swapaxes(2, 3)).view(elements.dtype)
        blocks = (self.sums @ split.reshape(-1, fields**2)).reshape(-1, fields, fields)
        kept = 1.0 - held.reshape(fields, self.nodes).T
        partly = kept.min(axis=1) == 0
        at = np.flatnonzero(partly[self.rows] | partly[self.columns])
        blocks[at] *= kept[self.rows[at], :, None] * kept[self.columns[at], None, :]
        blocks[self.begins[:-1, None], np.arange(fields), np.arange(fields)] += 1.0 - kept
        return blocks


class PardisoFactor:
    """Factor by Pardiso, see ``CholeskyFactor``."""

    def __init__(self, pattern: BlockPattern, elements: np.ndarray, held: np.ndarray) -> None:
        """Factorise. Raises numpy.linalg.LinAlgError where the matrix is not positive definite."""
        library = pardiso_library()
        assert library is not None
        self._pattern, self._library = pattern, library
        self._fields = held.size // pattern.nodes
        self._blocks = pattern.assembled(elements, held)
        self._handle, self._settings = np.zeros(64, dtype=np.int64), np.zeros(64, dtype=np.int32)
        known = pattern.order is not None
        self._order = pattern.order if known else np.zeros(pattern.nodes, dtype=np.int32)
        # as numbered in oneMKL's manual, iparm(1), ...: 2 kind of order, 5 whether it is given or returned
        settings = {1: 1, 2: _MINIMUM_DEGREE, 5: 1 if known else 2, 35: 1, 37: self._fields}
        for number, value in settings.items():
            self._settings[number - 1] = value
        weakref.finalize(self, _call, library, self._handle, self._settings, _RELEASE, pattern.nodes)
        self._run(_ANALYSE)
        pattern.order = self._order
        self._run(_FACTORISE)

    def _run(self, phase: int, load: np.ndarray | None = None, x: np.ndarray | None = None) -> None:
        pattern = self._pattern
        arrays = self._blocks, pattern.begins, pattern.columns, self._order, load, x
        _call(self._library, self._handle, self._settings, phase, pattern.nodes, *arrays)

    def solve(self, load: np.ndarray) -> np.ndarray:
        """As ``CholeskyFactor.solve``."""
        nodes, fields = self._pattern.nodes, self._fields
        by_node = np.ascontiguousarray(load.reshape(fields, nodes, -1).transpose(2, 1, 0), dtype=float)
        x = np.empty_like(by_node)
        self._run(_SOLVE, by_node, x)
        return np.ascontiguousarray(x.transpose(2, 1, 0)).reshape(load.shape)


Elimination = DissectionTree | BlockPattern


def elimination(elements: np.ndarray, leaf: Callable[[], np.ndarray]) -> Elimination:
    """What all matrices on ``elements`` (triangles, nodes of each) share.

    leaf : leaf of each triangle in a tree of bisections, where that is needed
    """
    if pardiso_library() is not None:
        return BlockPattern(elements)
    return DissectionTree.of(elements, leaf())


def factorised(kept: Elimination, elements: np.ndarray, held: np.ndarray) -> Factor:
    """Factor of the sum of the matrices ``elements``, arguments and errors as of ``CholeskyFactor``."""
    if isinstance(kept, BlockPattern):
        return PardisoFactor(kept, elements, held)
    return CholeskyFactor(kept, elements, held)


@lru_cache
def pardiso_library() -> ctypes.CDLL | None:
    """The library of the wheel ``mkl``, set to one thread; None where it is not installed."""
    try:
        found = [file for file in files("mkl") or () if file.name.startswith("libmkl_rt.so")]
    except PackageNotFoundError:
        found = []
    if not found:
        return None
    library = ctypes.CDLL(str(found[0].locate()))
    # The factorisations of one contact are small and one after the other: threads wait for each other.
    library.MKL_Set_Threading_Layer(_SEQUENTIAL)
    library.MKL_Set_Interface_Layer(_LP64)
    return library


def _call(
    library: ctypes.CDLL,
    handle: np.ndarray,
    settings: np.ndarray,
    phase: int,
    nodes: int,
    blocks: np.ndarray | None = None,
    begins: np.ndarray | None = None,
    columns: np.ndarray | None = None,
    order: np.ndarray | None = None,
    load: np.ndarray | None = None,
    x: np.ndarray | None = None,
) -> None:
    """Pardiso of oneMKL, arguments in the order of its manual.

    Raises numpy.linalg.LinAlgError where the matrix is not positive definite, RuntimeError else.
    """
    one, silent, error = ctypes.c_int32(1), ctypes.c_int32(0), ctypes.c_int32(0)
    kind, step, size = ctypes.c_int32(_POSITIVE_DEFINITE), ctypes.c_int32(phase), ctypes.c_int32(nodes)
    loads = ctypes.c_int32(1 if load is None else len(load))

    def address(array: np.ndarray | None) -> ctypes.c_void_p:
        return ctypes.c_void_p(None if array is None else array.ctypes.data)

    by = ctypes.byref
    library.pardiso(
        *(address(handle), by(one), by(one), by(kind), by(step), by(size)),
        *(address(blocks), address(begins), address(columns), address(order)),
        *(by(loads), address(settings), by(silent), address(load), address(x), by(error)),
    )
    if error.value == _NOT_POSITIVE:
        raise np.linalg.LinAlgError("Matrix is not positive definite")
    if error.value:
        raise RuntimeError(f"Pardiso ends with error {error.value} in phase {phase}; uninstall the wheel mkl")
