"""Answers made up from Hertz's formulas, for tests of the study engine that shall solve nothing."""

import time
from collections.abc import Mapping
from typing import Any

from verification.sources.references.hertz import Hertz
from verification.study.solve_cache import code_version

FAILING = 7e-5  # m; a coating of this thickness has no solution here
CRASHING = 9e-5  # m; this one takes its worker's task with it

STUDY = """
title = "Made up"
[problem]
radius = 10e-3
load = 20.0
substrate = { E = 210e9, nu = 0.3 }
coating = { nu = 0.25 }
[sweep]
modulus_ratio = [0.5, 2.0]
thickness = [2e-5, 4e-5, 8e-5]
friction = [0.0, 0.25]
cross_check = 5
"""


def made_up(request: Mapping[str, Any], crashing: float = CRASHING) -> dict[str, Any]:
    """Hertz on the coating's material; slower for thin coatings, so that answers arrive out of order."""
    E, nu, thickness = request["coating"]
    time.sleep(2e-7 / thickness)
    if thickness == crashing:
        raise RuntimeError("the worker's own trouble")
    hertz = Hertz(request["radius"], request["load"], E, nu)
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
    return {"rows": rows, "seconds": 0.0, "versions": {}, "code": code_version(request["source"])}
