"""Sources that solve a coated contact."""

from collections.abc import Callable, Mapping
from typing import Any

from verification.problem.contact import CoatedContact, Solution

__all__ = ["Solver", "solvers"]

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
