"""Registry of the sources, in the order in which the report shows them."""

from itertools import combinations

from verification.problem.loading_curve import Problem
from verification.sources.exact_sources import REFERENCE_SOURCES
from verification.sources.method_sources import METHOD_SOURCES
from verification.sources.source_record import Independence, Kind, Solver, Source, Style

PUBLISHED = "published"  # source of the profiles of a published table
_OTHER = Style("other", (5.0, 1.5, 1.0, 1.5))
SOURCES: dict[str, Source] = {
    source.name: source
    for source in (*METHOD_SOURCES, *REFERENCE_SOURCES, Source(PUBLISHED, Kind.PUBLISHED, PUBLISHED, _OTHER))
}


def _of(*kinds: Kind) -> tuple[str, ...]:
    return tuple(source.name for source in SOURCES.values() if source.kind in kinds)


METHODS = _of(Kind.METHOD)
EXACT = _of(Kind.EXACT)
CLOSED = _of(Kind.CLOSED)
REFERENCES = (*EXACT, *CLOSED)


def solvers(problem: Problem | None = None) -> dict[str, Solver]:
    """The solver of every source by name; with ``problem`` of those that support it."""
    return {
        source.name: source.solve
        for source in SOURCES.values()
        if source.solve is not None and (problem is None or source.supports(problem))
    }


def sources_of(problem: Problem, kind: str = "stress") -> tuple[str, ...]:
    """The sources that give quantities of ``kind`` of ``problem``."""
    return tuple(source.name for source in SOURCES.values() if source.supports(problem, kind))


def independence(between: tuple[str, ...]) -> Independence:
    """Common ground of two sources that are compared."""
    pair = [SOURCES[name] for name in between if name in SOURCES]
    kinds = {source.kind for source in pair}
    if Kind.PUBLISHED in kinds:
        return Independence.PRINT
    if Kind.CLOSED in kinds:
        return Independence.CLOSED
    shared = len({source.equation for source in pair}) < len(pair) and pair[0].equation
    return Independence.EQUATION if shared else Independence.NOTHING


def pairs_of(sources: tuple[str, ...]) -> tuple[tuple[str, str], ...]:
    """Pairs to compare: methods with each other, methods with each reference, references with each other."""
    methods = [name for name in sources if name in METHODS]
    references = [name for name in sources if name not in METHODS]
    against = ((method, reference) for reference in references for method in methods)
    return (*combinations(methods, 2), *against, *combinations(references, 2))
