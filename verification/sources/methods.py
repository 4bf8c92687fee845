"""Records of the two numerical methods; each method is imported when it first solves."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from verification.problem.contact import CoatedContact, PrescribedLoad, keywords
from verification.problem.loading import LoadingCurve, Problem
from verification.sources.source import Kind, NumericalParameter, Solver, Source, Style

# Element size on a loading curve, which needs many solves; it leaves 1e-7 of the approach.
CURVE_SIZE = 0.28


def solve_semianalytic(problem: Problem, numerics: Mapping[str, Any] | None = None) -> Any:
    """``problem`` by the semi-analytical method."""
    import semianalytic

    if isinstance(problem, LoadingCurve):
        from verification.sources.loading import loading

        return loading(problem, partial(solve_semianalytic, numerics=numerics))
    solve = semianalytic.solve_prescribed if isinstance(problem, PrescribedLoad) else semianalytic.solve
    return solve(**keywords(problem), **(numerics or {}))


def solve_elements(problem: Problem, numerics: Mapping[str, Any] | None = None) -> Any:
    """``problem`` by finite elements, extrapolated where a layer is incompressible or the base rigid."""
    from verification.sources.extrapolation import extrapolated

    if isinstance(problem, LoadingCurve):
        from verification.sources.loading import loading

        return loading(problem, partial(_elements, {"size": CURVE_SIZE, **(numerics or {})}), limits=True)
    return extrapolated(problem, partial(_elements, numerics or {}))


def _elements(numerics: Mapping[str, Any], problem: CoatedContact | PrescribedLoad) -> Any:
    import fem_reference

    solve = fem_reference.solve_prescribed if isinstance(problem, PrescribedLoad) else fem_reference.solve
    return solve(**keywords(problem), **numerics)


def sharing_pressure(solve: Solver) -> Solver:
    """``solve`` that does not solve anew a problem that differs from the last one in friction alone.

    The pressure does not depend on friction (Goodman): ``with_friction`` of the last solution adds to its
    fields those of the tangential traction. Solutions that lack it are solved each time.
    """
    last: list[tuple[CoatedContact, dict[str, Any], Any]] = []

    def shared(problem: CoatedContact, numerics: Mapping[str, Any]) -> Any:
        for known, given, solution in last:
            same = replace(known, friction=problem.friction) == problem and given == numerics
            if same and hasattr(type(solution), "with_friction"):
                return solution.with_friction(problem.friction)
        last[:] = [(problem, dict(numerics), solve(problem, numerics))]
        return last[0][2]

    return shared


def _wider(times: float, patches: int = 129) -> tuple[str, Mapping[str, Any], float]:
    """A domain ``times`` the default one on patches of the same size."""
    n = 2 * round(patches * times / 2) + 1
    return f"{times:g} times", {"patches": n, "fill": 1.12 * times * (n / (patches * times))}, 1 / times


# All parameters but the size of patches and elements are varied on a coarser grid or mesh, to save time.
SEMIANALYTIC = (
    NumericalParameter(
        "semianalytic",
        "patch size",
        tuple((f"N = {n}", {"patches": n}, 1 / n) for n in (65, 97, 129, 193, 257)),
    ),
    NumericalParameter(
        "semianalytic",
        "conversion",
        tuple((f"{n} points", {"patches": 129, "hankel_points": n}, 1 / n) for n in (512, 1024, 2048, 4096)),
        coated=True,
    ),
    NumericalParameter("semianalytic", "domain", tuple(_wider(times) for times in (1.0, 1.25, 1.5, 2.0))),
    NumericalParameter(
        "semianalytic",
        "iteration",
        tuple((f"{t:.0e}", {"patches": 129, "tolerance": t}, t) for t in (1e-5, 1e-6, 1e-7, 1e-8)),
    ),
)
ELEMENTS = (
    NumericalParameter(
        "fem_reference",
        "element size",
        tuple((f"size {s}", {"size": s}, s) for s in (0.5, 0.36, 0.25, 0.16)),
        order=4.0,
    ),
    NumericalParameter(
        "fem_reference",
        "element order",
        tuple((f"order {p}", {"order": p, "size": 0.25}, 1 / p) for p in (2, 3, 4)),
        order=4.0,
    ),
    NumericalParameter(
        "fem_reference",
        "outer boundary",
        tuple((f"at {d:g}", {"far": d, "size": 0.36}, 1 / d) for d in (125.0, 250.0, 500.0, 1000.0)),
    ),
    NumericalParameter(
        "fem_reference",
        "load balance",
        tuple((f"{t:.0e}", {"load_tolerance": t, "size": 0.36}, t) for t in (1e-3, 1e-4, 1e-5, 1e-6)),
    ),
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
        parameters=SEMIANALYTIC,
        coarse={"patches": 129},
        coarse_stress={"patches": 129},
        fields="boxes",
    ),
    Source(
        "fem_reference",
        Kind.METHOD,
        "finite elements",
        Style("fem", (3.6, 3.0), 1.9),
        solve_elements,
        package="fem_reference",
        parameters=ELEMENTS,
        coarse={"size": 0.25},
        coarse_stress={"size": 0.22},
        fields="mesh",
    ),
)
