"""The largest stresses of a coated contact, with their places.

One solution with unit friction speaks for every friction: the pressure does not depend on f (Goodman), so

    sigma(x) = sigma_n(x) + f sigma_t(x)

and in the plane y = 0 the two parts have opposite parity in x: those of p and of q = p are read from the
values at x and -x. Each quantity is the largest value of a spline through samples that crowd where the field
bends, evaluated once more by the solution itself at the place found; the difference of the two is what the
search may be wrong by, added to the solution's own uncertainty there.

At the contact edge the surface stress has a cusp: sigma_n is smooth outside r = a and has the root of the
pressure inside; sigma_t is smooth inside and has a root outside. The value at r = a is therefore the limit
of sigma_n from outside with that of sigma_t from inside, the same for every source.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize_scalar

from verification.problem import CoatedContact, Solution

__all__ = ["QUANTITIES", "Located", "quantities"]

Array = NDArray[np.float64]

# The columns of a study, in their order: stresses [Pa] with their place, then the scalars of the contact.
QUANTITIES = (
    "sigma_xx_surface",
    "sigma_xx_base",
    "sigma_xx_substrate",
    "sigma_xz_interface",
    "sigma_zz_interface",
    "von_mises_coating",
    "von_mises_substrate",
)

XX, YY, ZZ, XZ = range(4)
# what x -> -x does to the response to p; that to q has the opposite sign
PARITY = np.array([1.0, 1.0, 1.0, -1.0])
SKIP = 0.012  # of a; nearer to the contact edge no method is asked for a surface stress
REACH = 0.25  # of a or of h; the samples that the limits at the edge are drawn from
DENSE = 16  # places tried between two samples


@dataclass(frozen=True)
class Located:
    """``value`` with its absolute ``uncertainty`` at (x, 0, z); SI units."""

    value: float
    uncertainty: float
    x: float
    z: float


@dataclass(frozen=True)
class _Plane:
    """sigma_n and sigma_t at one depth as functions of x >= 0, each (4,) + shape of ``r``.

    knots : radii [m] between which a maximum is looked for.
    """

    z: float
    layer: int
    knots: Array
    normal: Callable[[Array], Array]
    tangential: Callable[[Array], Array]

    def __call__(self, x: Array, friction: float) -> Array:
        """xx, yy, zz, xz at signed ``x`` [m]."""
        r, left = np.abs(x), np.where(x < 0, -1.0, 1.0)
        even = PARITY.reshape(4, *[1] * x.ndim)
        return np.where(left < 0, even, 1.0) * (self.normal(r) + friction * left * self.tangential(r))


def von_mises(s: Array) -> Array:
    """sqrt(((xx - yy)^2 + (yy - zz)^2 + (zz - xx)^2)/2 + 3 xz^2) in the plane y = 0 [Pa]."""
    xx, yy, zz, xz = s
    return np.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * xz**2)


def quantities(
    solution: Solution, problem: CoatedContact, frictions: Sequence[float]
) -> dict[float, dict[str, Located]]:
    """Every stress of ``QUANTITIES`` at each friction, from one ``solution``.

    solution : of ``problem``, which has one coating, at friction 1, or 0 where that is the only one asked for.
    A tensile stress that is nowhere above zero has value 0 and no place (NaN).
    Raises what ``solution.stress`` raises.
    """
    return _Search(_Halves(solution, problem.friction), problem.interfaces[0]).run(tuple(frictions))


@dataclass(frozen=True)
class _Halves:
    """The parts of a solution's stress that p and q = p are the cause of."""

    solution: Solution
    friction: float

    def __call__(self, r: Array, z: float, layer: int) -> tuple[Array, Array]:
        """sigma_n and sigma_t at x = ``r`` >= 0, each (4,) + shape of ``r``."""
        if self.friction == 0:
            normal = _components(self.solution.stress(r, 0.0, z, layer=layer))
            return normal, np.zeros_like(normal)
        both = _components(self.solution.stress(np.stack([r, -r]), 0.0, z, layer=layer))
        right, left = both[:, 0], both[:, 1] * PARITY[:, None]
        return (right + left) / 2, (right - left) / (2 * self.friction)

    def uncertainty(self, x: Array, z: float, layer: int, friction: Array) -> Array:
        """That of sigma_n + f sigma_t, from the bounds U(x) and U(-x) of sigma_n + g sigma_t; (4,) + ``x``.

        sigma(x) = (g + f)/2g S(x) + (g - f)/2g S(-x) with the signs of the parities, where S is at friction g.
        """
        if self.solution.uncertainty is None:
            return np.full((4, x.size), np.nan)
        if self.friction == 0:
            return _components(self.solution.stress_uncertainty(x, 0.0, z, layer=layer))
        both = _components(self.solution.stress_uncertainty(np.stack([x, -x]), 0.0, z, layer=layer))
        here = (1 + friction / self.friction) / 2
        return here * both[:, 0] + np.abs(1 - here) * both[:, 1]


