"""Invariants of symmetry: mirrors of the plane of sliding, harmonics round the axis."""

import numpy as np

from verification.judging.invariant_verdict import Invariant, decide
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, ContactSolution
from verification.problem.point_answers import Points

RADII = np.array([0.3, 0.7])
# Off every mirror plane, mapped onto one another by both mirrors.
TURNS = 2 * np.pi * (np.arange(8) + 0.5) / 8
MIRROR = ((3 - np.arange(8)) % 8, 7 - np.arange(8))


def symmetry(solution: ContactSolution, source: str, problem: CoatedContact) -> tuple[Invariant, ...]:
    """Mirror images, and round the axis A plus, with friction alone, one harmonic:

        rr, tt, zz, rz = A + B cos(theta),   rt, tz = C sin(theta),   B = C = 0 without friction

    Bounded by the uncertainties of all stresses that enter.
    """
    r = solution.contact_radius * RADII[:, None]
    x, y = r * np.cos(TURNS), r * np.sin(TURNS)
    sigma, U = [], []
    for z, layer in _depths(solution, problem):
        stress, spread = solution.sample(Points(x, y, z, layer), "stress")
        sigma.append(stress / problem.p_h)
        if spread is not None:
            U.append(spread / problem.p_h)
    s = np.stack(sigma, axis=2)
    stated = bool(U)
    u = np.stack(U, axis=2) if stated else np.zeros_like(s)
    found = []
    for axis, name in ((0, "x"), (1, "y")):
        if axis == 0 and problem.friction:
            continue  # sliding has no such mirror; the harmonics check what remains of it
        flip = np.ones(3)
        flip[axis] = -1.0
        image = np.einsum("i,j,ij...->ij...", flip, flip, s[..., MIRROR[axis]])
        law = f"sigma is its own mirror image in {name} = 0, over p_h"
        bound = u + u[..., MIRROR[axis]] if stated else None
        found.append(decide(f"mirror in {name}", source, law, s - image, bound))
    residual, bound = _beyond_harmonics(s, u, friction=problem.friction > 0)
    law = f"sigma has {'one' if problem.friction else 'no'} harmonic round the axis, over p_h"
    found.append(decide("harmonics round the axis", source, law, residual, bound if stated else None))
    return tuple(found)


def _beyond_harmonics(s: Array, u: Array, *, friction: bool) -> tuple[Array, Array]:
    """Stresses (3, 3, ..., turns) less their mean and first harmonic, with the bound of the remainder."""
    cos, sin = np.cos(TURNS), np.sin(TURNS)
    zero = np.zeros_like(cos)
    turn = np.array([[cos, sin, zero], [-sin, cos, zero], [zero, zero, zero + 1]])
    s = np.einsum("ain,bjn,ij...n->ab...n", turn, turn, s)
    u = np.einsum("ain,bjn,ij...n->ab...n", np.abs(turn), np.abs(turn), u)
    odd = np.zeros((3, 3), dtype=bool)
    odd[[0, 1, 1, 2], [1, 0, 2, 1]] = True
    odd = odd.reshape(3, 3, *(1,) * (s.ndim - 2))
    fitted = np.where(odd, 0.0, s.mean(-1, keepdims=True))
    bound = u + np.where(odd, 0.0, u.mean(-1, keepdims=True))
    if friction:
        once = np.where(odd, sin, cos)
        fitted = fitted + 2 * once * (s * once).mean(-1, keepdims=True)
        bound = bound + 2 * np.abs(once) * (u * np.abs(once)).mean(-1, keepdims=True)
    return s - fitted, bound


def _depths(solution: ContactSolution, problem: CoatedContact) -> list[tuple[float, int]]:
    """A quarter of a radius down, in whichever layer that is, and half a radius into the substrate."""
    a, z = solution.contact_radius, problem.interfaces
    shallow = 0.25 * a
    layer = int(np.searchsorted(z, shallow))
    return [(shallow, layer), ((z[-1] if z else 0.0) + 0.5 * a, len(z))]
