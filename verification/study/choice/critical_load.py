"""Critical load: the load at which a failure mode reaches its strength, under a load that rises from zero.

Each stress over p_h, without the residual stress, is a smooth function of log W, constant where h/a_h has no
part; p_h itself grows as W^(1/3). Where strengths scatter, so does the critical load.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import ceil, log10
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from verification.cases.case_file import SUPPORTED
from verification.problem.array_types import Array
from verification.study.choice.failure_criteria import Criteria
from verification.study.choice.thickness_choice import HALVED, strengths_drawn
from verification.study.largest_stresses import QUANTITIES
from verification.study.study_plan import Study
from verification.study.study_table import SOURCES

SAMPLES = 2001  # of a ramp
BAND = (0.05, 0.5, 0.95)  # quantiles of a critical load
STRESSED = ("sigma_xx_surface", "sigma_xx_base")  # to which the residual stress is added
WEAKEST = 1e-3  # share of strengths that may be reached below the first load of a ramp
MARGIN = 0.5  # of the load at which a ramp begins, as estimated from that of Hertz
DECADE = 8  # loads in each decade of a ramp that was extended


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

    def at_rest(self, mode: str) -> float:
        """The stress of a ``mode`` [Pa] at no load: that of the residual stress, negative in compression."""
        if mode in STRESSED:
            return self.residual
        return abs(self.residual) if mode == "von_mises_coating" else 0.0

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

    A load is 0 where the strength is reached below the first load of the ramp.
    of : by mode.   first : of the first mode.   share : by mode, the probability that it is the first.
    unresolved : the probability that several are reached at once, as below the ramp, and none is the first.
    at_rest : the modes whose strength the residual stress reaches alone.
    uncertainty : of the median load of each mode, numerical.   fails : probability of failure at ``load``.
    """

    ramp: Ramp
    of: Mapping[str, tuple[float, float, float]]
    first: tuple[float, float, float]
    share: Mapping[str, float]
    uncertainty: Mapping[str, float]
    load: Array
    fails: Mapping[str, Array]
    unresolved: float = 0.0
    at_rest: tuple[str, ...] = ()

    @property
    def mode(self) -> str | None:
        """The mode that most often is the first; None where none is reached, or it is not resolved."""
        best = max(self.share, key=lambda mode: self.share[mode])
        return best if self.share[best] > self.unresolved else None


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
    tied = np.isfinite(earliest) & ((every == earliest[:, None]).sum(axis=1) > 1)
    reached = np.isfinite(earliest) & ~tied
    return Critical(
        ramp,
        {mode: _band(every[:, k]) for k, mode in enumerate(strengths)},
        _band(earliest),
        {mode: float((reached & (which == k)).mean()) for k, mode in enumerate(strengths)},
        uncertainty,
        load,
        {
            mode: np.searchsorted(np.sort(earliest[reached & (which == k)]), load, side="right") / len(every)
            for k, mode in enumerate(strengths)
        },
        float(tied.mean()),
        tuple(mode for mode in strengths if criteria.safety * ramp.at_rest(mode) >= nominal[mode]),
    )


def extended(study: Study, columns: Mapping[str, NDArray[Any]]) -> Study | None:
    """The ``study`` with loads that begin lower, as far as its table ``columns`` shows that they have to.

    None where every mode is below its strength at the first load, its residual stress alone reaches it, or
    no lower load is supported.
    """
    assert study.loads is not None
    low, high, count = study.loads
    lower = low
    for ramp in ramps(columns):
        for mode, strength in study.criteria.given().items():
            least = float(strength.quantile(WEAKEST)) / study.criteria.safety
            rest, stress = ramp.at_rest(mode), float(ramp.at(np.array([low]), mode)[0])
            if rest < least <= stress:
                # The part of the contact grows as the cubic root of the load.
                lower = min(lower, MARGIN * low * ((least - rest) / (stress - rest)) ** 3)
    thick = max(study.thicknesses) / (SUPPORTED[1] * study.bare.a_h)
    lower = max(lower, 1.001 * study.load * thick**3)
    if lower > 0.999 * low:
        return None
    every = max(count, ceil(DECADE * log10(high / lower)) + 1)
    asked = study.asked_from if study.asked_from is not None else low
    return replace(study, loads=(lower, high, every), asked_from=asked)


def _reached(load: Array, stress: Array, strength: Array) -> Array:
    """The load [N] at which ``stress``, which never falls, reaches each ``strength``; else 0 or inf."""
    rising = np.append(True, np.diff(stress) > 0)
    exponent = np.interp(strength, stress[rising], np.log(load[rising]))
    within = np.where(strength > stress[-1], np.inf, np.exp(exponent))
    return np.where(strength < stress[0], 0.0, within)


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
