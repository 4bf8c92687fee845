"""Comparison of a simulation S with a measurement D after ASME V&V 20-2009.

    E = S - D,   u_val^2 = u_num^2 + u_input^2 + u_D^2,   model error in E +- 2 u_val

u_input by central differences of S over one standard uncertainty of each input, inputs taken as
independent (section 3.2 of the standard). Everything is relative to D. S is the modulus of a rigid flat punch
of the radius measured, S/(2a), from the semi-analytical method's contact stiffness; the differences for
u_input and the curves between are those of the exact integral equation, which shares no code with it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

import fem_reference
import semianalytic
from verification.problem.array_types import Array, Coatings
from verification.running.json_records import RecordFile
from verification.sources.references.flat_punch import pressed
from verification.sources.references.layered_half_space import contact_modulus
from verification.validation.measured_modulus import MeasuredModulus, data_sets, described

Solid = tuple[Coatings, tuple[float, float]]
ROUND = 100.0  # radius of the sphere over the contact radius: dP/d delta is the punch's at any


def substrate(change: float = 0.0) -> tuple[float, float]:
    """The silicon wafer as (E, nu), its plane strain modulus ``change`` standard uncertainties higher."""
    given = described()["substrate"]
    return (given["modulus"] + change * given["u"]) * (1 - given["nu"] ** 2), given["nu"]


def exact_modulus(a: float, solid: Solid) -> float:
    """S/(2a) [Pa] of a rigid flat punch of radius ``a`` by the integral equation."""
    return pressed(a, *solid).kappa * contact_modulus(*solid)


def method_modulus(
    a: float, solid: Solid, solve: Callable[..., Any], **numerics: object
) -> tuple[float, float]:
    """S/(2a) [Pa] of a sphere's contact by the ``solve`` of a method, and the method's uncertainty of it.

    The load that gives the radius ``a`` comes from the integral equation; the radius that the method finds
    for it is the one that is used.
    """
    radius = ROUND * a
    load = pressed(a, *solid).load / radius
    found = solve(radius=radius, load=load, coatings=solid[0], substrate=solid[1], **numerics)
    (stiffness, U), width = found.sample(None, "stiffness"), 2 * found.contact_radius
    return stiffness / width, (U or 0.0) / width


@dataclass(frozen=True)
class Validated:
    """One data set compared, in the rows that were admitted; everything is relative to D, but for S [Pa].

    inputs : name of each input and what one standard uncertainty of it changes.   bare_film, bare_substrate :
    E where the stack is replaced by its outermost layer or by the substrate.   elements : (row, S) of some
    rows.
    """

    name: str
    S: tuple[float, ...]
    E: tuple[float, ...]
    u_num: tuple[float, ...]
    inputs: dict[str, tuple[float, ...]]
    u_random: tuple[float, ...]
    u_common: float
    bare_film: tuple[float, ...]
    bare_substrate: tuple[float, ...]
    elements: tuple[tuple[int, float], ...] = ()

    @property
    def measured(self) -> MeasuredModulus:
        """The data set."""
        return next(one for one in data_sets() if one.name == self.name)

    @property
    def u_input(self) -> Array:
        """Root of the sum of squares over the inputs."""
        return np.sqrt(sum(np.square(change) for change in self.inputs.values()))

    @property
    def u_D(self) -> Array:
        """Standard uncertainty of D: that between tests and that which all rows share."""
        return np.hypot(self.u_random, self.u_common)

    @property
    def u_val(self) -> Array:
        """Standard uncertainty of E."""
        return np.sqrt(np.square(self.u_num) + self.u_input**2 + self.u_D**2)

    @property
    def mean(self) -> float:
        """Mean E of the rows."""
        return float(np.mean(self.E))

    @property
    def rms(self) -> float:
        """Root mean square of E about zero."""
        return float(np.sqrt(np.mean(np.square(self.E))))

    @property
    def interval(self) -> tuple[float, float]:
        """Mean E -+ 2 u_val (mean): the model's error at about 95 %; the rows share most of u_val."""
        half = 2 * float(self.u_val.mean())
        return self.mean - half, self.mean + half


@dataclass(frozen=True)
class ValidationRecord:
    """All data sets compared, with commit, date, seconds of processor time, hash of the code."""

    sets: tuple[Validated, ...]
    started: str
    commit: str | None
    seconds: float
    source: str = ""


RECORD = RecordFile(
    ValidationRecord, "validation.json", ("coatcheck-validation/1",), "validation", "compute it again"
)


def changed_stacks(measured: MeasuredModulus) -> dict[str, tuple[Solid, Solid]]:
    """For each input the stack one standard uncertainty above and below."""
    nominal = measured.coatings
    found: dict[str, tuple[Solid, Solid]] = {}
    for k, layer in enumerate(measured.layers):
        steps = {
            f"E of {layer.name}": (layer.u_E * layer.E, 0, 0),
            f"nu of {layer.name}": (0, layer.u_nu, 0),
            f"thickness of {layer.name}": (0, 0, layer.u_thickness * layer.thickness),
        }
        for name, step in steps.items():
            up, down = (
                (*nominal[:k], (*np.add(nominal[k], sign * np.array(step)),), *nominal[k + 1 :])
                for sign in (1, -1)
            )
            found[name] = (up, substrate()), (down, substrate())
    found["modulus of the substrate"] = (nominal, substrate(1)), (nominal, substrate(-1))
    return found


def validated(measured: MeasuredModulus, elements: int = 0) -> Validated:
    """``measured`` beside the semi-analytical method, in ``elements`` rows beside the finite elements too."""
    rows = np.flatnonzero(measured.admitted)
    a, D, nominal = measured.a[rows], measured.D[rows], (measured.coatings, substrate())
    S, U = np.transpose([method_modulus(radius, nominal, semianalytic.solve, patches=129) for radius in a])
    inputs = {
        name: _floats(np.array([exact_modulus(r, up) - exact_modulus(r, down) for r in a]) / 2 / D)
        for name, (up, down) in changed_stacks(measured).items()
    }
    # S depends on the radius, too: S (a) - D (a), both at the radius inferred
    slope = np.array([exact_modulus(1.01 * r, nominal) - exact_modulus(r / 1.01, nominal) for r in a])
    slope = slope / (2 * np.log(1.01)) / D + 1
    chosen = np.unique(np.linspace(0, rows.size - 1, elements).astype(int))
    film, bare = contact_modulus(*nominal), contact_modulus((), nominal[1])
    random = np.hypot(measured.u_random[rows], slope * measured.u_radius[rows])
    return Validated(
        name=measured.name,
        S=_floats(S),
        E=_floats(S / D - 1),
        u_num=_floats(U / 2 / D),
        inputs=inputs,
        u_random=_floats(random),
        u_common=measured.u_common,
        bare_film=_floats(film / D - 1),
        bare_substrate=_floats(bare / D - 1),
        elements=tuple((int(k), method_modulus(a[k], nominal, fem_reference.solve)[0]) for k in chosen),
    )


def _floats(values: Array) -> tuple[float, ...]:
    return tuple(float(value) for value in values)
