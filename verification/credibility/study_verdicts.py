"""Verdicts on the parts of the semi-analytical method: errors against exact solutions, beside their limits.

Patches alone, patches with a corrected edge, given pressures on a disc, ellipses, influence coefficients.
A limit on an error holds on the finest grid of a study; one on an order holds over its grids. With d the side
of a patch, d/a = 0.009 at 257 patches:

    staircase    of first order in the pressure, of second in what it integrates: 0.1 d/a, (d/a)^2 / 3
    its radius   a patch along an edge is loaded or not: d/4
    corrected    p0 and approach 0.03 (d/a)^2, radius and stress 0.1 (d/a)^2, pressure, steep at the edge, 0.3
    plain        the conversion errs by 0.4 % at the loaded patch, and more far away
    discs        the quadratures of rings and tables promise 1e-8; patches carry a step of the pressure to
                 second order, and a pressure that falls to zero to third; between patch centres a pressure
                 is interpolated to third order, (d/a)^3 = 4e-6 on 129 patches
    convolution  DC-FFT is the sum over patches but for rounding
    ellipses     as corrected, on 129 patches
    iterations   six on patches alone; Polonsky and Keer's own iteration takes ten times as many
    grids        a change on refining by less than a third says little of the error that is left
"""

from collections.abc import Iterable

import numpy as np

from verification.credibility.exact_errors import ExactError
from verification.credibility.refinement_studies import Refinement
from verification.judging.invariant_verdict import Invariant, absent, decide
from verification.judging.invariants.influence_error import BOUND
from verification.judging.outcome import Outcome

CORRECTED = "split conversion, corrected edge"
# Patches alone: influence coefficients, DC-FFT, conjugate gradients against the exact solution.
STAIRCASE = "split conversion, staircase edge"
PLAIN = "plain conversion, staircase edge"
SOURCE = "semianalytic"
EXACT = "error against the exact solution"


# By quantity: the largest error on 257 patches a side, the power of 257/patches by which it may be larger on
# fewer, the least order.
LIMITS: dict[str, dict[str, tuple[float, int, float | None]]] = {
    CORRECTED: {
        "p0": (2e-6, 2, 1.5),
        "a": (1e-5, 2, None),
        "approach": (2e-6, 2, None),
        "pressure": (2e-5, 2, None),
        "stress": (1e-5, 2, None),
    },
    STAIRCASE: {
        "p0": (3e-5, 2, 1.5),
        "a": (2.2e-3, 1, None),
        "approach": (3e-5, 2, 1.5),
        "pressure": (2e-3, 1, 0.8),
        "stress": (1e-4, 2, 1.5),
    },
    PLAIN: {
        "p0": (2e-3, 0, None),
        "a": (5e-3, 0, None),
        "approach": (1e-2, 0, None),
        "pressure": (5e-3, 0, 0.8),
        "stress": (5e-3, 0, None),
    },
}
RINGS, PATCHES, ROUNDING = 1e-8, 1e-6, 1e-13
DISCS = {
    "stress, surface": RINGS,
    "stress, inside": RINGS,
    "displacement": RINGS,
    "central deflection": 2 * PATCHES,
    "deflection on a quarter": 2 * PATCHES,
    "stress of patches": 10 * PATCHES,
    "stress on a plane": PATCHES,
    "displacement on a plane": PATCHES,
}
OTHERS = {
    "influence coefficients": BOUND,
    "convolution": ROUNDING,
    "convolution on a quarter": ROUNDING,
    "peak pressure": 1e-5,
    "contact radius": 2e-5,
    "approach": 5e-6,
    "load": 5e-6,
}
COUNTS = {"iterations": 12, "ratio of patches": 0.75}


def verdicts(
    refinements: Iterable[Refinement] = (), errors: Iterable[ExactError] = (), failures: Iterable[str] = ()
) -> tuple[Invariant, ...]:
    """A verdict on each part of the method: the error of its study is below its limit."""
    found: list[Invariant] = []
    for study in refinements:
        if study.method == SOURCE and study.setting in LIMITS:
            found += _of_refinement(study)
    for one in errors:
        name = f"{one.solid}: {'disc, ' * (one.quantity in DISCS)}{one.pressure}: {one.quantity}"
        law = "below its limit" if one.quantity in COUNTS else EXACT
        found.append(_below(name, one.error, (DISCS | OTHERS | COUNTS)[one.quantity], law))
    found += [
        absent(text.partition(":")[0], SOURCE, text)
        for text in failures
        if not text.startswith("fem_reference")
    ]
    return tuple(found)


def _of_refinement(one: Refinement) -> list[Invariant]:
    name, limits = f"{one.solid}: {one.setting}", LIMITS[one.setting]
    if one.failure or not one.levels:
        return [absent(name, SOURCE, one.failure or f"{name}: nothing was computed")]
    last = one.levels[-1]
    coarser = 257 / last.resolution
    found = [
        _below(f"{name}: {q}, {last.name}", last.errors[q], limit * coarser**power)
        for q, (limit, power, _) in limits.items()
    ]
    for q, (_, _, least) in limits.items():
        if least is None or len(one.levels) < 3:
            continue
        order, label = one.order(q), f"{name}: order of {q}"
        if order is None:
            found.append(Invariant(label, SOURCE, None, None, Outcome.DISAGREES, "the error does not fall"))
            continue
        outcome = Outcome.AGREES if order >= least else Outcome.DISAGREES
        message = f"order {order:.2f}, at least {least:g} is required"
        # as a residual: the side of a patch at this order over that at the least one
        found.append(
            Invariant(label, SOURCE, least, order, outcome, message, cap=np.inf, points=len(one.levels))
        )
    return found


def _below(name: str, error: float, limit: float, law: str = EXACT) -> Invariant:
    return decide(name, SOURCE, law, error, limit, cap=np.inf)
