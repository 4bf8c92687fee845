"""Quadrilaterals of the layers below a disc of radius 1, fine below it and at its rim."""

import numpy as np
from sfepy.discrete.fem import FEDomain, Mesh


def spaced(breaks, far, size, rim):
    """From 0 to ``far`` through ``breaks``, elements of ``size`` up to 1.5, small at ``rim``."""
    found = [0.0]
    for end in (*breaks, far):
        while found[-1] < end:
            here = size * max(1, found[-1] / 1.5) * min(1, 0.06 + abs(found[-1] - rim))
            rest = end - found[-1]
            found.append(end if rest < 1.5 * here else found[-1] + here)
    return np.array(found)


def grid(bounds, far, size):
    """Quadrilaterals whose sides go through the disc's rim and the interfaces."""
    r, z = spaced([1.0], far, size, 1.0), spaced(bounds, far, size, 0.0)
    n = np.arange(r.size * z.size).reshape(r.size, z.size)
    corners = np.stack([n[:-1, :-1], n[1:, :-1], n[1:, 1:], n[:-1, 1:]], -1).reshape(-1, 4)
    places = np.stack(np.meshgrid(r, z, indexing="ij"), -1).reshape(-1, 2)
    return FEDomain("d", Mesh.from_data("m", places, None, [corners], [np.zeros(len(corners), int)], ["2_4"]))
