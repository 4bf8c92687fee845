"""Rigid punch or sphere pressed on a layered half-space to a given contact radius, frictionless.

The equation of ``integral_equation`` is linear once the contact radius is given: with delta on its right side
it is that of a flat punch, P = 2 a E1* kappa delta, kappa = 1 on the homogeneous solid, with delta - x^2/R
that of a sphere, where phi(a) = 0 fixes delta. Lebedev and Ufliand, PMM 22 (1958) 320-326,
for a layer on a rigid base; Hayes, Keer, Herrmann and Mockros, J. Biomechanics 5 (1972) 541-551, who tabulate
kappa.
"""

from dataclasses import dataclass

from verification.problem.array_types import Coatings
from verification.sources.references.integral_equation import Equation


@dataclass(frozen=True)
class Pressed:
    """Flat punch and sphere of one contact radius.

    kappa : stiffness of the flat punch over 2 a E1*.   load, approach : of the sphere, each times its radius
    R [N m, m^2]. The sphere's dW/d delta is the stiffness of the punch.
    """

    kappa: float
    load: float
    approach: float


def pressed(
    a: float,
    coatings: Coatings,
    substrate: tuple[float, float],
    nodes: int = 80,
    panel: int = 16,
    tail: float = 36.0,
) -> Pressed:
    """Punch and sphere of contact radius ``a`` [m]; nodes, panel, tail as of ``integral_equation.solve``.

    Raises ValueError where a is not positive.
    """
    if not a > 0:
        raise ValueError(f"a = {a:g} m; a punch has a positive radius")
    equation = Equation(1.0, ((coatings, substrate),), a, nodes, panel, tail)
    phi, approach, stiffness = equation.at(a)
    return Pressed(stiffness / (2 * a * equation.E_star), equation.carried(a, phi), approach)
