"""Random coated contacts as case files.

    problem = draw(seed, number)

The same seed with the same number is the same problem on every machine: the random numbers are rounded to
four digits and written as a case file, which is then read and solved.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from math import log

import numpy as np

from verification.cases.drawn_ranges import (
    CLOSE_RATIO,
    ELLIPSE_POISSON,
    ELONGATION,
    FILM_RATIO,
    FILM_THICKNESS,
    FRICTION,
    MOST_COATINGS,
    MOST_FILMS,
    OF_SHORT_AXIS,
    OVER_INTERLAYER,
    POISSON,
    RATIO,
    SLIDING,
    THICKNESS,
    THINNEST,
)

# Of ellipses.
LARGE_RADIUS, LOAD, STEEL = 20e-3, 20.0, 210e9  # m, N, Pa
ELASTIC = 0.5  # share of the problems with an elastic ball, of no coating to three
FRICTIONLESS = 1 / 3  # share of the problems with f = 0, the only ones with a symmetric stress
# Linear elasticity has no length scale: these ranges only exclude an effect of the units.
RADIUS = (1e-4, 1e-1)  # m
MODULUS = (1e9, 5e11)  # Pa, of the substrate
FLATNESS = (3e-3, 3e-2)  # a_h / R


@dataclass(frozen=True)
class Draw:
    """One problem as a case file: its ``name``, its ``title``, its TOML ``text``."""

    name: str
    title: str
    text: str


def draw(seed: int, number: int, films: bool = False) -> Draw:
    """Problem ``number`` of the sequence ``seed``.

    Moduli, thicknesses, radius are uniform in their logarithm, Poisson's ratios as well as friction
    uniform; one to five coatings. In half of the problems THICKNESS is that of each coating, in the
    other half that of the whole stack, divided at random, so that more films are thin, down to THINNEST.
    The ball is drawn last, from the same ranges.

    films : a thin film, alone or below another, under a ball without coatings.
    """
    random = np.random.default_rng([seed, number])
    count = int(random.integers(1, (MOST_FILMS if films else MOST_COATINGS) + 1))
    E = _log_uniform(random, MODULUS)
    ratios = [_log_uniform(random, FILM_RATIO if films else RATIO) for _ in range(count)]
    poisson = [_rounded(random.uniform(*POISSON)) for _ in range(count + 1)]
    thin = (OVER_INTERLAYER, FILM_THICKNESS)[-count:] if films else ()
    thicknesses = [_log_uniform(random, h) for h in thin] or _thicknesses(random, count)
    sliding = random.uniform() >= FRICTIONLESS
    friction = _rounded(random.uniform(*FRICTION)) if sliding else 0.0
    radius = _log_uniform(random, RADIUS)
    a_h = radius * _log_uniform(random, FLATNESS)
    compliance, ball, on_ball = (1 - poisson[-1] ** 2) / E, "", []
    if random.uniform() < ELASTIC:
        most = 0 if films else MOST_COATINGS
        E_ball, more = _log_uniform(random, RATIO) * E, int(random.integers(0, most + 1))
        E_ball, nu = _rounded(E_ball), _rounded(random.uniform(*POISSON))
        on_ball = [
            f"{{ E = {_rounded(_log_uniform(random, RATIO) * E_ball)!r}, "
            f"nu = {_rounded(random.uniform(*POISSON))!r}, thickness_over_a_h = {h!r} }}"
            for h in _thicknesses(random, more)
        ]
        ball = f"ball = {{ E = {E_ball!r}, nu = {nu!r}, coatings = [{', '.join(on_ball)}] }}"
        compliance += (1 - nu**2) / E_ball
    load = _rounded(4 * a_h**3 / (3 * radius * compliance))

    layers = ", ".join(f"E1/E2 = {r:.3g}, h = {h:.3g} a_h" for r, h in zip(ratios, thicknesses, strict=True))
    kind = "films" if films else "draw"
    title = f"{kind.capitalize()} {number} of seed {seed}: {layers}"
    title += f", f = {friction:.3g}" if friction else ""
    title += f", elastic ball, coatings on it: {len(on_ball)}" if ball else ""
    given = [
        f"radius = {radius!r}",
        f"load = {load!r}",
        f"friction = {friction!r}",
        f"substrate = {{ E = {E!r}, nu = {poisson[-1]!r} }}",
        *([ball] if ball else []),
    ]
    moduli = [_rounded(ratio * E) for ratio in ratios]
    coatings = zip(moduli, poisson, thicknesses, strict=False)
    return Draw(f"{kind}_{seed}_{number:03d}", title, _text(title, given, coatings))


def draw_ellipse(seed: int, number: int) -> Draw:
    """Ellipsoid ``number`` of the sequence ``seed`` on one coating; x is its long or its short axis.

    The ellipsoid is rigid or, in half of the problems, elastic, bare or with one coating of its own.
    """
    random = np.random.default_rng([seed, number])
    elongation = random.uniform(*ELONGATION)
    ratio, h = (float(np.exp(random.uniform(*np.log(bounds)))) for bounds in (CLOSE_RATIO, OF_SHORT_AXIS))
    nu, nu_below = random.uniform(*ELLIPSE_POISSON, 2)
    friction = float(random.choice(SLIDING))
    radii = [_rounded(LARGE_RADIUS / elongation**1.5), LARGE_RADIUS]
    if random.uniform() < 0.5:
        radii.reverse()
    title = f"Ellipse {number} of seed {seed}: about {elongation:.3g} : 1, E1/E2 = {ratio:.3g}, h = {h:.3g} b"
    given = [
        f'indenter = {{ shape = "ellipsoid", radii = {radii!r} }}',
        f"load = {LOAD!r}",
        f"friction = {friction!r}",
        f"substrate = {{ E = {STEEL!r}, nu = {_rounded(nu_below)!r} }}",
    ]
    if random.uniform() < ELASTIC:
        (E_body, nu_body, _), own = (_close_layer(random, elongation) for _ in range(2))
        coated = random.uniform() < 0.5
        layer = "{{ E = {!r}, nu = {!r}, thickness_over_a_h = {!r} }}".format(*own) if coated else ""
        given.append(f"ball = {{ E = {E_body!r}, nu = {nu_body!r}, coatings = [{layer}] }}")
        title += f", elastic body, coatings on it: {int(coated)}"
    coating = _rounded(ratio * STEEL), _rounded(nu), _rounded(h / elongation**0.5)
    text = _text(f"{title}, f = {friction:.3g}", given, [coating])
    return Draw(f"ellipse_{seed}_{number:03d}", title, text)


def _close_layer(random: np.random.Generator, elongation: float) -> tuple[float, float, float]:
    """E [Pa], nu, h / a_h of a layer as under an ellipse."""
    ratio, h = (float(np.exp(random.uniform(*np.log(bounds)))) for bounds in (CLOSE_RATIO, OF_SHORT_AXIS))
    nu = float(random.uniform(*ELLIPSE_POISSON))
    return _rounded(ratio * STEEL), _rounded(nu), _rounded(h / elongation**0.5)


def _text(title: str, given: list[str], coatings: Iterable[tuple[float, float, float]]) -> str:
    """A case file; ``coatings`` : E [Pa], nu, h / a_h."""
    lines = [f'title = "{title}"', 'source = "drawn at random"', "[problem]", *given]
    for E, nu, h in coatings:
        lines += ["[[problem.coatings]]", f"E = {E!r}", f"nu = {nu!r}", f"thickness_over_a_h = {h!r}"]
    return "\n".join(lines) + "\n"


def _thicknesses(random: np.random.Generator, coatings: int) -> list[float]:
    """h / a_h of each coating."""
    if coatings == 0 or random.uniform() < 0.5:
        return [_log_uniform(random, THICKNESS) for _ in range(coatings)]
    shares = random.dirichlet(np.ones(coatings))
    total = _log_uniform(random, THICKNESS)
    return [max(_rounded(total * share), THINNEST) for share in shares]


def _log_uniform(random: np.random.Generator, bounds: tuple[float, float]) -> float:
    low, high = bounds
    return min(max(_rounded(float(np.exp(random.uniform(log(low), log(high))))), low), high)


def _rounded(value: float) -> float:
    return float(f"{value:.4g}")
