"""Quantities a source may print, taken from a solution at any points of the solid."""

from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import NDArray

from verification.loading import CURVES, Loading, LoadingCurve
from verification.problem import CoatedContact, PrescribedLoad, Solution
from verification.references.hankel import layer_at

__all__ = ["EXTREMES", "POINTWISE", "QUANTITIES", "SCALAR", "Points", "values"]

Array = NDArray[np.float64]

SCALAR = ("peak_pressure", "contact_radius", "approach")
_COMPONENT = {f"{'xyz'[i]}{'xyz'[j]}": (i, j) for i, j in ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))}
# On the axis, where both principal shears are equal.
EXTREMES = ("tau_max", "von_mises_max")
POINTWISE = ("stress", "strain")  # kinds made of the stress at each point; the pressure aside
# Every quantity by the kind of number it is.
QUANTITIES = (
    {name: "curve" for name in CURVES}
    | {name: "scalar" for name in SCALAR + EXTREMES}
    | {"pressure": "pressure", "sigma_kk": "stress", "sigma_zz - sigma_xx": "stress"}
    | {f"sigma_{c}": "stress" for c in _COMPONENT}
    | {f"eps_{c}": "strain" for c in ("xx", "yy", "zz")}
    | {f"u_{c}": "displacement" for c in "xyz"}
)


@dataclass(frozen=True, eq=False)
class Points:
    """Points x, y, z [m] in ``layer`` each; ``unit`` and its SI value name lines as the source does.

    control : of a loading curve, whose values x are.
    """

    x: Array
    y: Array
    z: Array
    layer: NDArray[np.int_]
    unit: str
    in_si: float
    control: str = ""

    @classmethod
    def of(
        cls,
        x: Array,
        y: Array,
        z: Array,
        coatings: tuple[tuple[float, float, float], ...],
        layer: int | None,
        unit: str,
        in_si: float,
    ) -> "Points":
        """Points with their layers, on an interface the upper one unless ``layer`` says otherwise."""
        return cls(x, y, z, np.broadcast_to(layer_at(z, coatings, layer), z.shape), unit, in_si)

    @classmethod
    def origin(cls, count: int) -> "Points":
        """The place of a number that belongs to the contact as a whole."""
        zero = np.zeros(count)
        return cls(zero, zero, zero, np.zeros(count, dtype=int), "m", 1.0)

    @classmethod
    def on_curve(cls, control: str, value: Array, unit: str, in_si: float) -> "Points":
        """Points of a loading curve, by what controls it [m]."""
        zero = np.zeros(value.shape)
        return cls(value, zero, zero, np.zeros(value.shape, dtype=int), unit, in_si, control)

    @property
    def along(self) -> Array:
        """The coordinate that runs: z, or x where all lie at one depth, or the control of a curve [m]."""
        return self.x if self._at_one_depth or self.control else self.z

    @property
    def coordinate(self) -> str:
        """The name of ``along``."""
        if self.control:
            return {"contact_radius": "a", "approach": "delta"}[self.control]
        return "x" if self._at_one_depth else "z"

    @property
    def _at_one_depth(self) -> bool:
        return bool(self.z.size > 1 and np.ptp(self.z) == 0 and np.ptp(self.x) > 0)

    def lines(self) -> list[tuple[str, list[int]]]:
        """The points as straight lines, each with its name and the numbers of its points."""
        if self.control:
            return [("loading curve", list(range(self.x.size)))]
        if self._at_one_depth and np.ptp(self.y) == 0:
            return [(self._place(("y", self.y), ("z", self.z)), list(range(self.z.size)))]
        lines: dict[tuple[float, float], list[int]] = {}
        for i, place in enumerate(zip(self.x.tolist(), self.y.tolist(), strict=True)):
            lines.setdefault(place, []).append(i)
        return [
            (self.part(rows)._place(("x", self.x[rows]), ("y", self.y[rows])), rows)
            for rows in lines.values()
        ]

    def part(self, rows: list[int]) -> "Points":
        """Some of the points."""
        x, y, z, layer = self.x[rows], self.y[rows], self.z[rows], self.layer[rows]
        return Points(x, y, z, layer, self.unit, self.in_si, self.control)

    def _place(self, *fixed: tuple[str, Array]) -> str:
        said = [f"{name} = {float(v[0]) / self.in_si:.6g} {self.unit}" for name, v in fixed if v[0] != 0]
        zero = "surface" if fixed[-1][0] == "z" else "axis"
        return ", ".join(said) or zero


