"""Registry of the quantities that a source can give: symbol, kind, unit, scale, cap, place of each.

At the contact edge r = a on the surface the pressure has a vertical tangent, and sigma_rr a cusp: under p it
is smooth outside with the root of the pressure inside, under q = f p smooth inside with a root outside. A
value at a fixed point there changes by the square root of the error of the radius, as its uncertainty does.
The largest tension with its place, found by each source on its own solution, has no such root.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from verification.problem.array_types import Array


@dataclass(frozen=True)
class Quantity:
    """One quantity that cases, tables and figures name.

    kind : scalar, slope, peak, curve, pressure, stress, strain or displacement.
    sampled : "contact" (one number of a contact), "axis" (the largest on the axis), "surface" (the largest
    there), "curve" (of a loading curve), "points" (any points of the solid).
    symbol, tex : in text and in formulas.   meaning : in words, where the symbol does not say it.
    unit : SI, "1" for none.   scale : property of CoatedContact that values are divided by.
    cap : largest admissible uncertainty, over the same divisor as differences, see ``divisor``.
    least : smallest cap against published values.
    component : of a stress or strain tensor.   weights : of sigma_xx, sigma_yy, sigma_zz in a sum that the
    quantity is, or whose largest magnitude on the axis it is.
    """

    name: str
    kind: str
    sampled: tuple[str, ...]
    symbol: str
    tex: str
    unit: str
    scale: str = "p_h"
    cap: float = 1e-3
    least: float = 0.0
    component: tuple[int, int] | None = None
    meaning: str = ""
    weights: tuple[float, float, float] | None = None

    def divisor(self, value: float, p_h: float, p0: float, a: float, delta_h: float, delta: float) -> float:
        """Divisor of a difference [SI]: |value| of a scalar or slope, |value| >= a of a place.

        Of a displacement min(delta_h, delta), of any other min(p_h, p0).
        value : of the reference.   p0, a, delta : peak pressure, contact radius and approach of the best
        source; Hertz's alone counts where p0 or delta is not a positive number.
        """
        if self.kind in ("scalar", "slope"):
            return abs(value)
        if self.kind == "displacement":
            return min(delta_h, delta) if delta > 0 else delta_h
        if self.unit == "m":
            return max(abs(value), a)
        return min(p_h, p0) if p0 > 0 else p_h


def _tensor(
    kind: str, name: str, tex: str, unit: str, components: Sequence[str], cap: float = 1e-3
) -> Iterator[Quantity]:
    for c in components:
        place = "xyz".index(c[0]), "xyz".index(c[1])
        symbol = f"{name}_{c}"
        yield Quantity(symbol, kind, _POINTS, symbol, f"{tex}_{{{c}}}", unit, "p_h", cap, component=place)


def _tension(kind: str, end: str = "", of: str = "", tex: str = "") -> Iterator[Quantity]:
    """The largest tension of a body with its place."""
    largest, tension = f"max sigma_xx{of}", _TENSION + ("," + of if of else "")
    symbol, place = rf"\max\sigma_{{xx}}{tex}", _PLACE + of
    yield Quantity(f"largest_tension{end}", kind, _SURFACE, largest, symbol, "Pa", meaning=tension)
    where = f"x of {largest}", f"x{tex}", "m", "a_h", 2e-4
    yield Quantity(f"tension_place{end}", kind, _SURFACE, *where, meaning=place)


_AXIS, _CONTACT, _CURVE, _POINTS, _SURFACE = ("axis",), ("contact",), ("curve",), ("points",), ("surface",)
_DIFFERENCE, _HALF = (-1.0, 0.0, 1.0), (-0.5, 0.0, 0.5)  # sigma_zz - sigma_xx
_BOTH = (*_CONTACT, *_CURVE)
_SHEAR, _MISES = "largest shear on the axis", "largest von Mises stress on the axis"
_TENSION, _PLACE = "largest sigma_xx of the surface on y = 0", "x of the largest sigma_xx of the surface"
_LOOSE = 5e-3  # of quantities that only published tables hold
_SLOPE = "stiffness of the contact, the derivative of the load by the approach"
_PUNCH = "stiffness of the flat punch over 2 a E1*"
_LOADS, _KAPPAS = "load by the formula over W", "stiffness by the formula over that of the flat punch"

# In the order of columns, rows, claims.
QUANTITIES: dict[str, Quantity] = {
    quantity.name: quantity
    for quantity in (
        Quantity("peak_pressure", "scalar", _CONTACT, "p0", "p_0", "Pa", "p_h", 1e-4),
        Quantity("contact_radius", "scalar", _BOTH, "a", "a", "m", "a_h", 2e-4),
        Quantity("approach", "scalar", _BOTH, "approach", r"\delta", "m", "delta_h", 1e-4),
        Quantity(
            "stiffness", "slope", _CONTACT, "dW/d delta", r"dW/d\delta", "N/m", "S_h", 2e-5, meaning=_SLOPE
        ),
        Quantity("tau_max", "scalar", _AXIS, "tau_max", r"\tau_{max}", "Pa", meaning=_SHEAR, weights=_HALF),
        Quantity(
            "von_mises_max",
            "scalar",
            _AXIS,
            "von_mises_max",
            r"\sigma_{vM}",
            "Pa",
            meaning=_MISES,
            weights=_DIFFERENCE,
        ),
        *_tension("peak"),
        *_tension("ball peak", "_ball", " of the ball", "^b"),
        Quantity("load", "curve", _CURVE, "W", "W", "N", cap=_LOOSE),
        Quantity("kappa", "curve", _CURVE, "kappa", r"\kappa", "1", cap=_LOOSE, meaning=_PUNCH),
        Quantity("series_over_load", "curve", _CURVE, "series / W", "", "1", cap=_LOOSE, meaning=_LOADS),
        Quantity(
            "series_over_kappa", "curve", _CURVE, "series / kappa", "", "1", cap=_LOOSE, meaning=_KAPPAS
        ),
        Quantity("pressure", "pressure", _POINTS, "p", "p", "Pa"),
        *_tensor("stress", "sigma", r"\sigma", "Pa", ("xx", "yy", "zz", "xz", "xy", "yz")),
        Quantity("sigma_kk", "stress", _POINTS, "sigma_kk", r"\sigma_{kk}", "Pa", weights=(1.0, 1.0, 1.0)),
        Quantity(
            "sigma_zz - sigma_xx", "stress", _POINTS, "sigma_zz - sigma_xx", "", "Pa", weights=_DIFFERENCE
        ),
        *_tensor("strain", "eps", r"\varepsilon", "1", ("xx", "yy", "zz"), _LOOSE),
        *(
            Quantity(f"u_{c}", "displacement", _POINTS, f"u_{c}", f"u_{c}", "m", "delta_h", 1e-4, _LOOSE)
            for c in "xyz"
        ),
    )
}


def _names(kind: str = "", sampled: str = "") -> tuple[str, ...]:
    return tuple(
        q.name for q in QUANTITIES.values() if kind in ("", q.kind) and (not sampled or sampled in q.sampled)
    )


SCALARS = _names("scalar", "contact")
SLOPES = _names("slope")
PEAKS = _names("peak")
BALL_PEAKS = _names("ball peak")
EXTREMES = _names("scalar", "axis")
CURVES = _names(sampled="curve")
STRESSES = {q.name: q.component for q in QUANTITIES.values() if q.kind == "stress" and q.component}
DISPLACEMENTS = _names("displacement")
IN_PLANE = {name: component for name, component in STRESSES.items() if name not in ("sigma_xy", "sigma_yz")}


def unit_of(name: str) -> str:
    """SI unit of a quantity; "Pa" for any other name, which is that of a stress."""
    return QUANTITIES[name].unit if name in QUANTITIES else "Pa"


def von_mises(sigma: Array | Sequence[Array]) -> Array:
    """Von Mises stress from stresses in the order of ``STRESSES``, (6, ...), or ``IN_PLANE``, (4, ...); [Pa].

    sigma_vM^2 = ((xx - yy)^2 + (yy - zz)^2 + (zz - xx)^2) / 2 + 3 (xz^2 + xy^2 + yz^2)
    """
    xx, yy, zz, *shear = sigma
    square = 0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * sum(s**2 for s in shear)
    return np.sqrt(square)


def largest_shear(sigma: Array | Sequence[Array]) -> Array:
    """Largest shear stress [Pa], half of Tresca's, from the stresses xx, yy, zz, xz of the plane y = 0."""
    principal = _principal(sigma)
    return (principal.max(axis=0) - principal.min(axis=0)) / 2


