"""A study's table made of closed formulas, without any method, for criteria, figures, summary."""

import numpy as np

from verification.study.largest_stresses import QUANTITIES
from verification.study.study_plan import parse_study
from verification.study.study_table import SCALARS, write_table

TEXT = """
title = "Made of formulas"
[problem]
radius = 10e-3
load = 20.0
substrate = { E = 210e9, nu = 0.3 }
coating = { nu = 0.3 }
[sweep]
modulus_ratio = [0.5, 2.0]
thickness_over_a_h = { from = 0.05, to = 5.0, count = 9 }
friction = [0.0, 0.25]
"""
A_H, P_H = 8.66e-5, 1.27e9


def stress(quantity, ratio, h, f):
    """Any smooth law will do: it has a minimum in h for the surface, falls for the others."""
    if quantity == "sigma_xx_surface":
        return (0.1 + f) * ratio * (1 + np.log(h / 0.5) ** 2 / 4)
    return ratio * (1 + f) * np.exp(-h) * (QUANTITIES.index(quantity) + 1) / 10


def write(path, *, failed=(), checked=0.0, text=TEXT):
    """The table at ``path``; ``checked`` is what the finite element rows are off by."""
    study = parse_study(text.encode(), path.with_suffix(".toml"))
    rows, point = [], 0
    for ratio in (0.5, 2.0):
        for thickness in study.thicknesses:
            h = thickness / A_H
            for f in study.frictions:
                for source in ("semianalytic", "fem_reference") if point % 5 == 0 else ("semianalytic",):
                    rows.append(_row(point, source, ratio, h, f, checked, point in failed))
                point += 1
    write_table(path, rows, {"name": "made", "text": text})
    return study


def _row(point, source, ratio, h, f, checked, failed):
    row = {
        "point": point, "source": source, "status": "failed" if failed else "solved",
        "failure": "no luck" if failed else None, "radius": 10e-3, "load": 20.0, "coating_E": ratio * 210e9,
        "coating_nu": 0.3, "thickness": h * A_H, "residual_stress": 0.0,
        "substrate_E": 210e9, "substrate_nu": 0.3, "friction": f,
        "modulus_ratio": ratio, "thickness_over_a_h": h, "a_h": A_H, "p_h": P_H, "delta_h": 1e-6,
        "ball": "null", "indenter": "null", "numerics": "{}", "versions": "{}", "key": "0", "seconds": 0.1,
    }  # fmt: skip
    if failed:
        return row
    off = checked if source != "semianalytic" else 0.0
    for quantity in QUANTITIES:
        value = stress(quantity, ratio, h, f) + off
        row |= {
            quantity: value * P_H, f"{quantity}_over_p_h": value, f"{quantity}_uncertainty": 1e-5 * P_H,
            f"{quantity}_x": 0.0, f"{quantity}_x_over_a_h": 0.0, f"{quantity}_z": 0.0,
            f"{quantity}_z_over_a_h": 0.0,
        }  # fmt: skip
    for name, scale in SCALARS.items():
        row |= {name: row[scale], f"{name}_over_{scale}": 1.0, f"{name}_uncertainty": 0.0}
    return row
