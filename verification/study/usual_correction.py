"""Contact with an elastic ball against the usual correction of the numbers of a rigid one.

The usual correction takes the ball into account by E* of the substrates alone: a, p0 and stresses are those
over the scales a_h, p_h of the coated flat under a rigid sphere, at the same h/a_h and E1/E2, with

    1/E* = (1 - nu_f^2)/E_f + (1 - nu_b^2)/E_b

in the scales. It is exact for uncoated bodies and for a rigid ball. By the exact reference, nu = 0.3.
"""

from dataclasses import dataclass, replace

import numpy as np

from verification.problem.coated_contact import CoatedContact
from verification.sources.exact_sources import solve_exactly

__all__ = ["FRICTION", "BallCurve", "curves"]

COATINGS = (4.0, 0.25)  # E1/E2 of the coating on the flat
THICKNESSES = (0.1, 0.5, 1.0)  # h / a_h
FRICTION = 0.25
QUANTITIES = ("p0 / p_h", "a / a_h", "sigma_xx(-a) / p_h")


@dataclass(frozen=True)
class BallCurve:
    """``value`` of ``quantity`` over ``ratio`` = E_ball/E_flat; ``usual`` is that by the usual correction.

    coating : E1/E2.   thickness : h/a_h.
    """

    quantity: str
    coating: float
    thickness: float
    ratio: tuple[float, ...]
    value: tuple[float, ...]
    usual: float


def curves(points: int = 13) -> tuple[BallCurve, ...]:
    """Curves of peak pressure, contact radius, tension at the trailing edge; E_ball/E_flat from 0.1 to 100.

    points : of each curve.
    """
    ratio = np.geomspace(0.1, 100, points).tolist()
    found = []
    for coating in COATINGS:
        for thickness in THICKNESSES:
            values = [_numbers(coating, thickness, r) for r in ratio]
            for i, (name, usual) in enumerate(
                zip(QUANTITIES, _numbers(coating, thickness, None), strict=True)
            ):
                along = tuple(value[i] for value in values)
                found.append(BallCurve(name, coating, thickness, tuple(ratio), along, usual))
    return tuple(found)


def _numbers(coating: float, thickness: float, ratio: float | None) -> tuple[float, float, float]:
    """p0/p_h, a/a_h and sigma_xx(-a, 0, 0)/p_h; ``ratio`` None is the rigid ball."""
    E, nu = 210e9, 0.3
    bare = CoatedContact(10e-3, 20.0, (), (E, nu), FRICTION, None if ratio is None else (ratio * E, nu, ()))
    problem = replace(bare, coatings=((coating * E, nu, thickness * bare.a_h),))
    found = solve_exactly(problem, {"estimate_uncertainty": False})
    a = found.contact_radius
    tension = found.stress(np.array([-a]), 0.0, 0.0, layer=0)[0, 0, 0]
    return found.peak_pressure / bare.p_h, a / bare.a_h, float(tension) / bare.p_h
