"""The answer to one problem in a sentence: largest tension, shear of each interface, von Mises stress."""

import numpy as np

from verification.desk.answer_stresses import Extreme
from verification.desk.contact_answer import Answer, Difference
from verification.problem.coated_contact import FLAT, CoatedContact

__all__ = ["agreement", "governing", "summary"]

ON_AXIS = 5e-3  # of a place from the axis, over a


def governing(found: Answer) -> Extreme | None:
    """The largest first principal stress of both bodies."""
    return _largest(found, "sigma_1")


def summary(problem: CoatedContact, found: Answer) -> str:
    """Where both bodies are pulled and yield the most, and the interfaces are sheared; three digits in MPa.

    Where the largest tension is not that of a coating, the largest of the coatings follows; then the largest
    sigma_xx at the base of a coating, which cracks from there too.
    """

    a, sliding = found.numbers["contact_radius"][0], problem.friction > 0
    largest, coating = governing(found), _largest(found, "sigma_1", "coating")
    base, von_mises = _largest(found, "sigma_xx", "base of"), _largest(found, "von_mises")

    def name(at: Extreme) -> str:
        where = "the substrate" if at.where == "substrate" else at.where
        if at.body == FLAT:
            return where
        coated = bool(problem.seen_from(at.body).coatings)
        return f"{where} of the {at.body}" if coated else f"the {at.body}"

    parts = ["No tension"]
    if largest and largest.value > 0:
        parts = [f"Largest tension {_mpa(largest)} in {name(largest)}, {_place(largest, a, sliding=sliding)}"]
        if coating and coating is not largest and coating.value > 0:
            parts.append(
                f"of the coatings {_mpa(coating)} in {name(coating)}, {_place(coating, a, sliding=sliding)}"
            )
    if base and base.value > 0:
        parts.append(f"{_mpa(base)} at the {name(base)}")
    parts += [f"{name(at)} sheared by {_mpa(at)}" for at in found.extremes if at.quantity == "|sigma_xz|"]
    if von_mises:
        parts.append(f"von Mises stress up to {_mpa(von_mises)} in {name(von_mises)}")
    return f"{'; '.join(parts)}."


def agreement(first: Answer, apart: tuple[Difference, ...]) -> str:
    """Whether both methods agree, and within what: shares of p0 and of each length; "" without a check."""
    if not apart:
        return ""
    outside = [one for one in apart if not one.within]
    p0 = first.numbers["peak_pressure"][0]
    scales = {name: value for name, (value, _) in first.numbers.items()}
    worst = max(abs(one.value) / scales.get(one.key[0], p0) for one in apart)
    within = f"within {100 * worst:.1g} % of p0, the contact radius or the approach"
    if not outside:
        return f"Both methods agree on all {len(apart)} numbers {within}, and within their uncertainties."
    names = "; ".join(" ".join(one.key) for one in outside[:3]) + ("; ..." if len(outside) > 3 else "")
    return (
        f"The methods differ by more than both uncertainties in {len(outside)} of {len(apart)} numbers "
        f"({names}); all are {within}."
    )


def _largest(found: Answer, quantity: str, where: str = "") -> Extreme | None:
    those = (at for at in found.extremes if at.quantity == quantity and at.where.startswith(where))
    return max(those, key=lambda at: at.value, default=None)


def _mpa(at: Extreme) -> str:
    return f"{np.format_float_positional(at.value / 1e6, precision=3, fractional=False, trim='-')} MPa"


def _place(at: Extreme, a: float, *, sliding: bool) -> str:
    depth = "at its surface" if at.z == 0 else f"at z = {at.z * 1e6:.3g} um"
    if abs(at.x) < ON_AXIS * a:
        return f"{depth} on the axis"
    side = ("behind" if at.x < 0 else "ahead of") if sliding else "from"
    return f"{depth}, {abs(at.x) / a:.2f} a {side} the axis"
