"""Interpolation on a grid of any number of axes by products of Lagrange's polynomials, with its error."""

from collections.abc import Mapping, Sequence
from math import prod

import numpy as np

from verification.problem.array_types import Array

KINK = 0.05  # of the largest value around
SAFETY = 2.0  # of the error of interpolation, over its estimate
Weights = Mapping[int, float]  # by index of a node


def interpolated(
    table: Array, axes: Sequence[Array], positions: Sequence[float], below: Sequence[bool], most: int
) -> tuple[Array, Array]:
    """Values of ``table`` (quantities, *axes) at ``positions``, each with an estimate of its error.

    Polynomials through the ``most`` nearest nodes of each axis. The error is twice the distance from those
    through one node less, of two nodes from the nearer, summed over the axes, with a share of the largest
    value around; it vanishes at a node.
    axes : the nodes of each, ascending.
    below : axes whose first node stands for smaller values, with the step to the second as error.
    """
    along = list(zip(axes, positions, strict=True))
    full = [window(nodes, x, most) for nodes, x in along]
    near = [window(nodes, x, 2) for nodes, x in along]
    value, error = contracted(table, full), np.zeros(table.shape[0])
    for j, (nodes, x) in enumerate(along):
        chosen, factor = list(full[j]), SAFETY
        fewer = [[i for i in chosen if i != end] for end in (chosen[0], chosen[-1]) if end not in near[j]]
        if len(chosen) == 2:
            fewer = [[min(chosen, key=lambda i: abs(nodes[i] - x))]]
        if below[j] and nodes.size > 1:
            fewer, factor = [[1]], 1.0
        found = (contracted(table, [*full[:j], _lagrange(nodes, x, some), *full[j + 1 :]]) for some in fewer)
        error += np.max([np.zeros_like(error), *(factor * np.abs(one - value) for one in found)], axis=0)
    # a kink, as of a peak that moves off the axis, may escape the polynomials
    cell = table[np.ix_(range(table.shape[0]), *(list(weights) for weights in near))]
    between = max((4 * prod(w.values()) for w in near if len(w) == 2), default=0.0)
    return value, error + KINK * between * np.abs(cell).max(axis=tuple(range(1, cell.ndim)))


def contracted(table: Array, weights: Sequence[Weights]) -> Array:
    """Sum of ``table`` (quantities, *axes) with the ``weights`` of the nodes of each axis."""
    for along in reversed(weights):
        chosen = [i for i, weight in along.items() if weight]
        table = table[..., chosen] @ np.array([along[i] for i in chosen])
    return table


def _lagrange(nodes: Array, x: float, chosen: Sequence[int]) -> Weights:
    """Weights of the polynomial through the ``chosen`` nodes."""
    return {
        i: float(np.prod([(x - nodes[j]) / (nodes[i] - nodes[j]) for j in chosen if j != i])) for i in chosen
    }


def window(nodes: Array, x: float, most: int) -> Weights:
    """Weights of the polynomial through the ``most`` nodes around ``x``, or through all there are."""
    right = int(np.clip(np.searchsorted(nodes, x), min(1, nodes.size - 1), nodes.size - 1))
    first = int(np.clip(right - most // 2, 0, max(nodes.size - most, 0)))
    return _lagrange(nodes, x, range(first, min(first + most, nodes.size)))
