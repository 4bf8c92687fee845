"""Records of the two numerical methods; each method is imported when it first solves."""

from collections import deque
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from verification.problem.coated_contact import CoatedContact, PrescribedLoad, keywords
from verification.problem.loading_curve import LoadingCurve, Problem
from verification.sources.source_record import RESPONSE, Kind, NumericalParameter, Solver, Source, Style

# Element size on a loading curve, which needs many solves; it leaves 1e-7 of the approach.
CURVE_SIZE = 0.28
Levels = tuple[tuple[str, Mapping[str, Any], float], ...]


def solve_semianalytic(problem: Problem, numerics: Mapping[str, Any] | None = None) -> Any:
    """``problem`` by the semi-analytical method."""
    import semianalytic

    if isinstance(problem, LoadingCurve):
        from verification.sources.loading_solution import loading

        return loading(problem, partial(solve_semianalytic, numerics=numerics))
    solve = semianalytic.solve_prescribed if isinstance(problem, PrescribedLoad) else semianalytic.solve
    return solve(**keywords(problem), **(numerics or {}))


def solve_elements(problem: Problem, numerics: Mapping[str, Any] | None = None) -> Any:
    """``problem`` by finite elements, extrapolated where a layer is incompressible or the base rigid."""
    from verification.sources.limit_extrapolation import extrapolated

    if isinstance(problem, CoatedContact) and problem.indenter is not None:
        return _shape_by_elements(problem, numerics or {})
    if isinstance(problem, LoadingCurve):
        from verification.sources.loading_solution import loading

        return loading(problem, partial(_elements, {"size": CURVE_SIZE, **(numerics or {})}), limits=True)
    return extrapolated(problem, partial(_elements, numerics or {}))


def _shape_by_elements(problem: CoatedContact, numerics: Mapping[str, Any]) -> Any:
    """An indenter that is no sphere: elements correct a pressure of patches until their gap vanishes."""
    import fem_reference

    start = solve_semianalytic(problem, {"patches": 129, "estimate_uncertainty": False})
    given = {name: value for name, value in keywords(problem).items() if name != "ball"}
    return fem_reference.solve_shape(start=start.pressure, **given, **numerics)


def _elements(numerics: Mapping[str, Any], problem: CoatedContact | PrescribedLoad) -> Any:
    import fem_reference

    solve = fem_reference.solve_prescribed if isinstance(problem, PrescribedLoad) else fem_reference.solve
    return solve(**keywords(problem), **numerics)


def sharing_pressure(solve: Solver, kept: int = 1) -> Solver:
    """``solve`` that does not solve anew a problem that differs from an earlier one in friction alone.

    The pressure does not depend on friction (Goodman): ``with_friction`` of the earlier solution adds to its
    fields those of the tangential traction. Solutions that lack it are solved each time.
    kept : number of solutions that are kept, of a problem and its numerics each.
    """
    earlier: deque[tuple[CoatedContact, dict[str, Any], Any]] = deque(maxlen=kept)

    def shared(problem: CoatedContact, numerics: Mapping[str, Any] | None = None) -> Any:
        for known, given, solution in earlier:
            same = replace(known, friction=problem.friction) == problem and given == (numerics or {})
            if same and hasattr(type(solution), "with_friction"):
                return solution.with_friction(problem.friction)
        solution = solve(problem, numerics)
        earlier.append((problem, dict(numerics or {}), solution))
        return solution

    return shared


def _varied(keyword: str, label: str, values: tuple[Any, ...], **fixed: Any) -> Levels:
    """Levels of a parameter that is 1/step."""
    return tuple((label.format(v), {keyword: v, **fixed}, 1 / v) for v in values)


def _reduced(keyword: str, label: str, values: tuple[float, ...], **fixed: Any) -> Levels:
    """Levels of a parameter that is the step."""
    return tuple((label.format(v), {keyword: v, **fixed}, v) for v in values)


# The refinement studies of the patches are in `credibility.accuracy_study`. All parameters but the size of
# the elements are varied on a coarser mesh, to save time.
_FEM = partial(NumericalParameter, "fem_reference")
ELEMENTS = (
    _FEM("element size", _reduced("size", "size {}", (0.36, 0.27, 0.19, 0.12), order=4), order=4.0),
    _FEM("element order", _varied("order", "order {}", (2, 3, 4), size=0.19), order=4.0),
    _FEM("outer boundary", _varied("far", "at {:g}", (125.0, 250.0, 500.0, 1000.0), size=0.27)),
    _FEM("load balance", _reduced("load_tolerance", "{:.0e}", (1e-5, 1e-6, 1e-7, 1e-8), size=0.27)),
)
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
        parameters=ELEMENTS,
        coarse={"size": 0.2},
        coarse_stress={"size": 0.17},
        fields="mesh",
    ),
)
