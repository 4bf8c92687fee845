"""Places of the maps: a rigid or elastic ball on one coating, by dimensionless coordinates.

ratio : E1*/E2* of coating and substrate, E1/E2 where both have one nu;   thickness : h/a_h;   nu;
width : a_h/R;   friction : f;   ball : share of the ball in the contact's compliance, E*/E_ball*, 0 rigid.
"""

from dataclasses import dataclass, fields

from verification.problem.coated_contact import CoatedContact

SUBSTRATE, RADIUS = 210e9, 10e-3  # the costs depend on neither
LOGARITHMIC = ("ratio", "thickness", "width")


@dataclass(frozen=True)
class Place:
    """A problem by its coordinates; both bodies and the coating have one ``nu``."""

    ratio: float = 1.0
    thickness: float = 1.0
    nu: float = 0.3
    width: float = 0.03
    friction: float = 0.0
    ball: float = 0.0

    @property
    def problem(self) -> CoatedContact:
        """With a steel's modulus below and a ball of 10 mm."""
        a_h = self.width * RADIUS
        ball = None
        if self.ball:
            ball = (SUBSTRATE * (1 - self.ball) / self.ball, self.nu, ())
        coating = (self.ratio * SUBSTRATE, self.nu, self.thickness * a_h)
        E_star = SUBSTRATE / (1 - self.nu**2) * (1 - self.ball)
        load = 4 * a_h**3 * E_star / (3 * RADIUS)
        return CoatedContact(RADIUS, load, (coating,), (SUBSTRATE, self.nu), self.friction, ball)


COORDINATES = tuple(field.name for field in fields(Place))


def places_of(problem: CoatedContact) -> tuple[Place, ...]:
    """Where ``problem`` lies: one place for each Poisson's ratio that occurs in it.

    Without a coating ``ratio`` is 1 and the thickness is of no importance.
    Raises ValueError where the maps cannot hold it: several coatings, a coated ball.
    """
    if len(problem.coatings) > 1:
        raise ValueError(f"{len(problem.coatings)} coatings; the maps hold one")
    E2, nu2 = problem.substrate
    E1, nu1, h = problem.coatings[0] if problem.coatings else (E2, nu2, problem.a_h)
    share, nus = 0.0, {nu1, nu2}
    if problem.ball is not None:
        E_ball, nu_ball, layers = problem.ball
        if layers:
            raise ValueError("a coated ball; that of the maps is not")
        share = problem.E_star * (1 - nu_ball**2) / E_ball
        nus.add(nu_ball)
    ratio = E1 * (1 - nu2**2) / (E2 * (1 - nu1**2))
    a_h = problem.a_h
    return tuple(
        Place(ratio, h / a_h, nu, a_h / problem.radius, problem.friction, share) for nu in sorted(nus)
    )