def values(
    solution: Solution | Loading,
    quantity: str,
    at: Points,
    problem: CoatedContact | PrescribedLoad | LoadingCurve,
    series: tuple[float, ...] = (),
) -> tuple[Array, Array | None]:
    """``quantity`` [SI, tension positive] of a solution at points, with its uncertainty if one is stated.

        eps_ij = [(1 + nu) sigma_ij - nu sigma_kk delta_ij] / E

    A displacement is as uncertain as the one at the origin, where the solution's approach is taken, unless
    the solution says more. series : coefficients, where the quantity asks for some.
    """
    if isinstance(problem, LoadingCurve):
        return cast(Loading, solution).quantity(quantity, at.along, series)
    assert not isinstance(solution, Loading)
    stated = solution.uncertainty
    if quantity in EXTREMES:
        top, wide = _extreme(solution, quantity)
        return np.full(at.x.shape, top), None if wide is None else np.full(at.x.shape, wide)
    if QUANTITIES[quantity] == "scalar":
        value = np.full(at.x.shape, float(getattr(solution, quantity)))
        return value, None if stated is None else np.full(at.x.shape, float(getattr(stated, quantity)))
    if quantity == "pressure":
        p = solution.pressure(at.x, at.y)
        return p, None if stated is None else solution.pressure_uncertainty(at.x, at.y)
    if QUANTITIES[quantity] == "displacement":
        i = "xyz".index(quantity[-1])
        u = solution.displacement(at.x, at.y, at.z)[i]
        if hasattr(solution, "displacement_uncertainty"):
            return u, solution.displacement_uncertainty(at.x, at.y, at.z)[i]
        return u, None if stated is None else np.full(u.shape, float(stated.approach))
    value, spread = np.empty(at.x.shape), np.empty(at.x.shape)
    moduli = [(E, nu) for E, nu, _ in problem.coatings] + [problem.substrate]
    for layer in sorted(set(at.layer.tolist())):
        here = at.layer == layer
        place = (at.x[here], at.y[here], at.z[here])
        weight = _weights(quantity, *moduli[layer])
        value[here] = np.einsum("ij,ij...->...", weight, solution.stress(*place, layer=layer))
        if stated is not None:
            U = solution.stress_uncertainty(*place, layer=layer)
            spread[here] = np.einsum("ij,ij...->...", np.abs(weight), U)
    return value, None if stated is None else spread


def _extreme(solution: Solution, quantity: str) -> tuple[float, float | None]:
    """The largest tau = |sigma_zz - sigma_xx|/2, where a parabola through three points has its top."""
    z = solution.contact_radius * np.linspace(0.3, 0.7, 21)
    sigma = solution.stress(0.0, 0.0, z)
    tau = np.abs(sigma[2, 2] - sigma[0, 0]) / 2
    top = int(np.clip(tau.argmax(), 1, z.size - 2))
    low, here, high = tau[top - 1 : top + 2].tolist()
    share = 2.0 if quantity == "von_mises_max" else 1.0
    value = share * (here + (high - low) ** 2 / (8 * (2 * here - low - high)))
    if solution.uncertainty is None:
        return value, None
    spread = solution.stress_uncertainty(0.0, 0.0, z[[top]])
    return value, share * float(spread[2, 2, 0] + spread[0, 0, 0]) / 2


def _weights(quantity: str, E: float, nu: float) -> Array:
    """The quantity as a sum of weights times stresses, (3, 3)."""
    if quantity == "sigma_kk":
        return np.eye(3)
    if quantity == "sigma_zz - sigma_xx":
        return np.diag([-1.0, 0.0, 1.0])
    kind, component = quantity.split("_")
    weight = np.zeros((3, 3))
    weight[_COMPONENT[component]] = 1.0
    return weight if kind == "sigma" else ((1 + nu) * weight - nu * np.eye(3)) / E
