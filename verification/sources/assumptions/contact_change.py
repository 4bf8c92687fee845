"""Relative change of a contact when one assumption is dropped, for the quantities that designers use.

At the load of ``problem``: radius, approach, peak pressure, sigma_xx at the trailing edge of the surface,
largest |sigma_xz| on the first interface.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, keywords
from verification.problem.display_units import prefixed
from verification.sources.assumptions.sliding_coupling import SlidingExpansion, first_harmonic
from verification.sources.references import integral_equation
from verification.sources.references.integral_equation import PARABOLA, SPHERE, ExactSolution, Gap

SCALARS = ("contact_radius", "approach", "peak_pressure")
FLOOR = 0.1  # of the peak pressure, to which a smaller stress is compared
THINNEST = 0.01  # h/a_h of an outer coating; time and memory grow as (a/h)^2 and more
POINTS = np.arange(-40, 41) / 20  # of a line along an interface, x/a; symmetric to the last digit
NEAR = np.linspace(-1.5, 0.5, 21)  # (|x| - a)/h, where the shear of a thin coating is largest
THIN = 0.5  # h/a, below which ``NEAR`` is finer than ``POINTS``
# Of both solutions of a change; what their quadratures leave, below 1e-6, is common to both.
RESOLUTION: dict[str, Any] = {"nodes": 40, "panel": 8, "tail": 18.0}


@dataclass(frozen=True)
class Change:
    """Each relative to its value with the assumption, a stress below ``FLOOR`` to that of the peak pressure.

    None where a model gives no value, such as ``shear`` without an interface.
    """

    contact_radius: float | None
    approach: float | None
    peak_pressure: float | None
    tension: float | None
    shear: float | None


def of_sphere(problem: CoatedContact) -> tuple[Change, Change]:
    """From the gap r^2/2R to that of a sphere; vanishes as (a/R)^2.

    Returns the change, then its uncertainty, which is rounding: zero.
    Raises ValueError where the contact is wider than 0.9 R, as ``integral_equation`` does, or an outer
    coating thinner than ``THINNEST``.
    """
    require_thick(problem)
    value = change_between(half_spaces(problem), half_spaces(problem, SPHERE))
    return value, Change(0.0, 0.0, 0.0, 0.0, None if value.shear is None else 0.0)


def half_spaces(problem: CoatedContact, gap: Gap = PARABOLA, **resolution: Any) -> ExactSolution:
    """The contact that an assumption is dropped from; several are dropped from the same.

    resolution : numerical parameters of ``integral_equation.solve``, ``RESOLUTION`` if none are given.
    """
    return _half_spaces(problem, gap, **(resolution or RESOLUTION))


@lru_cache(maxsize=8)
def _half_spaces(problem: CoatedContact, gap: Gap, **resolution: Any) -> ExactSolution:
    return integral_equation.solve(**keywords(problem), gap=gap, estimate_uncertainty=False, **resolution)


def change_between(before: ExactSolution, after: ExactSolution) -> Change:
    """From ``before`` to ``after``, both at the same load; the interface is that of ``before``."""
    scalars = {name: getattr(after, name) / getattr(before, name) - 1 for name in SCALARS}
    one, other, floor = _tension(before), _tension(after), FLOOR * before.peak_pressure
    shear = _shear_change(_shear(before), _shear(after), floor)
    return Change(**scalars, tension=(other - one) / max(abs(one), floor), shear=shear)


def of_goodman(problem: CoatedContact) -> tuple[Change, Change]:
    """By the normal displacement under the traction q = f p, with Dundurs' beta of the materials in contact.

    Scalars to the order (f beta)^2, stresses to the order f beta: by p0 + f p1 cos(theta) and the traction f
    times it, both about the centre of the contact.

    Returns the change, then its uncertainty by the terms beyond, with C = f beta: C^2/2 of a stress, C^2/2 of
    a scalar's change, C^2/2 (x/a)^2 of a peak pressure at x. Patches without an expansion have, C up to 0.3,
    0.17 and 0.32 C^2 of a shear and a tension of a bare solid, 0.3 C^2 of its scalars' change.

    Raises ValueError where an outer coating is thinner than ``THINNEST``.
    """
    f = problem.friction
    if not f:
        nothing = Change(0.0, 0.0, 0.0, 0.0, 0.0 if problem.coatings else None)
        return nothing, nothing
    require_thick(problem)
    expansion = SlidingExpansion(problem, nodes=70, solved=RESOLUTION, exact=half_spaces(problem))
    change, exact = expansion.change, expansion.exact
    panel, tail = RESOLUTION["panel"], RESOLUTION["tail"]

    def first(x: Array, z: float, layer: int) -> tuple[Array, Array]:
        by_pressure, by_traction = first_harmonic(
            expansion.first, problem.coatings, problem.substrate, x, z, layer, panel, tail
        )
        return f * by_pressure.xx + f**2 * by_traction.xx, f * by_pressure.xz + f**2 * by_traction.xz

    edge = np.array([-exact.contact_radius])
    floor = FLOOR * exact.peak_pressure
    tension = float(first(edge, 0.0, 0)[0][0]) / max(abs(_tension(exact)), floor)
    shear, coupled = _shear(exact), None
    if shear is not None:
        coupled = ShearCurve(shear.x, shear.values + first(shear.x, problem.interfaces[0], 0)[1])
    peak, place = expansion.peak_change(f)
    beyond = (f * problem.dundurs_beta) ** 2 / 2
    radius, approach = f**2 * change.contact_radius, f**2 * change.approach
    value = Change(radius, approach, peak, tension, _shear_change(shear, coupled, floor))
    uncertainty = Change(
        contact_radius=beyond * abs(radius),
        approach=beyond * abs(approach),
        peak_pressure=beyond * max(abs(peak), place**2),
        tension=beyond,
        shear=None if shear is None else beyond,
    )
    return value, uncertainty


def require_thick(problem: CoatedContact) -> None:
    """Raises ValueError where an outer coating is thinner than ``THINNEST``."""
    outer = [layers[0] for body in problem.bodies if (layers := problem.seen_from(body).coatings)]
    if any(h < THINNEST * problem.a_h for *_, h in outer):
        least = f"{prefixed(THINNEST * problem.a_h, 'm', 2)} ({THINNEST:g} a_h)"
        raise ValueError(f"an outer coating thinner than {least}, its model would need too long")


@lru_cache(maxsize=8)
def _tension(exact: ExactSolution) -> float:
    """sigma_xx [Pa] at x = -a on the surface."""
    return float(exact.stress(-exact.contact_radius, 0.0, 0.0)[0, 0])


class ShearCurve(NamedTuple):
    """``values`` at ``x``, ascending."""

    x: Array
    values: Array

    @property
    def largest(self) -> float:
        """The largest magnitude, by the parabola through its point and the neighbours."""
        size = np.abs(self.values)
        i = int(np.clip(size.argmax(), 1, size.size - 2))
        (left, middle, right), at = size[i - 1 : i + 2], self.x[i - 1 : i + 2]
        rise, fall = (middle - left) / (at[1] - at[0]), (right - middle) / (at[2] - at[1])
        bend = (fall - rise) / (at[2] - at[0])
        if bend >= 0:
            return float(size.max())
        return float(max(middle - (rise + bend * (at[1] - at[0])) ** 2 / (4 * bend), size.max()))


@lru_cache(maxsize=8)
def _shear(exact: ExactSolution) -> ShearCurve | None:
    """sigma_xz [Pa] along the first interface of the flat."""
    coatings = exact.fields[0].coatings
    if not coatings:
        return None
    x = line_along_interface(exact.contact_radius, h := coatings[0][2])
    return ShearCurve(x, exact.stress(x, 0.0, h, 0)[0, 2])


def line_along_interface(a: float, h: float) -> Array:
    """Points [m] that resolve the shear at depth ``h`` of a contact of radius ``a``."""
    x = POINTS * a
    if h >= THIN * a:
        return x
    edge = a + h * NEAR
    # points that nearly coincide would leave the parabola of ``ShearCurve`` to rounding
    step = edge[1] - edge[0]
    apart = np.maximum(edge[0] - np.abs(x), np.abs(x) - edge[-1]) > step / 2
    return np.sort(np.concatenate([x[apart], edge, -edge]))


def _shear_change(before: ShearCurve | None, after: ShearCurve | None, floor: float) -> float | None:
    if before is None or after is None:
        return None
    return float((after.largest - before.largest) / max(before.largest, floor))
