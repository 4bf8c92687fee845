"""The problems of the open digits: the same on every machine, every number rounded to four digits."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from math import pi

import numpy as np

from verification.problem.array_types import Coatings
from verification.problem.coated_contact import CoatedContact, PrescribedLoad

SEED = 17
RATIOS, SLIDING = (0.1, 0.25, 0.5, 2.0, 4.0, 10.0), (0.0, 0.25)
# Of the random problems: E_i/E of the substrate, h_i/a_h, Poisson's ratio, friction.
RATIO, THICKNESS, POISSON, FRICTION = (0.05, 20.0), (0.05, 3.0), (0.0, 0.495), (0.05, 0.6)
ELLIPSES = "hertz_ellipse"  # the group, whose problems both methods check
CURVED = (1.25, 2.0, 4.0, 8.0, 16.0)  # ratios of the radii: half-axes to 6.5 : 1
EACH = 75  # random problems for each number of coatings from two to five


@dataclass(frozen=True)
class VectorProblem:
    """One ``problem`` with its ``name`` and the ``group`` it belongs to."""

    name: str
    group: str
    problem: CoatedContact | PrescribedLoad


def problems() -> list[VectorProblem]:
    """Every problem, in the order of the data set."""
    found = []
    groups: tuple[tuple[str, Iterable[CoatedContact | PrescribedLoad]], ...] = (
        ("uncoated", _uncoated()),
        ("osullivan_king", _osullivan_king()),
        ("one_coating", _one_coating()),
        ("thin", _thin()),
        ("contrast", _contrast()),
        ("nearly_incompressible", _nearly_incompressible()),
        ("layers", _layers()),
        ("disc", _discs()),
        (ELLIPSES, _ellipses()),
    )
    for group, drawn in groups:
        found += [VectorProblem(f"{group}_{n:03d}", group, one) for n, one in enumerate(drawn, start=1)]
    return found


def _contact(
    coatings: Coatings, friction: float = 0.0, substrate: tuple[float, float] = (210e9, 0.3), **sphere: float
) -> CoatedContact:
    """A contact whose ``coatings`` are (E, nu, h/a_h)."""
    radius, load = sphere.get("radius", 0.01), sphere.get("load", 20.0)
    bare = CoatedContact(radius, load, (), substrate, friction)
    return replace(bare, coatings=tuple((E, nu, rounded(h * bare.a_h)) for E, nu, h in coatings))


def _uncoated() -> Iterator[CoatedContact]:
    for nu in (0.0, 0.1, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.49, 0.499):
        for friction in SLIDING:
            yield _contact((), friction, (210e9, nu))


def _osullivan_king() -> Iterator[CoatedContact]:
    """O'Sullivan and King, J. Tribol. 110 (1988) 235-240: h = a_h, nu = 0.3; published as figures only."""
    for ratio in (0.25, 0.5, 1.0, 2.0, 4.0):
        for friction in (0.0, 0.25, 0.5):
            yield _contact(((210e9 * ratio, 0.3, 1.0),), friction)


def _one_coating() -> Iterator[CoatedContact]:
    for ratio in RATIOS:
        for h in (0.1, 0.3, 1.0, 3.0):
            for friction in SLIDING:
                yield _contact(((210e9 * ratio, 0.25, h),), friction)


def _thin() -> Iterator[CoatedContact]:
    for ratio in RATIOS:
        for h in (0.02, 0.05):
            yield _contact(((210e9 * ratio, 0.3, h),))


def _contrast() -> Iterator[CoatedContact]:
    for ratio in (0.003, 0.01, 0.03, 30.0, 100.0, 300.0):
        for h in (0.3, 1.0, 3.0):
            yield _contact(((rounded(70e9 * ratio), 0.3, h),), 0.0, (70e9, 0.33))


def _nearly_incompressible() -> Iterator[CoatedContact]:
    for nu in (0.49, 0.499, 0.4999):
        for ratio in (0.01, 0.1, 1.0, 4.0):
            for h in (0.3, 1.0, 3.0):
                yield _contact(((50e9 * ratio, nu, h),), 0.0, (50e9, 0.25))


def _layers() -> Iterator[CoatedContact]:
    random = np.random.default_rng(SEED)
    for count in (2, 3, 4, 5):
        for number in range(EACH):
            E = log_uniform(random, (1e9, 5e11))
            substrate = (E, rounded(random.uniform(*POISSON)))
            coatings = tuple(
                (
                    rounded(E * log_uniform(random, RATIO)),
                    rounded(random.uniform(*POISSON)),
                    log_uniform(random, THICKNESS),
                )
                for _ in range(count)
            )
            friction = rounded(random.uniform(*FRICTION)) if number % 2 else 0.0
            radius = log_uniform(random, (1e-4, 1e-1))
            a_h = radius * log_uniform(random, (3e-3, 3e-2))
            load = rounded(4 * a_h**3 * E / (1 - substrate[1] ** 2) / (3 * radius))
            yield _contact(coatings, friction, substrate, radius=radius, load=load)


def _ellipses() -> Iterator[CoatedContact]:
    """Either axis the longer one; radius_x or radius_y is 10 mm."""
    for number, ratio in enumerate(CURVED):
        nu = (0.0, 0.2, 0.3, 0.4, 0.49)[number]
        for radii in ((0.01, rounded(0.01 / ratio)), (rounded(0.01 / ratio), 0.01)):
            mean = (radii[0] * radii[1]) ** 0.5
            yield CoatedContact(mean, 20.0, (), (210e9, nu), indenter=("ellipsoid", radii))


def _discs() -> Iterator[PrescribedLoad]:
    random = np.random.default_rng(SEED + 1)
    for count in range(6):
        for _ in range(10):
            E, a = log_uniform(random, (1e7, 5e11)), log_uniform(random, (1e-5, 0.3))
            coatings = tuple(
                (
                    rounded(E * log_uniform(random, RATIO)),
                    rounded(random.uniform(*POISSON)),
                    rounded(a * log_uniform(random, (0.1, 3.0))),
                )
                for _ in range(count)
            )
            pressure = rounded(E * 10 ** random.uniform(-5, -3) / pi)
            yield PrescribedLoad(pressure, a, coatings, (E, rounded(random.uniform(*POISSON))))


def log_uniform(random: np.random.Generator, bounds: tuple[float, float]) -> float:
    """A number between the ``bounds``, uniform in its logarithm, rounded."""
    low, high = np.log(bounds)
    return rounded(float(np.exp(random.uniform(low, high))))


def rounded(value: float, digits: int = 4) -> float:
    """``value`` with ``digits`` significant digits."""
    return float(f"{value:.{digits - 1}e}")
