"""Critical load: the load at which a failure mode reaches its strength, under a load that rises from zero.

Each stress over p_h, without the residual stress, is a smooth function of log W, constant where h/a_h has no
part; p_h itself grows as W^(1/3). Where strengths scatter, so does the critical load.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from verification.problem.array_types import Array
from verification.study.choice.failure_criteria import Criteria
from verification.study.choice.thickness_choice import HALVED, strengths_drawn
from verification.study.largest_stresses import QUANTITIES
from verification.study.study_table import SOURCES

SAMPLES = 2001  # of a ramp
BAND = (0.05, 0.5, 0.95)  # quantiles of a critical load
STRESSED = ("sigma_xx_surface", "sigma_xx_base")  # to which the residual stress is added


@dataclass(frozen=True, eq=False)
class Ramp:
    """One coating under a rising ``load`` [N], (n,); ``stress`` by mode with its ``uncertainty`` [Pa], (n,).

    ratio : E1/E2.   thickness [m].   p_h, p0 [Pa] : (n,).   residual [Pa].
    """

    ratio: float
    thickness: float
    friction: float
    residual: float
    load: Array
    p_h: Array
    p0: Array
    stress: Mapping[str, Array]
    uncertainty: Mapping[str, Array]

    def at(self, load: Array, mode: str) -> Array:
        """The stress of a ``mode`` [Pa] at loads within the ramp, interpolated over p_h."""
        return self._interpolated(self.load, self.stress[mode], load, mode)

    def error(self, mode: str) -> float:
        """Error of ``at`` over the largest stress: by points left out, with the uncertainty of the stress."""
        value, U = self.stress[mode], np.nan_to_num(self.uncertainty[mode])
        largest = float(np.abs(value).max()) or 1.0
        worst = 0.0
        for i in range(1, self.load.size - 1):
            others = np.arange(self.load.size) != i
            here = self._interpolated(self.load[others], value[others], self.load[i : i + 1], mode)
            worst = max(worst, abs(float(here[0] - value[i])))
        return (worst / HALVED + float(U.max())) / largest

    def _interpolated(self, known: Array, stress: Array, load: Array, mode: str) -> Array:
        scale = self.p_h[0] / self.load[0] ** (1 / 3)
        added = self.residual if mode in STRESSED else 0.0
        over = (stress - added) / (scale * known ** (1 / 3))
        if added:
            # No tension yet, at low loads: the contact stress is below what the residual one takes away.
            tense = stress > 0
            first = over[tense][0] if tense.any() else 0.0
            over = np.where(tense, over, np.minimum(over, first))
        found = PchipInterpolator(np.log(known), over, extrapolate=True)(np.log(load))
        total = scale * load ** (1 / 3) * found + added
        return np.maximum(total, 0.0) if added else total


@dataclass(frozen=True, eq=False)
class Critical:
    """Critical loads [N] of a ramp: quantiles ``BAND``, inf where the strength is not reached within it.

    of : by mode.   first : of the first mode.   share : by mode, the probability that it is the first.
    uncertainty : of the median load of each mode, numerical.   fails : probability of failure at ``load``.
    """

    ramp: Ramp
    of: Mapping[str, tuple[float, float, float]]
    first: tuple[float, float, float]
    share: Mapping[str, float]
    uncertainty: Mapping[str, float]
    load: Array
    fails: Mapping[str, Array]

    @property
    def mode(self) -> str | None:
        """The mode that most often is the first; None where none is reached."""
        best = max(self.share, key=lambda mode: self.share[mode])
        return best if self.share[best] > 0 else None


def critical(ramp: Ramp, criteria: Criteria, between: tuple[float, float]) -> Critical:
    """The critical loads of ``ramp`` ``between`` two loads [N], which its points enclose.

    From samples of the strengths. Raises ValueError without strengths.
    """
    if criteria.strength is None:
        raise ValueError("criteria.strength is missing; a critical load needs strengths")
    load = np.geomspace(*between, SAMPLES)
    strengths = criteria.given()
    drawn = strengths_drawn(strengths)
    nominal = {mode: float(one.quantile(0.5)) for mode, one in strengths.items()}
    loads, uncertainty = [], {}
    for k, mode in enumerate(strengths):
        # Under a rising load the largest stress so far counts.
        stress = np.maximum.accumulate(criteria.safety * ramp.at(load, mode))
        loads.append(_reached(load, stress, drawn[:, k]))
        slope = np.gradient(stress, np.log(load))
        at = int(np.argmin(np.abs(stress - nominal[mode])))
        error = ramp.error(mode) * float(stress.max())
        uncertainty[mode] = float(load[at] * error / slope[at]) if slope[at] > 0 else float("nan")
    every = np.stack(loads, axis=1)
    earliest, which = every.min(axis=1), every.argmin(axis=1)
    reached = np.isfinite(earliest)
    return Critical(
        ramp,
        {mode: _band(every[:, k]) for k, mode in enumerate(strengths)},
        _band(earliest),
        {mode: float((reached & (which == k)).mean()) for k, mode in enumerate(strengths)},
        uncertainty,
        load,
        {
            mode: np.searchsorted(np.sort(earliest[which == k]), load, side="right") / len(every)
            for k, mode in enumerate(strengths)
        },
    )


def _reached(load: Array, stress: Array, strength: Array) -> Array:
    """The load [N] at which ``stress``, which never falls, reaches each ``strength``; else inf."""
    rising = np.append(True, np.diff(stress) > 0)
    exponent = np.interp(strength, stress[rising], np.log(load[rising]))
    return np.where(strength > stress[-1], np.inf, np.exp(exponent))


def _band(loads: Array) -> tuple[float, float, float]:
    low, middle, high = np.quantile(loads, BAND, method="inverted_cdf").tolist()
    return low, middle, high


def ramps(columns: Mapping[str, NDArray[Any]]) -> tuple[Ramp, ...]:
    """Every ramp of a table of loads by the semi-analytical method, of at least four loads."""
    solved = (columns["source"] == SOURCES[0]) & (columns["status"] == "solved")
    keys = np.stack([columns[name] for name in ("modulus_ratio", "thickness", "friction")], axis=1)
    found = []
    for key in np.unique(keys[solved], axis=0):
        ratio, thickness, friction = key.tolist()
        rows = np.flatnonzero(solved & (keys == key).all(axis=1))
        rows = rows[np.argsort(columns["load"][rows])]
        ramp = {name: column[rows] for name, column in columns.items()}
        if rows.size >= 4:
            found.append(
                Ramp(
                    ratio,
                    thickness,
                    friction,
                    residual=float(ramp["residual_stress"][0]),
                    load=ramp["load"],
                    p_h=ramp["p_h"],
                    p0=ramp["peak_pressure"],
                    stress={name: ramp[name] for name in QUANTITIES},
                    uncertainty={name: ramp[f"{name}_uncertainty"] for name in QUANTITIES},
                )
            )
    return tuple(found)
