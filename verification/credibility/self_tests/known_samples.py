"""Sampling of a labelled solution: every line, the points of a table."""

from collections.abc import Sequence
from dataclasses import replace
from typing import cast

import numpy as np

from verification.credibility.self_tests.stand_ins import ON_BALL, Answers, Labelled, labelled, moved
from verification.problem.coated_contact import CoatedContact, ContactSolution
from verification.problem.evaluation_points import TablePoints
from verification.problem.line_profile import line_of, lines_of, oblique_lines
from verification.problem.point_answers import BALL
from verification.sampling.line_sampling import sample, sample_contact
from verification.sampling.point_values import values

PROBLEM = CoatedContact(1e-2, 40.0, ((6e11, 0.25, 5e-5),), (3e11, 0.0), 0.25)
COATED_BALL = replace(PROBLEM, ball=(3e11, 0.0, ((4e11, 0.2, 3e-5),)))


# By hand, a_h = 1e-4 m: the layer of each line and the place of 3e-5 m along it.
PLACES = {
    "surface": (0, (3e-5, 0.0, 0.0)),
    "axis": (None, (0.0, 0.0, 3e-5)),
    "interface 1, upper side": (0, (3e-5, 0.0, 5e-5)),
    "interface 1, lower side": (1, (3e-5, 0.0, 5e-5)),
    "off plane": (None, (3e-5 * 0.8**0.5, 3e-5 * 0.2**0.5, 6e-5)),
    "oblique": (None, (-9e-5 + 1.44e-5, -2e-5 + 1.08e-5, 2.4e-5)),
    "oblique surface": (0, (3e-5 * 0.75**0.5, 1.5e-5, 0.0)),
}


def of_sampling() -> Answers:
    solution = cast(ContactSolution, Labelled())
    scalars = {p.quantity: p for p in sample_contact(solution, "known")}
    for name, value, U in (
        ("peak_pressure", 3e9, 2e6),
        ("contact_radius", 1e-4, 3e-9),
        ("approach", 1e-6, 4e-12),
        ("stiffness", 6e7, 5e1),
    ):
        yield name, float(scalars[name].value[0]), value
        yield f"uncertainty of the {name}", float(scalars[name].uncertainty[0]), U  # type: ignore[index]
    along = np.array([1e-5, 3e-5])
    for name, (layer, place) in PLACES.items():
        for profile in sample(solution, "known", line_of(name, PROBLEM), along):
            if profile.quantity == "pressure":
                yield "pressure", tuple(profile.value), (1.01e9, 1.03e9)
                yield "its uncertainty", tuple(profile.uncertainty), (1.01e6, 1.03e6)  # type: ignore[arg-type]
                continue
            wanted = _known(profile.quantity, place, layer)
            yield f"{profile.quantity} on the line {name}", float(profile.value[1]), wanted
            stated = profile.uncertainty
            yield "its uncertainty", None if stated is None else float(stated[1]), 1e-3 * wanted
    # of the ball, at the same x and y, in the frame of the flat
    for line in (*lines_of(COATED_BALL), *oblique_lines(COATED_BALL)):
        if line.body != BALL:
            continue
        there = [float(v[1]) for v in np.broadcast_arrays(*line.points(along))]
        for profile in sample(solution, "known", line, along):
            wanted = ON_BALL * _known(profile.quantity, there, line.layer)
            yield f"{profile.quantity} on the line {line.name}", float(profile.value[1]), wanted


def _known(quantity: str, place: Sequence[float], layer: int | None) -> float:
    """The labelled stress or displacement called ``quantity``."""
    i, *others = ("xyz".index(letter) for letter in quantity.partition("_")[2])
    return float(labelled(i, others[0], place, layer) if others else moved(i, place))


def of_points_of_tables() -> Answers:
    """Quantities of a table off the plane y = 0, one point in each layer."""
    x, y, z = (np.array(v) for v in ([1e-5, 2e-5], [3e-5, 5e-5], [4e-5, 9e-5]))
    at = TablePoints.of(x, y, z, PROBLEM.coatings, None, "m", 1.0)
    solution = cast(ContactSolution, Labelled())
    places = list(zip(x.tolist(), y.tolist(), z.tolist(), strict=True))
    names = [f"sigma_{c}" for c in ("xx", "xy", "xz", "yy", "yz", "zz")] + [f"u_{c}" for c in "xyz"]
    wanted = {name: [_known(name, place, layer) for layer, place in enumerate(places)] for name in names}
    xx, yy, zz = (np.array(wanted[f"sigma_{c}{c}"]) for c in "xyz")
    E, nu = np.array([6e11, 3e11]), np.array([0.25, 0.0])
    wanted |= {"sigma_kk": (xx + yy + zz).tolist(), "sigma_zz - sigma_xx": (zz - xx).tolist()}
    wanted["eps_xx"] = ((xx - nu * (yy + zz)) / E).tolist()
    wanted["eps_zz"] = ((zz - nu * (xx + yy)) / E).tolist()
    wanted["pressure"] = (1e9 + 1e12 * x + 3e12 * y).tolist()
    wanted["approach"] = [1e-6, 1e-6]
    for quantity, both in wanted.items():
        found, U = values(solution, quantity, at, PROBLEM)
        for layer in (0, 1):
            yield f"{quantity} in layer {layer}", float(found[layer]), float(both[layer])
        yield f"{quantity} has an uncertainty", U is not None and bool(np.all(U > 0)), True
