"""Records of the exact reference with the closed forms of uncoated contacts."""

from collections.abc import Mapping
from functools import partial
from typing import Any

from verification.problem.coated_contact import CoatedContact, PrescribedLoad, keywords
from verification.problem.loading_curve import LoadingCurve, Problem
from verification.sources.source_record import RESPONSE, Kind, Source, Style

CODE = "verification.sources.references"
# Fields of a contact that the references know: what has another one is left to the methods.
KNOWN = {"radius", "load", "coatings", "substrate", "friction", "ball", "indenter"}


def solve_exactly(problem: Problem, numerics: Mapping[str, Any] | None = None) -> Any:
    """``problem`` by the integral equation of the contact, or by Hankel transforms of a uniform disc."""
    from verification.sources.references import integral_equation, uniform_disc

    if isinstance(problem, LoadingCurve):
        from verification.sources.loading_solution import exact_loading

        return exact_loading(problem)
    if isinstance(problem, PrescribedLoad):
        return uniform_disc.solve_prescribed(**keywords(problem), **(numerics or {}))
    return integral_equation.solve(**keywords(problem), **(numerics or {}))


def hertz(problem: CoatedContact, numerics: Mapping[str, Any] | None = None) -> Any:
    """Hertz's contact of the substrates, with friction Hamilton's."""
    from verification.sources.references.hertz import Hertz
    from verification.sources.references.hertz_ellipse import pressed_ellipsoid

    ball = None if problem.ball is None else problem.ball[:2]
    if problem.indenter is not None:
        along, across = problem.indenter[1]
        return pressed_ellipsoid(along, across, problem.load, *problem.substrate, ball)
    return Hertz(problem.radius, problem.load, *problem.substrate, problem.friction, ball=ball)


def _exact_accepts(problem: Problem, kind: str) -> bool:
    """No sliding disc, whose stress is infinite at the rim."""
    if isinstance(problem, CoatedContact):
        return problem.indenter is None and keywords(problem).keys() <= KNOWN
    return not (isinstance(problem, PrescribedLoad) and problem.friction)


def _closed_accepts(problem: Problem, kind: str, *, sliding: bool) -> bool:
    if not isinstance(problem, CoatedContact) or keywords(problem).keys() - KNOWN:
        return False
    if problem.indenter is not None:
        ellipsoid = problem.indenter[0] == "ellipsoid" and kind == "scalar"
        return ellipsoid and problem.homogeneous and not (problem.friction or sliding)
    return problem.homogeneous and (problem.friction > 0) is sliding


_EXACT, _CLOSED = Style("exact", (), 5.0, 0.35, "+"), Style("hertz", (1.0, 1.4), 1.8, marker="s")
_smooth, _sliding = partial(_closed_accepts, sliding=False), partial(_closed_accepts, sliding=True)
# The exact curve lies below the methods' as a broad grey band.
REFERENCE_SOURCES = (
    Source(
        "integral_equation",
        Kind.EXACT,
        "integral equation",
        _EXACT,
        solve_exactly,
        _exact_accepts,
        CODE,
        RESPONSE,
    ),
    Source("hertz", Kind.CLOSED, "Hertz", _CLOSED, hertz, _smooth, CODE),
    Source("hamilton", Kind.CLOSED, "Hamilton", _CLOSED, hertz, _sliding, CODE),
)
