"""Uncertainty of a guest from its own refinement study, by Roache's grid convergence index.

    U = F |f_n - f_{n-1}| / (r^p - 1),   p = ln(|f_{n-1} - f_{n-2}| / |f_n - f_{n-1}|) / ln r

Roache, J. Fluids Eng. 116 (1994) 405-413. F = 1.25 where p is observed within ``ORDERS``; elsewhere changes
are erratic, as those of a radius counted in patches, and F = 3 with the lower bound or the order 1. A change
that is small by chance does not count: |f_n - f_{n-1}| is at least that of the level before over r^2; along
a line the largest of its neighbours.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from scipy.ndimage import maximum_filter1d

from verification.problem.array_types import Array
from verification.problem.line_profile import Profile

ORDERS = (0.5, 2.1)  # Eca and Hoekstra, J. Comput. Phys. 262 (2014) 104-130
NEIGHBOURS = 5
LEAST = 3  # levels


def estimated(levels: Sequence[float], profiles: Sequence[Profile]) -> Array:
    """Uncertainty of the last of ``profiles``, of one quantity at ``levels``, coarse to fine; its shape.

    The order is that of the mean changes along the line.
    """
    coarse, middle, fine = (profile.value for profile in profiles[-3:])
    ratios = [max(b / a, a / b) for a, b in pairwise(levels)][-2:]
    early, late = np.abs(middle - coarse), np.abs(fine - middle)
    r = ratios[1]
    p = observed_order(float(np.mean(early)), float(np.mean(late)), ratios)
    change = np.maximum(late, early / r**2)
    if change.size > 1:
        change = maximum_filter1d(change, NEIGHBOURS, mode="nearest")
    low, high = ORDERS
    regular = low <= p <= high
    order = p if regular else float(np.nan_to_num(np.clip(p, low, 1.0), nan=low))
    found: Array = (1.25 if regular else 3.0) * change / (r**order - 1)
    return found


def observed_order(early: float, late: float, ratios: Sequence[float]) -> float:
    """Order at which changes fall, solved for p of (r1^p - 1) r2^p / (r2^p - 1) = early / late.

    ratios : r1 of the coarse and the middle level, r2 of the middle and the fine one.
    Infinite where the last change is 0, NaN where there is none.
    """
    if not (np.isfinite(early) and np.isfinite(late)):
        return float("nan")
    if late == 0:
        return float("inf") if early else float("nan")
    if early == 0:
        return float("-inf")
    r1, r2 = ratios
    p = float(np.log(early / late) / np.log(r2))
    for _ in range(50):  # Celik et al., J. Fluids Eng. 130 (2008) 078001; exact at once for r1 = r2
        if not 0.01 < p < 50:
            break
        p = float(np.log(early / late * (r2**p - 1) / (r1**p - 1)) / np.log(r2)) if r1 != r2 else p
    return p
