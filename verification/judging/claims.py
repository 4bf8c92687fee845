"""Claims a case makes when its file names none: every quantity on every line, source against source."""

from verification.judging.verdict import Claim
from verification.problem.contact import CoatedContact
from verification.problem.profile import SCALARS, Line, lines_of
from verification.sources.registry import METHODS

__all__ = ["CAPS", "EDGE", "LINE_CAP", "sources_of", "standard_claims"]


# Caps as fractions of the scale of each comparison: the value itself for the scalars, p_h for the lines.
CAPS = {"peak_pressure": 1e-3, "contact_radius": 5e-3, "approach": 1e-3}


LINE_CAP = 5e-3


# The pressure falls to zero with a vertical tangent, so no method has a meaningful value within a few
# patches of the edge; this fraction of a is left unjudged on the surface.
EDGE = 0.05


def sources_of(problem: CoatedContact) -> tuple[str, ...]:
    """Whatever speaks about a problem: both methods, then every reference that holds for it."""
    closed = ("hamilton" if problem.friction else "hertz",) if problem.homogeneous else ()
    return (*METHODS, "integral_equation", *closed)


def standard_claims(problem: CoatedContact) -> tuple[Claim, ...]:
    """Every quantity on every line, method against method, then against every reference."""
    sources = sources_of(problem)
    pairs = [METHODS, *((method, reference) for reference in sources[2:] for method in METHODS)]
    pairs += [("integral_equation", closed) for closed in sources[3:]]
    claims = [
        Claim(name, "contact", pair, CAPS[name], "scalars of the contact, from one number each")
        for pair in pairs
        for name in SCALARS
    ]
    for line in lines_of(problem):
        for quantity in _quantities(line, problem):
            edge = EDGE if line.name == "surface" else 0.0
            claims += [
                Claim(quantity, line.name, pair, LINE_CAP, "the stress a coating cracks or peels by", edge)
                for pair in pairs
            ]
    return tuple(claims)


def _quantities(line: Line, problem: CoatedContact) -> tuple[str, ...]:
    if line.name == "surface":
        # sigma_zz = -p and sigma_xz = -f p hold by construction there; the pressure says it all.
        return ("pressure", "sigma_xx", "sigma_yy")
    if line.name == "axis":
        return ("sigma_xx", "sigma_zz", *(("sigma_xz",) if problem.friction else ()))
    return ("sigma_xx", "sigma_yy", "sigma_zz", "sigma_xz")
