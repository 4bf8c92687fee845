"""A study's table made of closed formulas, without any method, for criteria, figures, summary."""

import numpy as np
from case_texts import study_text

from verification.problem.coated_contact import CoatedContact
from verification.study.largest_stresses import QUANTITIES
from verification.study.study_plan import parse_study
from verification.study.study_point import problem_of, table_rows
from verification.study.study_table import SCALARS, write_table

TEXT = study_text(
    "coating = { nu = 0.3 }",
    sweep="modulus_ratio = [0.5, 2.0]; thickness_over_a_h = { from = 0.05, to = 5.0, count = 9 }; "
    "friction = [0.0, 0.25]; cross_check = 5",
    title="Made of formulas",
)
BARE = CoatedContact(10e-3, 20.0, (), (210e9, 0.3))
P_H = BARE.p_h


def stress(quantity, ratio, h, f):
    """Any smooth law will do: it has a minimum in h for the surface, falls for the others."""
    if quantity == "sigma_xx_surface":
        return (0.1 + f) * ratio * (1 + np.log(h / 0.5) ** 2 / 4)
    return ratio * (1 + f) * np.exp(-h) * (QUANTITIES.index(quantity) + 1) / 10


def write(path, *, failed=(), checked=0.0, text=TEXT, study=None, law=stress):
    """The table at ``path`` with its study; ``checked`` is what the finite element rows are off by.

    failed : points without a solution.   law : stress over p_h by quantity, E1/E2, h/a_h and friction.
    """
    study, rows = study or parse_study(text.encode(), path.with_suffix(".toml")), []
    for one in (one for one in study.solves() if one.source != "integral_equation"):
        off, made = checked * (one.source != "semianalytic"), []
        for point, f in enumerate(one.request["frictions"], start=one.first):
            row = {"friction": f, "status": "failed", "failure": "no luck"}
            if point not in failed:
                row |= {"status": "solved", "failure": None, **_numbers(one.request, f, law, off)}
            made.append(row)
        found = {"rows": made, "versions": {}, "seconds": 0.1}
        rows += table_rows(one.first, one.key, one.request, found, one.places)
    write_table(path, rows, {"name": "made", "text": text})
    return study


def _numbers(request, f, law, off):
    """The numbers of one row."""
    problem = problem_of(request, f)
    (E, _, h), bare = problem.coatings[0], {name: getattr(problem, name) for name in SCALARS.values()}
    row = {name: bare[scale] for name, scale in SCALARS.items()}
    for name in QUANTITIES:
        value = law(name, E / problem.substrate[0], h / problem.a_h, f) + off
        row |= {name: value * problem.p_h, f"{name}_uncertainty": 1e-5 * problem.p_h}
        row |= {f"{name}_x": 0.0, f"{name}_z": 0.0}
    return row | {f"{name}_uncertainty": 0.0 for name in SCALARS}
