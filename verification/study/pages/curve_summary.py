"""Summary of the curves of a study as text made from its numbers."""

from collections.abc import Sequence

import numpy as np

from verification.page.source_labels import source_label
from verification.problem.quantity import QUANTITIES
from verification.study.choice.failure_criteria import MODES
from verification.study.study_table import SCALARS
from verification.study.thickness_curves import Curve, Difference

FLAT = 0.02  # of its own largest value; a curve that changes less does not depend on thickness
NOWHERE = 1e-3  # of p_h
QUANTITY = {
    "sigma_xx_surface": "tensile sigma_xx on the surface",
    "sigma_xx_base": "tensile sigma_xx at the base of the coating",
    "sigma_xx_substrate": "tensile sigma_xx at the top of the substrate",
    "sigma_xz_interface": "shear |sigma_xz| on the interface",
    "sigma_zz_interface": "tensile sigma_zz on the interface",
    "von_mises_coating": "von Mises stress of the coating",
    "von_mises_substrate": "von Mises stress of the substrate",
}


def main_messages(curves: Sequence[Curve]) -> list[str]:
    """A message for each stress, one for the contact: how large, where, which way over the thickness."""
    return [*(_main(quantity, curves) for quantity in MODES), _contact(curves)]


def _main(quantity: str, curves: Sequence[Curve]) -> str:
    name = QUANTITY[quantity][0].upper() + QUANTITY[quantity][1:]
    worst = max(curves, key=lambda c: c.extremes(quantity)[1][1])
    h, value = worst.extremes(quantity)[1]
    if value < NOWHERE:
        return f"{name} stays below {NOWHERE:g} p_h everywhere."
    i = int(worst.stress[quantity].argmax())
    x, z = worst.x[quantity][i], worst.z[quantity][i]
    at = f" at x = {x:.2f} a_h, z = {z:.2f} a_h" if np.isfinite(x) else ""
    beside = [c for c in curves if c.friction == worst.friction]
    ends = {min(c.ratio for c in beside), max(c.ratio for c in beside)}
    courses = [_course(c, quantity, value) for c in beside if c.ratio in ends]
    return (
        f"{name} reaches {value:.3g} p_h, {value * worst.p_h / 1e6:.4g} MPa, with "
        f"{worst.label}, h = {h:.2g} a_h{at}; over the thickness, at f = {worst.friction:g}, "
        f"{'; '.join(courses)}.{_friction_effect(quantity, curves)}"
    )


def _friction_effect(quantity: str, curves: Sequence[Curve]) -> str:
    """Ratio of the largest stress at the largest friction to that at the least."""
    frictions = sorted({c.friction for c in curves})
    if len(frictions) < 2:
        return ""
    low, high = (
        max(c.extremes(quantity)[1][1] for c in curves if c.friction == f)
        for f in (frictions[0], frictions[-1])
    )
    if low < NOWHERE:
        return f" With f = {frictions[0]:g} it is at most {low:.1e} p_h."
    return (
        f" From f = {frictions[0]:g} to {frictions[-1]:g} its largest value over all coatings changes by "
        f"a factor of {high / low:.2f}."
    )


def _contact(curves: Sequence[Curve]) -> str:
    """Ranges of the scalars of the contact, with the coating of each end."""
    found = []
    for name, scale in SCALARS.items():
        low = min(curves, key=lambda c: c.extremes(name)[0][1])
        high = max(curves, key=lambda c: c.extremes(name)[1][1])
        (h_low, least), (h_high, most) = low.extremes(name)[0], high.extremes(name)[1]
        found.append(
            f"{QUANTITIES[name].symbol} is between {least:.3g} {scale} (E1/E2 = {low.ratio:.3g}, "
            f"h = {h_low:.2g} a_h) "
            f"and {most:.3g} {scale} (E1/E2 = {high.ratio:.3g}, h = {h_high:.2g} a_h)"
        )
    return f"Of the contact, {'; '.join(found)}."


def _course(curve: Curve, quantity: str, largest: float) -> str:
    (h_low, low), (h_high, high) = curve.extremes(quantity)
    name = f"E1/E2 = {curve.ratio:.3g}"
    if high < NOWHERE * max(1.0, largest):
        return f"{name} none"
    if high - low < FLAT * high:
        return f"{name} {high:.3f} p_h at every thickness"
    value = curve.stress[quantity]
    steps = np.diff(value)
    if (steps >= 0).all() or (steps <= 0).all():
        way = "rises" if steps.sum() > 0 else "falls"
        return f"{name} {way} from {value[0]:.3f} to {value[-1]:.3f} p_h"
    inner = []
    if 0 < int(value.argmax()) < value.size - 1:
        inner.append(f"a maximum of {high:.3f} p_h at h = {h_high:.2g} a_h")
    if 0 < int(value.argmin()) < value.size - 1:
        inner.append(f"a minimum of {low:.3f} p_h at h = {h_low:.2g} a_h")
    if not inner:
        return f"{name} goes from {value[0]:.3f} to {value[-1]:.3f} p_h, not all one way"
    return f"{name} has {' and '.join(inner)}"


def agreement_messages(differences: Sequence[Difference]) -> list[str]:
    """How far the other sources are from the semi-analytical method over all checked points."""
    found = []
    for source in dict.fromkeys(d.source for d in differences):
        mine = [d for d in differences if d.source == source]
        stress = max((d for d in mine if d.quantity not in SCALARS), key=lambda d: d.largest)
        scalar = max((d for d in mine if d.quantity in SCALARS), key=lambda d: d.largest)
        where = f"E1/E2 = {stress.ratio:.3g}, h = {stress.h:.3g} a_h, f = {stress.friction:g}"
        found.append(
            f"{stress.points} points were also solved by the {source_label(source)}: no stress differs "
            f"by more than {stress.largest:.1e} of the smaller of p_h and p0 ({stress.quantity} at {where}), "
            f"no scalar of the contact by more than {scalar.largest:.1e} of its scale "
            f"({scalar.quantity.replace('_', ' ')})."
        )
    return found
