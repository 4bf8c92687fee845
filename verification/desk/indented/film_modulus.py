"""Modulus of a film from a measured indentation curve, elastic part only.

The exact reference (``integral_equation``) gives load P, approach delta and stiffness S = dP/d delta of every
contact radius a on the layers, ball included. E of one film is fitted by least squares to

    depth      delta(P)      stiffness   S(P)      radius   a(P)      of a ball,
    punch      S(a)          of any tip, whose stiffness is that of a flat punch of its contact radius
                             (Pharr, Oliver and Brotzen, J. Mater. Res. 7 (1992) 613-617), times beta.

The interval is Student's, from the scatter of the rows about the fit, whatever its course along the curve
(residuals over 1 - leverage: MacKinnon and White, J. Econometrics 29 (1985) 305-325, HC3); residuals that
follow each other, with correlation r, count as (1 - r)/(1 + r) as many. What the other inputs add is told as
the change of E by 1 % of each.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import least_squares
from scipy.stats import t as student

from verification.desk.indented.indentation_curve import IndentationCurve
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact
from verification.sources.exact_sources import solve_exactly
from verification.sources.references.integral_equation import Equation
from verification.sources.references.solids_in_contact import combined_modulus, radius_estimate, solids_of

KINDS = {  # what is fitted, over what
    "depth": ("depth", "load"),
    "stiffness": ("stiffness", "load"),
    "radius": ("radius", "load"),
    "punch": ("stiffness", "radius"),
}
RADII = 16  # contact radii of a curve; a cubic spline between their logarithms leaves 1e-5
RESOLUTION: Any = {"nodes": 40, "panel": 10, "tail": 20.0}  # of the integral equation: eight digits
SCANNED = np.geomspace(1e-3, 1e3, 7)  # of the substrate's modulus, where the search for E begins
LEVEL = 0.95
UNKNOWN = 1.0  # of ln E: a film whose interval is wider is not measured by the curve


@dataclass(frozen=True, eq=False)
class FilmFit:
    """``E`` [Pa] of a film with its interval, ``low`` to ``high``, from a curve of a ``kind`` of ``KINDS``.

    x, y, fitted : measured and fitted values [SI].   band : fitted ones at both ends.   zero : depth [m] of
    first contact.
    inputs : change of E over E by 1 % more of each.   correlation : of residuals that follow each other.
    radius, peak : contact radius [m] and peak pressure [Pa], of a ball, at the largest x.
    """

    kind: str
    E: float
    low: float
    high: float
    x: Array
    y: Array
    fitted: Array
    band: tuple[Array, Array]
    zero: float
    inputs: dict[str, float]
    correlation: float
    radius: float
    peak: float

    @property
    def rms(self) -> float:
        """Root mean square of the residuals [SI]."""
        return float(np.sqrt(np.mean((self.y - self.fitted) ** 2)))

    @property
    def determined(self) -> bool:
        """Whether the curve measures the film at all."""
        return bool(np.log(self.high / self.low) < 2 * UNKNOWN)


def with_film(problem: CoatedContact, film: int, E: float) -> CoatedContact:
    """``problem`` with another modulus of one coating."""
    layers = list(problem.coatings)
    layers[film] = (E, *layers[film][1:])
    return replace(problem, coatings=tuple(layers))


def computed(problem: CoatedContact, kind: str, x: Array, beta: float = 1.0) -> Array:
    """The exact curve of a ``kind`` at loads [N] or contact radii [m] ``x``."""
    a, load, approach, stiffness = _states(problem, kind, x)
    over = a if kind == "punch" else load
    value = {"depth": approach, "radius": a}.get(kind, beta * stiffness)
    return np.asarray(np.exp(CubicSpline(np.log(over), np.log(value))(np.log(x))))


def _states(problem: CoatedContact, kind: str, x: Array) -> tuple[Array, ...]:
    """Contact radius, load, approach, stiffness, around those of ``x``."""
    solids = solids_of(problem.coatings, problem.substrate, problem.ball)
    E_star, ends = combined_modulus(solids), (float(x.min()), float(x.max()))
    if kind != "punch":
        low, high = (radius_estimate(problem.radius, load, E_star, solids) for load in ends)
        ends = 0.8 * low, 1.25 * high
    found = []
    for a in np.geomspace(0.999 * ends[0], 1.001 * ends[1], RADII):
        equation = Equation(problem.radius, solids, float(a), **RESOLUTION)
        phi, approach, stiffness = equation.at(float(a))
        found.append((float(a), equation.carried(float(a), phi), approach, stiffness))
    return tuple(np.array(found).T)


def film_modulus(
    problem: CoatedContact,
    film: int,
    curve: IndentationCurve,
    kind: str,
    beta: float = 1.0,
    *,
    zero: bool = False,
) -> FilmFit:
    """Fit E of coating ``film`` of ``problem``, which has all but this, to a measured ``curve``.

    beta : factor of the stiffness of a tip that is not round.   zero : fit the zero of the depth too.
    Raises ValueError where no modulus within a thousandth and a thousand times the substrate's fits.
    """
    of, over = KINDS[kind]
    x, y = curve.values[over], curve.values[of]
    model = partial(computed, kind=kind, x=x, beta=beta)

    def at(u: float, change: float = 0.0) -> Array:
        return model(with_film(problem, film, float(np.exp(u)))) + change

    scanned = np.log(problem.substrate[0] * SCANNED)
    curves = []
    for u in scanned:
        try:
            curves.append(at(u))
        except (ValueError, ArithmeticError):  # digits lost at an extreme ratio
            curves.append(np.full(x.size, np.nan))
    weight = _weights(curve, of, over, curves)

    def misfit(one: Array) -> float:
        shift = np.average(y - one, weights=weight**2) if zero else 0.0
        return float(np.sum((weight * (y - one - shift)) ** 2))

    start = int(np.nanargmin([misfit(one) for one in curves]))
    scale = float(np.ptp(y))  # of the zero, beside ln E
    bounds = scanned[max(start - 1, 0)], scanned[min(start + 1, scanned.size - 1)]
    found = least_squares(
        lambda p: weight * (at(p[0], scale * p[1] if zero else 0.0) - y),
        [float(np.clip(scanned[start], bounds[0] + 1e-3, bounds[1] - 1e-3)), 0.0][: 1 + zero],
        bounds=([bounds[0], -np.inf][: 1 + zero], [bounds[1], np.inf][: 1 + zero]),
        x_scale=[0.1, 0.01][: 1 + zero],
        diff_step=1e-4,
        xtol=1e-8,
        ftol=1e-12,
        gtol=1e-12,
    )
    u, shift = float(found.x[0]), scale * float(found.x[1]) if zero else 0.0
    if min(abs(u - scanned[0]), abs(u - scanned[-1])) < 1e-2:
        raise ValueError(
            f"no modulus of the film between {SCANNED[0]:g} and {SCANNED[-1]:g} times the substrate's fits; "
            "check units, thickness, radius, and that the first row is at first contact"
        )
    fitted = at(u, shift)
    J = weight[:, None] * np.stack(
        [(at(u + 1e-3) - at(u - 1e-3)) / 2e-3, *([np.ones_like(x)] if zero else [])], 1
    )
    inverse = np.linalg.inv(J.T @ J)
    residual = weight * (y - fitted)
    leverage = np.einsum("ij,jk,ik->i", J, inverse, J)
    cloud = J * (residual / np.maximum(1 - leverage, 1e-6))[:, None]
    r = float(np.sum(residual[1:] * residual[:-1]) / max(float(np.sum(residual**2)), 1e-300))
    follows = min(r, 0.95) if r > 2 / np.sqrt(x.size) else 0.0
    u_E = float(np.sqrt((inverse @ (cloud.T @ cloud) @ inverse)[0, 0] * (1 + follows) / (1 - follows)))
    half = min(float(student.ppf((1 + LEVEL) / 2, x.size - J.shape[1])) * u_E, 700.0)
    fit_of = inverse @ J.T * weight
    here = with_film(problem, film, float(np.exp(u)))
    inputs = {
        name: -float((fit_of @ (model(moved) - model(here)))[0]) for name, moved in _moved(here, film, kind)
    }
    inputs[f"every {of} measured"] = float((fit_of @ (0.01 * y))[0])
    inputs[f"every {over} measured"] = -float((fit_of @ (model(here, x=1.01 * x) - model(here)))[0])
    a, load, *_ = _states(here, kind, x)
    largest = float(np.exp(np.interp(np.log(x.max()), np.log(a if kind == "punch" else load), np.log(a))))
    ends = [at(float(np.clip(u + s * half, scanned[0], scanned[-1])), shift) for s in (-1, 1)]
    E, peak = float(np.exp(u)), float("nan")
    if kind != "punch":
        pressed = replace(here, load=float(x.max()))
        peak = solve_exactly(pressed, {"estimate_uncertainty": False}).peak_pressure
    return FilmFit(
        kind,
        E,
        E * float(np.exp(-half)),
        E * float(np.exp(half)),
        x,
        y,
        fitted,
        (ends[0], ends[1]),
        shift,
        inputs,
        r,
        largest,
        peak,
    )


def _weights(curve: IndentationCurve, of: str, over: str, curves: list[Array]) -> Array:
    """One over the standard deviation of each row where given, in the mean one over the range of ``of``."""
    x, y = curve.values[over], curve.values[of]
    if of not in curve.sd:
        return np.full(y.size, 1 / np.ptp(y))
    nearest = curves[
        int(np.nanargmin([np.nansum((y - one) ** 2) if one[0] == one[0] else np.nan for one in curves]))
    ]
    order = np.argsort(x, kind="stable")
    distinct = np.concatenate([[True], np.diff(x[order]) > 0])
    slope = np.zeros_like(y)
    slope[order] = np.interp(
        x[order], x[order][distinct], np.gradient(nearest[order][distinct], x[order][distinct])
    )
    sd = np.hypot(curve.sd[of], slope * curve.sd.get(over, np.zeros_like(y)))
    weight = 1 / np.maximum(sd, 0.05 * np.median(sd))
    return np.asarray(weight / weight.mean() / np.ptp(y))


def _moved(problem: CoatedContact, film: int, kind: str) -> Iterator[tuple[str, CoatedContact]]:
    """The problem with 1 % more of each input."""
    layers, (E, nu) = list(problem.coatings), problem.substrate
    for i, (modulus, poisson, h) in enumerate(layers):
        name = "the film" if i == film else f"coating {i + 1}"
        for what, layer in (
            ("thickness", (modulus, poisson, 1.01 * h)),
            ("nu", (modulus, 1.01 * poisson, h)),
            ("E", (1.01 * modulus, poisson, h)),
        ):
            if what != "E" or i != film:
                yield f"{what} of {name}", replace(problem, coatings=(*layers[:i], layer, *layers[i + 1 :]))
    yield "E of the substrate", replace(problem, substrate=(1.01 * E, nu))
    if problem.ball is not None:
        E, nu, coatings = problem.ball
        yield "E of the ball", replace(problem, ball=(1.01 * E, nu, coatings))
    if kind != "punch":
        yield "radius of the ball", replace(problem, radius=1.01 * problem.radius)
