"""Claims a case makes when its file names none: every quantity on every line, source against source."""

from verification.judging.verdict import Claim
from verification.problem.coated_contact import CoatedContact
from verification.problem.line_profile import EDGE_LINE, Line, lines_of, oblique_lines
from verification.problem.point_answers import FLAT
from verification.problem.quantity import (
    BALL_PEAKS,
    DISPLACEMENTS,
    IN_PLANE,
    PEAKS,
    QUANTITIES,
    SCALARS,
    SLOPES,
    STRESSES,
)
from verification.sources.source_registry import pairs_of, sources_of

# Over the smaller of p_h and p0, near an edge that is no circle, where the stress has a root: both methods
# together state up to 0.006 in the shipped cases.
EDGE_CAP = 0.01


def standard_claims(problem: CoatedContact) -> tuple[Claim, ...]:
    """Every quantity on every line, no zone left out, for every pair of the sources of ``problem``."""
    if problem.indenter is not None:
        return _of_shape(problem)
    pairs = pairs_of(sources_of(problem))
    why = "numbers of the contact as a whole"
    claims = [
        Claim(name, "contact", pair, QUANTITIES[name].cap, why) for pair in pairs for name in SCALARS + SLOPES
    ]
    why = "the tension a coating cracks by, where each source has it"
    peaks = PEAKS if problem.ball is None else (*PEAKS, *BALL_PEAKS)
    claims += [Claim(name, "contact", pair, QUANTITIES[name].cap, why) for pair in pairs for name in peaks]
    why = "the stress a coating cracks or peels by"
    for line in lines_of(problem):
        for name in _quantities(line, problem):
            claims += [Claim(name, line.name, pair, QUANTITIES[name].cap, why) for pair in pairs]
    return (*claims, *_off_plane(problem, pairs))


def _of_shape(problem: CoatedContact) -> tuple[Claim, ...]:
    """For an indenter that is no sphere: numbers of the contact, and every quantity on every line, where
    the lines have points (``line_sampling.CLEAR``), with a cap of its own on the surface near the edge."""
    why = "numbers of the contact as a whole"
    claims = [
        Claim(name, "contact", pair, QUANTITIES[name].cap, why)
        for pair in pairs_of(sources_of(problem, "scalar"))
        for name in SCALARS
    ]
    pairs = pairs_of(sources_of(problem))
    for line in lines_of(problem):
        at_edge = line.name == EDGE_LINE
        why = "the stress beside the contact edge" if at_edge else "the stress a coating cracks or peels by"
        for name in _quantities(line, problem):
            cap = EDGE_CAP if at_edge else QUANTITIES[name].cap
            claims += [Claim(name, line.name, pair, cap, why) for pair in pairs]
    return (*claims, *_off_plane(problem, pairs))


def _off_plane(problem: CoatedContact, pairs: tuple[tuple[str, str], ...]) -> list[Claim]:
    claims = []
    why = "all components, where none vanishes by symmetry"
    displaced = pairs_of(sources_of(problem, "displacement"))
    for line in oblique_lines(problem):
        if line.place != "oblique surface":
            claims += [Claim(n, line.name, pair, QUANTITIES[n].cap, why) for n in STRESSES for pair in pairs]
        claims += [
            Claim(n, line.name, pair, QUANTITIES[n].cap, why) for n in DISPLACEMENTS for pair in displaced
        ]
    return claims


def _quantities(line: Line, problem: CoatedContact) -> tuple[str, ...]:
    sheared = ("sigma_xz",) if problem.friction else ()
    if line.place in ("surface", EDGE_LINE):
        # sigma_zz = -p holds by construction there; the pressure says it all.
        pressure = ("pressure",) if line.body == FLAT else ()
        return (*pressure, "sigma_xx", "sigma_yy", *sheared)
    if line.place == "axis":
        return ("sigma_xx", "sigma_zz", *sheared)
    return tuple(IN_PLANE)
