"""Claims a case makes when its file names none: every quantity on every line, source against source."""

from verification.judging.verdict import Claim
from verification.problem.contact import CoatedContact
from verification.problem.profile import Line, lines_of
from verification.problem.quantity import IN_PLANE, QUANTITIES, SCALARS
from verification.sources.registry import pairs_of, sources_of

# The pressure falls to zero with a vertical tangent, so no method has a meaningful value within a few
# patches of the edge; this fraction of a is left unjudged on the surface.
EDGE = 0.05


def standard_claims(problem: CoatedContact) -> tuple[Claim, ...]:
    """Every quantity on every line, for every pair of the sources that support ``problem``."""
    pairs = pairs_of(sources_of(problem))
    why = "scalars of the contact, from one number each"
    claims = [Claim(name, "contact", pair, QUANTITIES[name].cap, why) for pair in pairs for name in SCALARS]
    why = "the stress a coating cracks or peels by"
    for line in lines_of(problem):
        edge = EDGE if line.name == "surface" else 0.0
        for name in _quantities(line, problem):
            claims += [Claim(name, line.name, pair, QUANTITIES[name].cap, why, edge) for pair in pairs]
    return tuple(claims)


def _quantities(line: Line, problem: CoatedContact) -> tuple[str, ...]:
    if line.name == "surface":
        # sigma_zz = -p and sigma_xz = -f p hold by construction there; the pressure says it all.
        return ("pressure", "sigma_xx", "sigma_yy")
    if line.name == "axis":
        return ("sigma_xx", "sigma_zz", *(("sigma_xz",) if problem.friction else ()))
    return tuple(IN_PLANE)