def first_principal(sigma: Array | Sequence[Array]) -> Array:
    """Largest principal stress from stresses in the order of ``STRESSES``, (6, ...), or ``IN_PLANE``; [Pa].

    Of six the mean plus 2 sqrt(J2/3) cos(phi), cos(3 phi) = (J3/2) (3/J2)^(3/2), J2 and J3 the invariants of
    the deviator: O. K. Smith, Commun. ACM 4 (1961) 168.
    """
    if len(sigma) == len(IN_PLANE):
        return np.asarray(_principal(sigma).max(axis=0))
    s = np.asarray(sigma)
    mean = s[:3].sum(axis=0) / 3
    (xx, yy, zz), (xz, xy, yz) = s[:3] - mean, s[3:]
    J2 = von_mises(s) ** 2 / 3
    J3 = xx * yy * zz + 2 * xy * yz * xz - xx * yz**2 - yy * xz**2 - zz * xy**2
    cosine = np.clip(1.5 * 3**0.5 * J3 / np.maximum(J2, 1e-300) ** 1.5, -1.0, 1.0)
    return np.asarray(mean + 2 * np.sqrt(J2 / 3) * np.cos(np.arccos(cosine) / 3))


def _principal(sigma: Array | Sequence[Array]) -> Array:
    """The principal stresses in the plane of symmetry y = 0, (3, ...), in no order."""
    xx, yy, zz, xz = sigma
    middle, radius = (xx + zz) / 2, np.hypot((xx - zz) / 2, xz)
    return np.stack([middle + radius, middle - radius, yy])


def largest_strain(sigma: Array | Sequence[Array], E: float, nu: float) -> Array:
    """Largest principal strain in magnitude, from the stresses xx, yy, zz, xz of the plane y = 0, (4, ...).

    e_i = ((1 + nu) s_i - nu (s_1 + s_2 + s_3)) / E, s_i the principal stresses
    """
    principal = _principal(sigma)
    return np.abs(((1 + nu) * principal - nu * principal.sum(axis=0)) / E).max(axis=0)
