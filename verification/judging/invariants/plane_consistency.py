"""Fields of the semi-analytical method on whole planes, compared with its own values at points.

A plane is a convolution of patch means by FFT; a value at a point is a sum over rings of the smooth pressure.
Both hold ten patches or more below a pressure that falls to zero at its edge, where patches count by their
means; nearer to the edge than that, and under a step of the pressure, a plane is less accurate.
"""

from typing import Any

import numpy as np

from verification.judging.invariant_verdict import Invariant, decide
from verification.problem.coated_contact import CoatedContact, Solution, keywords

PATCHES = 129  # under a disc
DEPTH = 0.6  # of the contact radius: over thirty of these patches
BOUND = 1e-6  # they differ by what the means of patches leave
# Share of the patches along x and y, off the axes.
PLACES = np.array([[0.1, 0.3, 0.5, 0.62, 0.87], [0.5, 0.15, 0.62, 0.25, 0.94]])


def planes(solution: Solution, source: str, problem: CoatedContact) -> tuple[Invariant, ...]:
    """Stress and displacement on a plane at the patch centres = those at points: disc, then sphere.

    The disc under Hertz's pressure. Of a sphere its coarsest companion: the same code, on fewer patches.
    """
    import semianalytic

    a, p_h = solution.contact_radius, problem.p_h
    given = keywords(problem.under_disc(p_h, a)) | {"pressure": lambda r: p_h * np.sqrt(1 - (r / a) ** 2)}
    pressed = semianalytic.solve_prescribed(**given, patches=PATCHES, estimate_uncertainty=False)
    coarsest: Any = solution
    while coarsest.coarser is not None:
        coarsest = coarsest.coarser
    law = "fields on a plane are those at points, over p_h and delta_h"
    return tuple(
        decide(f"planes of the {name}", source, law, _gap(one, problem), BOUND)
        for name, one in (("disc", pressed), ("sphere", coarsest))
    )


def _gap(solution: Any, problem: CoatedContact) -> np.ndarray:
    z, n = DEPTH * solution.contact_radius, solution.nodes.size
    i, j = (PLACES * (n - 1)).round().astype(int)
    at = solution.nodes[i], solution.nodes[j], z
    sigma = solution.stress_plane(z)[:, :, i, j] - solution.stress(*at)
    u = solution.displacement_plane(z)[:, i, j] - solution.displacement(*at)
    return np.concatenate([sigma.ravel() / problem.p_h, u.ravel() / problem.delta_h])
