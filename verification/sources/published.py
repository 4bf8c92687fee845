"""Sources that solve the problem of a published table."""

from collections.abc import Callable
from dataclasses import fields
from functools import partial
from typing import Any

from verification.problem.contact import CoatedContact, PrescribedLoad, Solution
from verification.problem.loading import LoadingCurve, Problem
from verification.sources.limits import towards_limits
from verification.sources.loading import Loading, exact_loading, loading
from verification.sources.registry import REFERENCE

__all__ = ["CURVE_SIZE", "Solver", "solvers"]

Solver = Callable[[Any], Solution | Loading]


# Of the elements on a loading curve, which is solved many times over: it leaves 1e-7 of the approach.
CURVE_SIZE = 0.28


def solvers() -> dict[str, Solver]:
    """Both methods and the exact reference, by name; imported only when a case is run."""
    import fem_reference
    import semianalytic
    from verification.sources.references import integral_equation, uniform_disc

    # What the methods return has the face of a Solution, with float arrays of any width.
    def semi(problem: Problem) -> Any:
        if isinstance(problem, LoadingCurve):
            return loading(problem, semi)
        if isinstance(problem, PrescribedLoad):
            return semianalytic.solve_prescribed(**_arguments(problem))
        return semianalytic.solve(**_arguments(problem))

    def elements(problem: CoatedContact | PrescribedLoad) -> Solution:
        if isinstance(problem, PrescribedLoad):
            return fem_reference.solve_prescribed(**_arguments(problem))
        return fem_reference.solve(**_arguments(problem))

    def finite(problem: Problem) -> Solution | Loading:
        if isinstance(problem, LoadingCurve):
            solve = partial(fem_reference.solve, size=CURVE_SIZE)
            return loading(problem, lambda contact: solve(**_arguments(contact)), limits=True)
        return towards_limits(problem, elements)

    def exact(problem: Problem) -> Solution | Loading:
        if isinstance(problem, LoadingCurve):
            return exact_loading(problem)
        if isinstance(problem, PrescribedLoad):
            return uniform_disc.solve_prescribed(**_arguments(problem))
        return integral_equation.solve(**_arguments(problem))

    return {"semianalytic": semi, "fem_reference": finite, REFERENCE: exact}


def _arguments(problem: CoatedContact | PrescribedLoad) -> dict[str, Any]:
    return {f.name: getattr(problem, f.name) for f in fields(problem)}
