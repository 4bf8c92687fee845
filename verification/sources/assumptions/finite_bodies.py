"""Bodies of finite size in place of half-spaces: a ball of the sphere's radius, a disc bonded to a support.

Ball: series of Legendre polynomials, see ``ball``. Disc: layers on a rigid solid, whose rim is far away;
it is as thick as the ball's radius, which ball-on-disc tests have (a ball of 10 mm on a disc of 5 mm). Both
contacts, of the bodies and of half-spaces, have the gap of a sphere and are solved by ``integral_equation``.

A rigid ball on a homogeneous disc of thickness t: the approach changes by a/t, radius and peak pressure by
(a/t)^3; an elastic ball adds the changes of the order a/R that ``ball`` states.
"""

from collections.abc import Mapping
from dataclasses import astuple, replace
from functools import partial
from typing import Any

from verification.problem.coated_contact import CoatedContact, keywords
from verification.sources.assumptions.contact_change import (
    RESOLUTION,
    Change,
    change_between,
    half_spaces,
    require_thick,
)
from verification.sources.assumptions.elastic_ball import ElasticBall
from verification.sources.references import integral_equation
from verification.sources.references.integral_equation import SPHERE

THICKNESS = 1.0  # of the disc with its coatings, over the ball's radius
RIGID = 1e9  # modulus of the support over that of the disc
# Fine and coarse; what the quadratures leave is mostly common to both contacts.
RESOLUTIONS: tuple[dict[str, Any], ...] = (RESOLUTION, {"nodes": 30, "panel": 6, "tail": 13.5})
ROUNDING = 1e-8  # of the root for the contact radius, of the support's modulus


def of_half_spaces(problem: CoatedContact, thickness: float = THICKNESS) -> tuple[Change, Change]:
    """From half-spaces to the ball itself and a disc of ``thickness`` over R, both with the sphere's gap.

    Returns the change, then its uncertainty: twice its difference from one with nodes and wavenumbers fewer
    by a quarter. The friction of ``problem`` leaves the pressure unchanged in both contacts.
    Raises ValueError where the coatings are as thick as the disc, an outer one is thinner than ``THINNEST``,
    and as ``integral_equation`` does.
    """
    require_thick(problem)
    fine, coarse = (change_at(problem, thickness, resolution) for resolution in RESOLUTIONS)
    uncertainty: list[Any] = [
        None if one is None else 2 * abs(one - other) + ROUNDING
        for one, other in zip(astuple(fine), astuple(coarse), strict=True)
    ]
    return fine, Change(*uncertainty)


def change_at(problem: CoatedContact, thickness: float, resolution: Mapping[str, Any]) -> Change:
    """As ``of_half_spaces``, with the numerical parameters ``resolution`` of ``integral_equation.solve``."""
    solve = partial(integral_equation.solve, gap=SPHERE, estimate_uncertainty=False, **resolution)
    beyond = None
    if problem.ball is not None:
        E, nu, coatings = problem.ball
        beyond = ElasticBall(problem.radius, (coatings, (E, nu))).beyond_half_space
    disc = on_disc(problem, thickness * problem.radius)
    return change_between(half_spaces(problem, SPHERE, **resolution), solve(**keywords(disc), beyond=beyond))


def on_disc(problem: CoatedContact, thickness: float) -> CoatedContact:
    """The same contact on a disc of ``thickness`` [m], coatings included, bonded to a rigid support.

    Raises ValueError where the coatings are as thick as the disc.
    """
    coated = sum(h for _, _, h in problem.coatings)
    if coated >= thickness:
        raise ValueError(f"coatings of {coated:g} m on a disc of {thickness:g} m; make the disc thicker")
    E, nu = problem.substrate
    layers = (*problem.coatings, (E, nu, thickness - coated))
    return replace(problem, coatings=layers, substrate=(RIGID * E, nu))