def _components(sigma: Array) -> Array:
    return np.stack([sigma[0, 0], sigma[1, 1], sigma[2, 2], sigma[0, 2]])


@dataclass(frozen=True)
class _Candidate:
    """A place (x, z) where ``quantity`` may be largest at ``friction``; ``guess`` is the spline's value."""

    quantity: str
    friction: float
    x: float
    z: float
    layer: int
    guess: float
    stress: Array  # of the splines, (4,)


class _Search:
    """The samples of one solution on its lines, what is looked for on them."""

    def __init__(self, halves: _Halves, h: float) -> None:
        self.halves, self.h = halves, h
        self.a = a = float(halves.solution.contact_radius)
        self.knots = _crowded(a, 0.5 * min(a, h), 2.5 * (a + h))
        self.surface = _surface(halves, a, h)
        self.upper = self._plane(h, 0)
        self.lower = self._plane(h, 1)

    def run(self, frictions: tuple[float, ...]) -> dict[float, dict[str, Located]]:
        """Candidates on every line and in every layer, evaluated together, the largest kept."""
        lines = {
            "sigma_xx_surface": (self.surface, lambda s: s[XX]),
            "sigma_xx_base": (self.upper, lambda s: s[XX]),
            "sigma_xx_substrate": (self.lower, lambda s: s[XX]),
            "sigma_xz_interface": (self.upper, lambda s: np.abs(s[XZ])),
            "sigma_zz_interface": (self.upper, lambda s: s[ZZ]),
        }
        candidates = [
            _largest(name, plane, measure, f) for name, (plane, measure) in lines.items() for f in frictions
        ]
        above = [self._plane(z, 0) for z in _depths(0.0, self.h, 0.5 * self.a)[1:-1]]
        end = self.h + 2 * self.a + 0.5 * self.h
        below = [self._plane(z, 1) for z in _depths(self.h, end, 0.5 * max(self.a / 2, self.h))[1:]]
        for name, planes in (
            ("von_mises_coating", [self.surface, *above, self.upper]),
            ("von_mises_substrate", [self.lower, *below]),
        ):
            candidates += [
                _largest(name, plane, von_mises, f) for plane in (planes[0], planes[-1]) for f in frictions
            ]
            candidates += _between(name, planes, self.knots, frictions)
        return self._settled(candidates, frictions)

    def _plane(self, z: float, layer: int) -> _Plane:
        normal, tangential = self.halves(self.knots, z, layer)
        return _Plane(
            z,
            layer,
            self.knots,
            CubicSpline(self.knots, normal, axis=1),
            CubicSpline(self.knots, tangential, axis=1),
        )

    def _settled(
        self, candidates: list[_Candidate], frictions: tuple[float, ...]
    ) -> dict[float, dict[str, Located]]:
        """The solution's own values at the candidates, the largest of each quantity with its uncertainty."""
        values: dict[int, Array] = {}
        for (z, layer), members in _by_plane(candidates).items():
            asked = [c for c in members if not self._at_edge(c)]
            if asked:
                x = np.array([c.x for c in asked])
                f = np.array([c.friction for c in asked])
                normal, tangential = self.halves(np.abs(x), z, layer)
                left = x < 0
                s = np.where(left, PARITY[:, None], 1.0) * (
                    normal + f * np.where(left, -1.0, 1.0) * tangential
                )
                values |= {id(c): s[:, i] for i, c in enumerate(asked)}
        best: dict[tuple[float, str], _Candidate] = {}
        found: dict[tuple[float, str], float] = {}
        for c in candidates:
            key = c.friction, c.quantity
            value = _measured(c.quantity, values.get(id(c), c.stress))
            if key not in found or value > found[key]:
                found[key], best[key] = value, c
        result: dict[float, dict[str, Located]] = {f: {} for f in frictions}
        for (z, layer), members in _by_plane(list(best.values())).items():
            x = np.array([self._beside(c) for c in members])
            spread = self.halves.uncertainty(x, z, layer, np.array([c.friction for c in members]))
            for i, c in enumerate(members):
                value = found[c.friction, c.quantity]
                s = values.get(id(c), c.stress)
                U = _propagated(c.quantity, s, spread[:, i]) + abs(value - c.guess)
                result[c.friction][c.quantity] = _tensile(value, U, c)
        return {f: {name: result[f][name] for name in QUANTITIES} for f in frictions}

    def _at_edge(self, c: _Candidate) -> bool:
        return c.z == 0 and abs(abs(c.x) - self.a) < SKIP * self.a * (1 - 1e-9)

    def _beside(self, c: _Candidate) -> float:
        """Where the uncertainty is asked for: at the candidate, or just outside the strip around the edge."""
        return float(np.copysign(self.a * (1 + SKIP), c.x)) if self._at_edge(c) else c.x


