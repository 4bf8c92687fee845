"""Answers made up from Hertz's formulas, for tests of the study engine that shall solve nothing."""

from collections.abc import Mapping
from typing import Any

from case_texts import study_text

from verification.sources.references.hertz import Hertz
from verification.study.study_point import problem_of

FAILING = 7e-5  # m; a coating of this thickness has no solution here

STUDY = study_text(
    "coating = { nu = 0.25 }",
    sweep="modulus_ratio = [0.5, 2.0]; thickness = [2e-5, 4e-5, 8e-5]; friction = [0.0, 0.25]; "
    "cross_check = 5",
    title="Made up",
)


def made_up(request: Mapping[str, Any]) -> dict[str, Any]:
    """Hertz on the coating's material."""
    problem = problem_of(request, 0.0)
    ((E, nu, thickness),) = problem.coatings
    hertz = Hertz(problem.radius, problem.load, E, nu)
    rows = [
        {"friction": f, "status": "failed", "failure": "no such thickness"}
        if thickness == FAILING
        else {
            "friction": f,
            "status": "solved",
            "failure": None,
            "peak_pressure": hertz.peak_pressure * (1 + f * thickness),
            "sigma_xx_base_x": float("nan"),
        }
        for f in request["frictions"]
    ]
    return {"rows": rows, "seconds": 0.0, "versions": {}}
