"""Uncertainty of slicing a graded coating, from half of its sub-layers; for a case in a remark of its result.

U = FACTOR |change| / (2^order - 1), or with the change between half and a quarter of them over 2^order if
that is larger, since one may be small by chance. Contact and tractions converge with the square of the
thickness of the sub-layers, stresses in the plane of a graded coating with that thickness, since they jump.
"""

from collections.abc import Iterator, Mapping
from itertools import accumulate, pairwise
from pathlib import Path

import numpy as np

from verification.cases.case_file import Case, parse_case
from verification.problem.array_types import Array
from verification.problem.coated_contact import ContactSolution
from verification.problem.either_body import on_body
from verification.problem.quantity import SCALARS
from verification.sources.source_record import Solver
from verification.sources.source_registry import METHODS

METHOD = METHODS[0]
IN_PLANE = ("sigma_xx", "sigma_1", "von_mises", "tau_max")  # largest stresses that jump with the modulus
FACTOR = 3.0  # of safety of a study of two grids. P. J. Roache, Annu. Rev. Fluid Mech. 29 (1997) 123-160
REACH, POINTS = 2.0, 201  # of the samples along x, over a


def sliced(change: float, before: float = 0.0, key: tuple[str, ...] = ()) -> float:
    """Uncertainty of the slicing of a number by its ``change`` with half of the sub-layers.

    before : the change from that to a quarter of them.
    key : of a number by its name, or (body, quantity, where) of a largest stress.
    """
    in_plane = len(key) == 3 and key[1] in IN_PLANE and "substrate" not in key[2]
    ratio = 2 if in_plane else 4
    return FACTOR * max(abs(change), abs(before) / ratio) / (ratio - 1)


def slicing_remarks(
    case: Case, solutions: Mapping[str, ContactSolution], available: Mapping[str, Solver]
) -> tuple[str, ...]:
    """How much half of the sub-layers changes: scalars, sigma_xx at the outer sides of each graded coating.

    () where no coating is graded, or where the method that would be compared with itself gave no solution.
    """
    if not case.layers or METHOD not in solutions:
        return ()
    half, solution = parse_case(case.text.encode(), Path(case.name), over=2), solutions[METHOD]
    other = available[METHOD](half.problem, case.numerics.get(METHOD, {}) | {"estimate_uncertainty": False})
    parts = []
    for name in SCALARS:
        value, changed = (one.sample(None, name, False).value for one in (solution, other))
        parts.append(f"{name.replace('_', ' ')} by {100 * abs(changed / value - 1):.1g} %")
    x = np.linspace(-REACH, REACH, POINTS) * float(solution.contact_radius)
    pairs = zip(_sigma_xx(case, solution, x), _sigma_xx(half, other, x), strict=True)
    apart = max(float(np.abs(b - a).max()) for a, b in pairs) / float(solution.peak_pressure)
    given = "; ".join(one for courses in case.courses.values() for one in courses if one)
    count = " and ".join(str(n) for layers in case.layers.values() for n in layers if n > 1)
    return (
        f"E was given as {given}, and solved as {count} sub-layers; half of them change {', '.join(parts)}, "
        f"sigma_xx of the coatings by up to {100 * apart:.1g} % of the peak pressure, and the sources do not "
        "state this uncertainty, which is common to them",
    )


def _sigma_xx(case: Case, solution: ContactSolution, x: Array) -> Iterator[Array]:
    """sigma_xx along ``x`` at the top and the base of each coating of both bodies."""
    for body, layers in case.layers.items():
        z, side = (0.0, *case.problem.seen_from(body).interfaces), on_body(solution, body)
        ends = list(accumulate(layers, initial=0))
        for begin, end in pairwise(ends):
            yield side.stress(x, 0.0, z[begin], layer=begin)[0, 0]
            yield side.stress(x, 0.0, z[end], layer=end - 1)[0, 0]
