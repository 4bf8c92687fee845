"""Solids in contact: their combined modulus and compliance, and the radius that follows from both."""

import numpy as np

from verification.problem.array_types import Array, Ball, Coatings
from verification.sources.references.layered_half_space import LayeredHalfSpace, contact_modulus

Solid = tuple[Coatings, tuple[float, float]]


def solids_of(
    coatings: Coatings, substrate: tuple[float, float], ball: Ball | None = None
) -> tuple[Solid, ...]:
    """The flat, then an elastic ball."""
    return ((coatings, substrate),) if ball is None else ((coatings, substrate), (ball[2], ball[:2]))


def combined_modulus(solids: tuple[Solid, ...]) -> float:
    """E* [Pa] of the top layers of the ``solids`` together."""
    moduli = [contact_modulus(*solid) for solid in solids]
    return moduli[0] if len(moduli) == 1 else 1 / sum(1 / E for E in moduli)


def outer_thickness(solids: tuple[Solid, ...], default: float) -> float:
    """Least thickness h1 [m] of the outer coatings, ``default`` where there is none.

    M - 1 falls as exp(-2 k h1), so that the kernel is smooth over h1, however thin the layers below.
    """
    return min((coatings[0][2] for coatings, _ in solids if coatings), default=default)


def compliance(solids: tuple[Solid, ...], E_star: float, k: Array) -> Array:
    """M(k) of the ``solids`` together."""
    responses = [LayeredHalfSpace(*solid, k).compliance if solid[0] else np.ones_like(k) for solid in solids]
    if len(solids) == 1:
        return responses[0]
    shares = [E_star / contact_modulus(*solid) for solid in solids]
    return np.sum([share * M for share, M in zip(shares, responses, strict=True)], axis=0)


def radius_estimate(radius: float, load: float, E_star: float, solids: tuple[Solid, ...]) -> float:
    """Hertz radius with the contact modulus seen by waves of that very length."""
    a = float((3 * load * radius / (4 * E_star)) ** (1 / 3))
    for _ in range(40):
        before, M = a, float(compliance(solids, E_star, np.array([2.0 / a]))[0])
        a = 0.5 * (a + float((3 * load * radius * M / (4 * E_star)) ** (1 / 3)))
        if abs(a - before) < 1e-9 * a:
            break
    return a
