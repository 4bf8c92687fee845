"""The answer to one problem in one sentence: largest tension, shear of an interface, von Mises stress."""

import math

import numpy as np

from verification.desk.answer import Answer
from verification.desk.stresses import Extreme
from verification.problem.contact import FLAT, CoatedContact

__all__ = ["summary"]

ON_AXIS = 5e-3  # of a place from the axis, over a


def summary(problem: CoatedContact, found: Answer) -> str:
    """Where both bodies are pulled, sheared and yield the most, three digits in MPa.

    The tension is the largest sigma_1 of all layers; that of a coating comes with the largest sigma_xx at the
    base of a coating, which cracks from there too.
    """
    a = found.numbers["contact_radius"][0]
    tension = _largest(found, "sigma_1")
    parts = ["No tension"]
    if tension.value > 0:
        parts = [f"Largest tension {_mpa(tension)} in {_layer(tension)}, {_place(tension, a, problem)}"]
    bases = [at for at in found.extremes if at.where.startswith("base of") and at.value > 0]
    if bases:
        base = max(bases, key=lambda at: at.value)
        parts.append(f"{_mpa(base)} at the {_layer(base)}")
    if problem.coatings or (problem.ball and problem.ball[2]):
        shear = _largest(found, "|sigma_xz|")
        parts.append(f"{_layer(shear)} sheared by {_mpa(shear)}")
    von_mises = _largest(found, "von_mises")
    parts.append(f"von Mises stress up to {_mpa(von_mises)} in {_layer(von_mises)}")
    return f"{'; '.join(parts)}."


def _largest(found: Answer, quantity: str) -> Extreme:
    return max((at for at in found.extremes if at.quantity == quantity), key=lambda at: at.value)


def _mpa(at: Extreme) -> str:
    return f"{np.format_float_positional(at.value / 1e6, precision=3, fractional=False, trim='-')} MPa"


def _layer(at: Extreme) -> str:
    name = at.where if at.where.startswith(("base", "interface")) else f"the {at.where}"
    return name.replace("the coating", "coating") + ("" if at.body == FLAT else f" of the {at.body}")


def _place(at: Extreme, a: float, problem: CoatedContact) -> str:
    depth = "at its surface" if at.z == 0 else f"at z = {at.z * 1e6:.3g} um"
    if math.isnan(at.x) or abs(at.x) < ON_AXIS * a:
        return f"{depth} on the axis"
    distance = f"{abs(at.x) / a:.2f} a"
    if problem.friction == 0:
        return f"{depth}, {distance} from the axis"
    return f"{depth}, {distance} {'behind' if at.x < 0 else 'ahead of'} the axis"