def _by_plane(candidates: Sequence[_Candidate]) -> dict[tuple[float, int], list[_Candidate]]:
    planes: dict[tuple[float, int], list[_Candidate]] = {}
    for c in candidates:
        planes.setdefault((c.z, c.layer), []).append(c)
    return planes


def _measured(quantity: str, s: Array) -> float:
    if quantity.startswith("von_mises"):
        return float(von_mises(s))
    if quantity.startswith("sigma_xz"):
        return float(abs(s[XZ]))
    return float(s[ZZ if quantity.startswith("sigma_zz") else XX])


def _propagated(quantity: str, s: Array, spread: Array) -> float:
    """Uncertainty of a quantity from those of the components, every term with its modulus."""
    if not quantity.startswith("von_mises"):
        return float(spread[{"xx": XX, "xz": XZ, "zz": ZZ}[quantity[6:8]]])
    value = float(von_mises(s))
    mean = s[:3].mean()
    if value == 0:
        return float(3 * spread.max())
    gradient = np.array([*(1.5 * (s[:3] - mean)), 3 * s[XZ]]) / value
    return float(np.abs(gradient) @ spread)


def _tensile(value: float, U: float, c: _Candidate) -> Located:
    """Compression is no tension: 0, uncertain by what the bound reaches above it."""
    if value > 0:
        return Located(value, U, c.x, c.z)
    return Located(0.0, max(0.0, U + value), float("nan"), float("nan"))


def _crowded(a: float, width: float, reach: float) -> Array:
    """Radii from 0 to a + ``reach`` that crowd at r = a, a tenth of ``width``/0.5 apart there."""
    low, high = np.arcsinh(-a / width), np.arcsinh(reach / width)
    count = int(np.ceil((high - low) / 0.2)) + 1
    r = a + width * np.sinh(np.linspace(low, high, count))
    r[0] = 0.0
    return r


def _depths(top: float, bottom: float, width: float) -> Array:
    """Depths from ``top`` to ``bottom`` that crowd at the top, where the field bends."""
    end = np.arcsinh((bottom - top) / width)
    count = 4 + int(2 * end)
    z = top + width * np.sinh(np.linspace(0, end, count + 1))
    z[0], z[-1] = top, bottom
    return z


def _surface(halves: _Halves, a: float, h: float) -> _Plane:
    """The surface inside and outside of the contact, joined by the limits at its edge.

    Splines in theta = arcsin(r/a) inside, eta = arcosh(r/a) outside: the roots of the edge are smooth in both.
    """
    fine = 1.0 if h > 0.3 * a else 1.4
    theta = np.linspace(0, np.arcsin(1 - SKIP), int(26 * fine))
    eta = np.linspace(np.arccosh(1 + SKIP), np.arccosh(3.5 + 2.5 * h / a), int((20 + 2 * h / a) * fine))
    inside, outside = a * np.sin(theta), a * np.cosh(eta)
    normal, tangential = halves(np.concatenate([inside, outside]), 0.0, 0)
    m = inside.size
    edge_n = _limit(outside / a - 1, normal[:, m:], min(a, h) / a)
    edge_t = _limit(1 - inside[::-1] / a, tangential[:, m - 1 :: -1], min(a, h) / a)
    # p and q vanish at the edge
    edge_n[[ZZ, XZ]], edge_t[[ZZ, XZ]] = 0.0, 0.0
    splines = []
    for values, edge in ((normal, edge_n), (tangential, edge_t)):
        within = CubicSpline(np.append(theta, np.pi / 2), np.column_stack([values[:, :m], edge]), axis=1)
        beyond = CubicSpline(np.append(0.0, eta), np.column_stack([edge, values[:, m:]]), axis=1)
        splines.append(_Joined(a, within, beyond))
    knots = np.concatenate([inside, [a], outside])
    return _Plane(0.0, 0, knots, *splines)


