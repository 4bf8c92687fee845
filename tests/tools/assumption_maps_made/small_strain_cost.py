"""Cost of small strains: the contact of a sphere at finite against that at small strain.

Both by ``finite_deformation`` on the same mesh with the same sphere, so that the change is that of the
strains alone. It is of the order a/R for a compressible solid.
"""

from dataclasses import dataclass

from assumption_maps_made.finite_deformation import Deformed, SphereContact
from assumption_maps_made.meridian_elements import Meridian
from verification.problem.coated_contact import CoatedContact
from verification.sources.assumptions.contact_change import FLOOR, Change
from verification.sources.assumptions.strain_cost_of_pair import of_pair


@dataclass(frozen=True)
class Resolution:
    """degree, step, edge, far of ``Meridian``; edge over the lesser of a_h and the top coating."""

    degree: int
    step: float
    edge: float
    far: float


COARSE, FINE = Resolution(3, 1.0, 1e-3, 50.0), Resolution(4, 1.0, 5e-4, 100.0)


def deformed(problem: CoatedContact, resolution: Resolution) -> tuple[Deformed, Deformed]:
    """The contact without friction at small, then at finite strain; lengths over a_h, stresses over E*.

    Raises ValueError for an elastic ball, and where there is no equilibrium.
    """
    if problem.ball is not None:
        raise ValueError("small strains: the model has a rigid ball only")
    a, E_star = problem.a_h, problem.E_star
    coatings = tuple((E / E_star, nu, h / a) for E, nu, h in problem.coatings)
    substrate = problem.substrate[0] / E_star, problem.substrate[1]
    edge = resolution.edge * min([1.0, *(h for _, _, h in coatings[:1])])
    depths = tuple(z / a for z in problem.interfaces)
    mesh = Meridian(depths, resolution.far, resolution.degree, resolution.step, edge)
    load, state, found = problem.load / (E_star * a**2), None, []
    for finite in (False, True):
        contact = SphereContact(mesh, problem.radius / a, load, coatings, substrate, finite)
        state = contact.solve(state)
        found.append(contact.results(state))
    return found[0], found[1]


def _change(small: Deformed, finite: Deformed) -> Change:
    def of_stress(before: float, after: float) -> float:
        return (after - before) / max(abs(before), FLOOR * small.peak_pressure)

    shear = None if small.shear is None or finite.shear is None else of_stress(small.shear, finite.shear)
    return Change(
        contact_radius=finite.contact_radius / small.contact_radius - 1,
        approach=finite.approach / small.approach - 1,
        peak_pressure=finite.peak_pressure / small.peak_pressure - 1,
        tension=of_stress(small.tension, finite.tension),
        shear=shear,
    )


def of_small_strains(problem: CoatedContact) -> tuple[Change, Change]:
    """From small strain to finite strain of neo-Hookean layers, under the same load without friction.

    Radius and stresses are those of the deformed solid, the shear that along the deformed first interface.
    Returns the change, then its uncertainty: the difference from a coarser mesh in half the solid.
    Of an elastic ball as ``of_pair``.
    Raises ValueError for a coated ball, and where there is no equilibrium.
    """
    return of_pair(problem, _of_rigid_ball)


def _of_rigid_ball(problem: CoatedContact) -> tuple[Change, Change]:
    coarse, fine = (_change(*deformed(problem, one)) for one in (COARSE, FINE))

    def apart(one: float | None, other: float | None) -> float | None:
        return None if one is None or other is None else abs(one - other)

    return fine, Change(**{name: apart(value, getattr(coarse, name)) for name, value in vars(fine).items()})
