"""Records of the exact reference with the closed forms of uncoated contacts."""

from collections.abc import Mapping
from typing import Any

from verification.problem.contact import CoatedContact, PrescribedLoad, keywords
from verification.problem.loading import LoadingCurve, Problem
from verification.sources.source import Kind, Source, Style

PACKAGE = "verification.sources.references"


def solve_exactly(problem: Problem, numerics: Mapping[str, Any] | None = None) -> Any:
    """``problem`` by the integral equation of the contact, or by Hankel transforms of a uniform disc."""
    from verification.sources.references import integral_equation, uniform_disc

    if isinstance(problem, LoadingCurve):
        from verification.sources.loading import exact_loading

        return exact_loading(problem)
    if isinstance(problem, PrescribedLoad):
        return uniform_disc.solve_prescribed(**keywords(problem), **(numerics or {}))
    return integral_equation.solve(**keywords(problem), **(numerics or {}))


def hertz(problem: CoatedContact, numerics: Mapping[str, Any] | None = None) -> Any:
    """Hertz's contact of the substrate."""
    from verification.sources.references.hertz import Hertz

    return Hertz(problem.radius, problem.load, *problem.substrate)


def hamilton(problem: CoatedContact, numerics: Mapping[str, Any] | None = None) -> Any:
    """Hamilton's sliding contact of the substrate."""
    from verification.sources.references.hamilton import Hamilton

    return Hamilton(problem.radius, problem.load, *problem.substrate, problem.friction)


def _exact_accepts(problem: Problem, kind: str) -> bool:
    """No sliding disc, whose stress is infinite at the rim; no displacement under a contact."""
    if isinstance(problem, PrescribedLoad):
        return not problem.friction
    return kind != "displacement"


def _uncoated(problem: Problem, *, sliding: bool) -> bool:
    return isinstance(problem, CoatedContact) and problem.homogeneous and (problem.friction > 0) is sliding


# The exact curve lies below the methods' as a broad grey band.
REFERENCE_SOURCES = (
    Source(
        "integral_equation",
        Kind.EXACT,
        "integral equation",
        Style("exact", (), 5.0, 0.35, "+"),
        solve_exactly,
        _exact_accepts,
        PACKAGE,
    ),
    Source(
        "hertz",
        Kind.CLOSED,
        "Hertz",
        Style("hertz", (1.0, 1.4), 1.8),
        hertz,
        lambda problem, kind: _uncoated(problem, sliding=False) and kind != "displacement",
        PACKAGE,
    ),
    Source(
        "hamilton",
        Kind.CLOSED,
        "Hamilton",
        Style("hertz", (1.0, 1.4), 1.8),
        hamilton,
        lambda problem, kind: _uncoated(problem, sliding=True) and kind != "displacement",
        PACKAGE,
    ),
)
