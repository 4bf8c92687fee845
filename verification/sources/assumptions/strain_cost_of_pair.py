"""Cost of small strains for an elastic ball, from the costs for each of the two bodies under a rigid sphere.

To the first order in a/R the displacements beyond Hooke's of flat and ball add up. Those of each are what a
rigid sphere causes under the same pressure, but for the slope r/R of the undeformed ball, which acts by

    int p (r/R) u_r dA = -(1 - 2 nu)(1 + nu) W^2 / (4 pi E R),   E r u_r = -(1 - 2 nu)(1 + nu) int_0^r p s ds

(u_r of a homogeneous ball) on the approach alone, since only W enters. With s, the ball's share of the
curvature 1/R,

    Delta = (1 - s) Delta_flat(R/(1 - s)) + s Delta_ball(R/s),     s = 3 W R / (4 E_ball* a^3),
    delta Delta_delta : + (1 - 2 nu)(1 + nu) W / (2 pi E R).

s is E*/E_ball* uncoated, where all of this is exact to the first order. Under a coating the pressure is not
that of a paraboloid any more; twice the distance of a^3 from Hertz' is stated as uncertainty.
"""

from collections.abc import Callable
from math import pi
from typing import Any

from verification.problem.coated_contact import CoatedContact, keywords
from verification.sources.assumptions.contact_change import SCALARS, Change, require_thick
from verification.sources.references import integral_equation

RESOLUTION: dict[str, Any] = {"nodes": 30, "panel": 6, "tail": 13.5}
LEAST = 1e-4  # share of a body that deforms; the cost of a stiffer one goes with the square of its share
SAFETY = 2.0  # of the uncertainty by the shape of the pressure; the approach needs 0.8 of it without

OfRigid = Callable[[CoatedContact], tuple[Change, Change]]


def of_pair(problem: CoatedContact, of_rigid: OfRigid) -> tuple[Change, Change]:
    """Change with uncertainty, by ``of_rigid`` of contacts of rigid balls; of an elastic ball no stresses.

    Raises ValueError for a coated ball, and as ``of_rigid`` and ``integral_equation`` do.
    """
    if problem.ball is None:
        return of_rigid(problem)
    E, nu, layers = problem.ball
    if layers:
        raise ValueError("a coated ball; the model has one without coating")
    require_thick(problem)
    exact = integral_equation.solve(**keywords(problem), estimate_uncertainty=False, **RESOLUTION)
    W, R, a = problem.load, problem.radius, exact.contact_radius
    share = min(3 * W * R * (1 - nu**2) / (4 * E * a**3), 1.0)
    found = [
        (part, *of_rigid(CoatedContact(R / part, W, coatings, substrate, problem.friction)))
        for part, coatings, substrate in (
            (1 - share, problem.coatings, problem.substrate),
            (share, (), (E, nu)),
        )
        if part > LEAST
    ]
    apart = SAFETY * abs(1 - (problem.a_h / a) ** 3)
    change, uncertainty = {}, {}
    for name in SCALARS:
        parts = [part * _known(one, name) for part, one, _ in found]
        change[name] = sum(parts)
        own = sum(part * _known(U, name) for part, _, U in found)
        uncertainty[name] = own + apart * sum(map(abs, parts))
    change["approach"] += (1 - 2 * nu) * (1 + nu) * W / (2 * pi * E * R) / exact.approach
    return Change(**change, tension=None, shear=None), Change(**uncertainty, tension=None, shear=None)


def _known(change: Change, name: str) -> float:
    value = getattr(change, name)
    if value is None:
        raise ValueError("the model had no answer near this problem")
    return float(value)
