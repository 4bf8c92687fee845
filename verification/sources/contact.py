"""Sources that solve a coated contact."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from verification.problem.contact import CoatedContact, Solution

__all__ = ["Solver", "sharing_pressure", "solvers"]

Solver = Callable[[CoatedContact, Mapping[str, Any]], Solution]


def solvers() -> dict[str, Solver]:
    """Every source that can speak about a coated sphere, by name; imported only when a case is run."""
    import fem_reference
    import semianalytic
    from verification.sources.references import integral_equation
    from verification.sources.references.hamilton import Hamilton
    from verification.sources.references.hertz import Hertz

    def method(solve: Callable[..., Any]) -> Solver:
        return lambda problem, numerics: solve(
            radius=problem.radius,
            load=problem.load,
            coatings=problem.coatings,
            substrate=problem.substrate,
            friction=problem.friction,
            **numerics,
        )

    return {
        "semianalytic": method(semianalytic.solve),
        "fem_reference": method(fem_reference.solve),
        "integral_equation": method(integral_equation.solve),
        "hertz": lambda problem, _: Hertz(problem.radius, problem.load, *problem.substrate),
        "hamilton": lambda problem, _: Hamilton(
            problem.radius, problem.load, *problem.substrate, problem.friction
        ),
    }


def sharing_pressure(solve: Solver) -> Solver:
    """``solve``, but a problem that differs from the last one in friction alone is not solved anew.

    The pressure does not depend on friction (Goodman): ``with_friction`` of the last solution adds to its
    fields those of the tangential traction. Solutions that lack it are solved each time.
    """
    last: list[tuple[CoatedContact, dict[str, Any], Any]] = []

    def shared(problem: CoatedContact, numerics: Mapping[str, Any]) -> Solution:
        for known, given, solution in last:
            same = replace(known, friction=problem.friction) == problem and given == numerics
            if same and hasattr(type(solution), "with_friction"):
                found: Solution = solution.with_friction(problem.friction)
                return found
        last[:] = [(problem, dict(numerics), solve(problem, numerics))]
        return last[0][2]

    return shared