@dataclass(frozen=True)
class _Joined:
    a: float
    within: CubicSpline
    beyond: CubicSpline

    def __call__(self, r: Array) -> Array:
        s = r / self.a
        return np.where(
            s <= 1, self.within(np.arcsin(np.minimum(s, 1))), self.beyond(np.arccosh(np.maximum(s, 1)))
        )


def _limit(distance: Array, values: Array, width: float) -> Array:
    """Values at distance 0 of a smooth function known at SKIP and beyond; by a cubic through the nearest."""
    near = distance <= SKIP + max(REACH * width, 4 * SKIP)
    degree = min(3, int(near.sum()) - 1)
    return np.polynomial.polynomial.polyfit(distance[near], values[:, near].T, degree)[0]


def _largest(quantity: str, plane: _Plane, measure: Callable[[Array], Array], friction: float) -> _Candidate:
    """The largest ``measure`` on a line, from the trailing side on."""
    k = plane.knots
    r = np.append((k[:-1, None] + np.diff(k)[:, None] * np.arange(DENSE) / DENSE).ravel(), k[-1])
    x = np.concatenate([-r[:0:-1], r])
    value = measure(plane(x, friction))
    i = int(np.argmax(value))
    at, best = float(x[i]), float(value[i])
    if 0 < i < x.size - 1:
        found = minimize_scalar(
            lambda place: -float(measure(plane(np.array([place]), friction))[0]),
            bounds=(x[i - 1], x[i + 1]),
            method="bounded",
            options={"xatol": 1e-7 * k[-1]},
        )
        if -found.fun > best:
            at, best = float(found.x), -float(found.fun)
    return _Candidate(
        quantity, friction, at, plane.z, plane.layer, best, plane(np.array([at]), friction)[:, 0]
    )


def _between(
    quantity: str, planes: Sequence[_Plane], knots: Array, frictions: Sequence[float]
) -> list[_Candidate]:
    """The largest von Mises stress between the planes of a layer; none where it lies on the first or last."""
    fine = 8
    r = np.append((knots[:-1, None] + np.diff(knots)[:, None] * np.arange(fine) / fine).ravel(), knots[-1])
    x = np.concatenate([-r[:0:-1], r])
    depth = np.array([plane.z for plane in planes])
    z = np.append((depth[:-1, None] + np.diff(depth)[:, None] * np.arange(fine) / fine).ravel(), depth[-1])
    candidates = []
    for f in frictions:
        stress = CubicSpline(depth, np.stack([plane(x, f) for plane in planes]), axis=0)
        value = von_mises(np.moveaxis(stress(z), 1, 0))
        i, j = np.unravel_index(int(np.argmax(value)), value.shape)
        if 0 < i < z.size - 1 and 0 < j < x.size - 1:
            at_z = _vertex(z[i - 1 : i + 2], value[i - 1 : i + 2, j])
            at_x = _vertex(x[j - 1 : j + 2], value[i, j - 1 : j + 2])
            s = CubicSpline(x, stress(at_z), axis=1)(at_x)
            candidates.append(_Candidate(quantity, f, at_x, at_z, planes[1].layer, float(von_mises(s)), s))
    return candidates


def _vertex(x: Array, y: Array) -> float:
    """Where the parabola through three points is largest, within their span."""
    c = np.polyfit(x - x[1], y, 2)
    if c[0] >= 0:
        return float(x[1])
    return float(x[1] + np.clip(-c[1] / (2 * c[0]), x[0] - x[1], x[2] - x[1]))
