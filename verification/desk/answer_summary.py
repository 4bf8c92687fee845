"""The answer to one problem in one sentence: largest tension, shear of an interface, von Mises stress."""

import numpy as np

from verification.desk.answer_stresses import Extreme
from verification.desk.contact_answer import Answer
from verification.problem.coated_contact import FLAT, CoatedContact

__all__ = ["summary"]

ON_AXIS = 5e-3  # of a place from the axis, over a


def summary(problem: CoatedContact, found: Answer) -> str:
    """Where the coatings are pulled and sheared and both bodies yield the most, three digits in MPa.

    The tension is the largest sigma_1 of the coatings, without any of both bodies; with it the largest
    sigma_xx at the base of a coating, which cracks from there too.
    """

    def largest(quantity: str, where: str = "") -> Extreme | None:
        those = (at for at in found.extremes if at.quantity == quantity and at.where.startswith(where))
        return max(those, key=lambda at: at.value, default=None)

    a = found.numbers["contact_radius"][0]
    coating, base = largest("sigma_1", "coating"), largest("sigma_xx", "base of")
    tension, pulled = coating or largest("sigma_1"), "tension of a coating" if coating else "tension"
    shear, von_mises = largest("|sigma_xz|"), largest("von_mises")
    parts = [f"No {pulled}"]
    if tension and tension.value > 0:
        place = _place(tension, a, sliding=problem.friction > 0)
        parts = [f"Largest {pulled} {_mpa(tension)} in {_layer(tension)}, {place}"]
    if base and base.value > 0:
        parts.append(f"{_mpa(base)} at the {_layer(base)}")
    if shear:
        parts.append(f"{_layer(shear)} sheared by {_mpa(shear)}")
    if von_mises:
        parts.append(f"von Mises stress up to {_mpa(von_mises)} in {_layer(von_mises)}")
    return f"{'; '.join(parts)}."


def _mpa(at: Extreme) -> str:
    return f"{np.format_float_positional(at.value / 1e6, precision=3, fractional=False, trim='-')} MPa"


def _layer(at: Extreme) -> str:
    name = "the substrate" if at.where == "substrate" else at.where
    return name if at.body == FLAT else f"{name} of the {at.body}"


def _place(at: Extreme, a: float, *, sliding: bool) -> str:
    depth = "at its surface" if at.z == 0 else f"at z = {at.z * 1e6:.3g} um"
    if abs(at.x) < ON_AXIS * a:
        return f"{depth} on the axis"
    side = ("behind" if at.x < 0 else "ahead of") if sliding else "from"
    return f"{depth}, {abs(at.x) / a:.2f} a {side} the axis"
