"""Random coated contacts as case files.

    problem = draw(seed, number)

The same seed with the same number is the same problem on every machine: the random numbers are rounded to
four digits and written as a case file, which is then read and solved.
"""

from dataclasses import dataclass
from math import log

import numpy as np

# Ranges of the problems.
RATIO = (0.02, 50.0)  # E_i / E of the substrate, of every coating
THICKNESS = (0.02, 10.0)  # h / a_h, of each coating or of all together
THINNEST = 0.02  # h / a_h of a coating where THICKNESS is that of all together
POISSON = (0.0, 0.49)  # of every layer
FRICTION = (0.0, 0.8)
MOST_COATINGS = 5
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


def draw(seed: int, number: int) -> Draw:
    """Problem ``number`` of the sequence ``seed``.

    Moduli, thicknesses, radius are uniform in their logarithm, Poisson's ratios as well as friction
    uniform; one to five coatings. In half of the problems THICKNESS is that of each coating, in the
    other half that of the whole stack, divided at random, so that more films are thin, down to THINNEST.
    """
    random = np.random.default_rng([seed, number])
    coatings = int(random.integers(1, MOST_COATINGS + 1))
    E = _log_uniform(random, MODULUS)
    ratios = [_log_uniform(random, RATIO) for _ in range(coatings)]
    poisson = [_rounded(random.uniform(*POISSON)) for _ in range(coatings + 1)]
    if random.uniform() < 0.5:
        thicknesses = [_log_uniform(random, THICKNESS) for _ in range(coatings)]
    else:
        shares = random.dirichlet(np.ones(coatings))
        total = _log_uniform(random, THICKNESS)
        thicknesses = [max(_rounded(total * share), THINNEST) for share in shares]
    sliding = random.uniform() >= FRICTIONLESS
    friction = _rounded(random.uniform(*FRICTION)) if sliding else 0.0
    radius = _log_uniform(random, RADIUS)
    a_h = radius * _log_uniform(random, FLATNESS)
    load = _rounded(4 * a_h**3 * E / (1 - poisson[-1] ** 2) / (3 * radius))

    layers = ", ".join(f"E1/E2 = {r:.3g}, h = {h:.3g} a_h" for r, h in zip(ratios, thicknesses, strict=True))
    title = f"Draw {number} of seed {seed}: {layers}" + (f", f = {friction:.3g}" if friction else "")
    lines = [
        f'title = "{title}"',
        'source = "drawn at random"',
        "[problem]",
        f"radius = {radius!r}",
        f"load = {load!r}",
        f"friction = {friction!r}",
        f"substrate = {{ E = {E!r}, nu = {poisson[-1]!r} }}",
    ]
    for ratio, nu, h in zip(ratios, poisson, thicknesses, strict=False):
        lines += [
            "[[problem.coatings]]",
            f"E = {_rounded(ratio * E)!r}",
            f"nu = {nu!r}",
            f"thickness_over_a_h = {h!r}",
        ]
    return Draw(f"draw_{seed}_{number:03d}", title, "\n".join(lines) + "\n")


def _log_uniform(random: np.random.Generator, bounds: tuple[float, float]) -> float:
    low, high = bounds
    return min(max(_rounded(float(np.exp(random.uniform(log(low), log(high))))), low), high)


def _rounded(value: float) -> float:
    return float(f"{value:.4g}")
