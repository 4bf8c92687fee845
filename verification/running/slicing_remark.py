"""What the slicing of graded coatings changes in a case, as a remark of its result."""

from collections.abc import Iterator, Mapping
from itertools import accumulate, pairwise
from pathlib import Path

import numpy as np

from verification.cases.case_file import Case, parse_case
from verification.problem.array_types import Array
from verification.problem.coated_contact import Solution
from verification.problem.either_body import on_body
from verification.problem.quantity import QUANTITIES, SCALARS
from verification.sources.source_record import Solver
from verification.sources.source_registry import METHODS

METHOD = METHODS[0]
# Uncertainty over the change by half of the sub-layers: in-plane stresses jump with the modulus, so that they
# are of first order; with the factor of safety of Roache.
SLICING = 1.25
REACH, POINTS = 2.0, 201  # of the samples along x, over a


def slicing_remarks(
    case: Case, solutions: Mapping[str, Solution], available: Mapping[str, Solver]
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
        of = QUANTITIES[name].value
        value, changed = of(solution, case.problem), of(other, half.problem)
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


def _sigma_xx(case: Case, solution: Solution, x: Array) -> Iterator[Array]:
    """sigma_xx along ``x`` at the top and the base of each coating of both bodies."""
    for body, layers in case.layers.items():
        z, side = (0.0, *case.problem.seen_from(body).interfaces), on_body(solution, body)
        ends = list(accumulate(layers, initial=0))
        for begin, end in pairwise(ends):
            yield side.stress(x, 0.0, z[begin], layer=begin)[0, 0]
            yield side.stress(x, 0.0, z[end], layer=end - 1)[0, 0]
