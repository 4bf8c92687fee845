"""Records of the two numerical methods; each method is imported when it first solves."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from verification.problem.coated_contact import CoatedContact, PrescribedLoad, keywords
from verification.problem.loading_curve import LoadingCurve, Problem
from verification.sources.source_record import RESPONSE, Kind, Solver, Source, Style

# Element size on a loading curve, which needs many solves; it leaves 1e-7 of the approach.
CURVE_SIZE = 0.28


def solve_semianalytic(problem: Problem, numerics: Mapping[str, Any] | None = None) -> Any:
    """``problem`` by the semi-analytical method."""
    import semianalytic

    if isinstance(problem, LoadingCurve):
        from verification.sources.loading_solution import loading

        return loading(problem, partial(solve_semianalytic, numerics=numerics))
    solve = semianalytic.solve_prescribed if isinstance(problem, PrescribedLoad) else semianalytic.solve
    given = {"load": None} if "approach" in (numerics or {}) else {}  # which is that of the load
    return solve(**keywords(problem) | given, **(numerics or {}))


def solve_elements(problem: Problem, numerics: Mapping[str, Any] | None = None) -> Any:
    """``problem`` by finite elements, extrapolated where a layer is incompressible."""
    from verification.sources.limit_extrapolation import extrapolated, short_of_limit

    if isinstance(problem, CoatedContact) and problem.indenter is not None:
        return _elements(numerics or {}, problem)
    if isinstance(problem, LoadingCurve):
        from verification.sources.loading_solution import loading

        return loading(problem, partial(_elements, {"size": CURVE_SIZE, **(numerics or {})}), limits=True)
    given = dict(numerics or {})
    own = given.keys() & {"quality", "size"}
    if isinstance(problem, PrescribedLoad) and short_of_limit(problem, 1) != problem and not own:
        given["size"] = 0.08  # the smallest: the extrapolation adds up the uncertainties of its solutions
    return extrapolated(problem, partial(_elements, given))


def _elements(numerics: Mapping[str, Any], problem: CoatedContact | PrescribedLoad) -> Any:
    import fem_reference

    solve: Any = fem_reference.solve
    if isinstance(problem, PrescribedLoad):
        solve = fem_reference.solve_prescribed
    elif problem.indenter is not None:
        solve = fem_reference.solve_shape
    return solve(**keywords(problem), **numerics)


def sharing_pressure(solve: Solver) -> Solver:
    """``solve`` that does not solve anew a problem that differs from the last one in friction alone.

    The pressure does not depend on friction (Goodman): ``with_friction`` of the earlier solution adds to its
    fields those of the tangential traction. Solutions that lack it are solved each time.
    """
    last: list[tuple[CoatedContact, dict[str, Any], Any]] = []

    def shared(problem: CoatedContact, numerics: Mapping[str, Any] | None = None) -> Any:
        for known, given, solution in last:
            same = replace(known, friction=problem.friction) == problem and given == (numerics or {})
            if same and hasattr(type(solution), "with_friction"):
                return solution.with_friction(problem.friction)
        solution = solve(problem, numerics)
        last[:] = [(problem, dict(numerics or {}), solution)]
        return solution

    return shared


# Coarse numerics whose uncertainty is below the caps; stresses and thin coatings need smaller elements.
METHOD_SOURCES = (
    Source(
        "semianalytic",
        Kind.METHOD,
        "semi-analytical",
        Style("semi"),
        solve_semianalytic,
        package="semianalytic",
        equation=RESPONSE,
        coarse={"patches": 129},
        coarse_stress={"patches": 129},
        fields="boxes",
    ),
    Source(
        "fem_reference",
        Kind.METHOD,
        "finite elements",
        Style("fem", (3.6, 3.0), 1.9, marker="^"),
        solve_elements,
        package="fem_reference",
        coarse={"size": 0.2},
        coarse_stress={"size": 0.17},
        fields="plane",
    ),
)
