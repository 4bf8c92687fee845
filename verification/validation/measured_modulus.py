"""Moduli of layered solids measured by continuous-stiffness indentation, with their uncertainty.

The contact stiffness S of a frictionless axisymmetric contact of radius a on a layered half-space is that
of a flat punch of this radius, whatever the tip and the imprint (Oliver and Pharr, J. Mater. Res. 7 (1992)
1564), so that S(a) tests the layered compliance. The modulus D that is compared is what the instrument
would export:

    E_r = S / (2 beta a),   1/D = 1/E_r - (1 - nu_i^2)/E_i      (diamond E_i, nu_i; beta of the tip)

The data lie in ``data``; ``measurements.toml`` states their sources, stacks, uncertainties and domains.
"""

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from verification.cases.toml_file import load_toml
from verification.problem.array_types import Array, Coatings

DATA = Path(__file__).parent / "data"


@cache
def described() -> dict[str, Any]:
    """The file ``measurements.toml``."""
    return load_toml((DATA / "measurements.toml").read_bytes())[1]


def table(name: str) -> dict[str, Array]:
    """Columns of one of the CSV files by their heads, in SI units: nm, mN and GPa are converted."""
    units = {"_nm": 1e-9, "_mN": 1e-3, "_GPa": 1e9, "_N_per_m": 1.0}
    found = np.genfromtxt(DATA / name, delimiter=",", names=True)
    ends = {head: next(end for end in units if head.endswith(end)) for head in found.dtype.names or ()}
    return {head.removesuffix(end): found[head] * units[end] for head, end in ends.items()}


@dataclass(frozen=True)
class MeasuredLayer:
    """One layer of a stack; standard uncertainties of its inputs, relative but for nu, and their basis."""

    name: str
    E: float
    nu: float
    thickness: float
    u_E: float
    u_nu: float
    u_thickness: float
    basis: str


@dataclass(frozen=True, eq=False)
class MeasuredModulus:
    """Rows of one data set: contact radius ``a`` [m], depth of contact [m], modulus ``D`` [Pa].

    u_random : relative standard deviation of D between tests, at the radius stated.   u_radius : that of the
    radius.   u_common : relative, shared by all rows: area function and beta.   admitted : rows compared.
    """

    name: str
    title: str
    source: str
    layers: tuple[MeasuredLayer, ...]
    a: Array
    depth: Array
    D: Array
    u_random: Array
    u_radius: Array
    u_common: float
    admitted: NDArray[np.bool_]
    because: str
    assumed: str
    reason: str = ""

    @property
    def coatings(self) -> Coatings:
        """The nominal stack, ((E, nu, thickness), ...)."""
        return tuple((layer.E, layer.nu, layer.thickness) for layer in self.layers)


def exported(S: Array, a: Array) -> Array:
    """D [Pa] of stiffness ``S`` [N/m] at contact radius ``a`` [m], as the module's formula has it."""
    E, nu = described()["instrument"]["diamond"]
    reduced = S / (2 * described()["instrument"]["beta"] * a)
    return 1 / (1 / reduced - (1 - nu**2) / E)


@cache
def u_common() -> float:
    """Relative standard uncertainty that all rows share: of the area function and of beta.

    The bare substrate has one modulus; the standard deviation of what the instrument exports for it, with
    the area function of the film's file and down to 500 nm, is what the area function may be wrong by.
    """
    given, bare = described()["substrate"], table(described()["substrate"]["file"])
    area = table(given["area_of"])
    rows = (bare["hc"] > area["hc"][1]) & (bare["hc"] < 500e-9)
    D = exported(bare["S"][rows], np.interp(bare["hc"][rows], area["hc"], area["a"]))
    instrument = described()["instrument"]
    return float(np.hypot(D.std(ddof=1) / D.mean(), instrument["u_beta"] / instrument["beta"]))


@cache
def data_sets() -> tuple[MeasuredModulus, ...]:
    """All indentation data sets, admissible ones first in the file's order."""
    return tuple(_read(entry) for entry in described()["set"])


def _read(entry: dict[str, Any]) -> MeasuredModulus:
    rows = table(entry["file"])
    P, S, a, hc = (rows[name] for name in ("P", "S", "a", "hc"))
    epsilon = described()["instrument"]["epsilon"]
    D = exported(S, a)
    # dD/D = (D/E_r) dS/S
    share = D * 2 * described()["instrument"]["beta"] * a / S
    u_hc = np.sqrt(
        rows["sd_h"] ** 2 + (epsilon * rows["sd_P"] / S) ** 2 + (epsilon * P * rows["sd_S"] / S**2) ** 2
    )
    low, high = entry["depths"]
    return MeasuredModulus(
        name=entry["name"],
        title=entry["title"],
        source=entry["source"],
        layers=tuple(MeasuredLayer(**layer) for layer in entry["layers"]),
        a=a,
        depth=hc,
        D=D,
        u_random=share * rows["sd_S"] / S,
        u_radius=np.abs(np.gradient(a, hc)) * u_hc / a,
        u_common=u_common(),
        admitted=(low <= hc) & (hc <= high),
        because=entry["because"],
        assumed=entry["assumed"],
        reason=entry.get("reason", ""),
    )
