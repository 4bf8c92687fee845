"""Conjugate gradients for the pressure of a rigid indenter, its approach and its contact area.

Complementarity on surface patches, u = A p the surface deflection, g0 the undeformed gap:

    g = u + g0 - delta,   g = 0 where p > 0,   g >= 0 where p = 0,   p >= 0,

with sum(p) prescribed (load control) or delta prescribed (approach control). Polonsky and Keer
(Wear 231 (1999) 206-219) with three changes: a preconditioner z = P g that keeps the load
(sum z = 0 fixes delta in each step), the deflection carried along as a linear function of the step,
one convolution an iteration while the contact set stands still, and an end test on
complementarity itself in place of the change of p.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Contact", "NotConverged", "press"]

Array = NDArray[np.floating]
Operator = Callable[[Array], Array]


class NotConverged(Exception):
    """The iteration stopped short of what was asked; the message says of what, and what to try."""


@dataclass(frozen=True)
class Contact:
    """Pressure and approach on the patches, and how well they fulfil the contact conditions.

    pressure [Pa], deflection [m] : shape of the gap.  approach [m].
    gap_inside, penetration_outside : largest |g| where p > 0 and largest -g where p = 0, over the scale
    of the gap.  load_error : relative.  history : (gap, penetration) before each iteration.
    convolutions : applications of A.
    """

    pressure: Array
    deflection: Array
    approach: float
    gap_inside: float
    penetration_outside: float
    load_error: float
    iterations: int
    convolutions: int
    history: tuple[tuple[float, float], ...]

    @classmethod
    def of_load(cls, pressure: Array) -> "Contact":
        """A pressure that was prescribed: no condition to fulfil, nothing iterated."""
        return cls(pressure, np.zeros_like(pressure), 0.0, 0.0, 0.0, 0.0, 0, 0, ())


def press(
    deflection: Operator,
    gap: Array,
    *,
    total: float | None = None,
    approach: float | None = None,
    start: Array,
    precondition: Operator,
    scale: float,
    tolerance: float,
    max_iterations: int,
) -> Contact:
    """Pressure p >= 0 that closes the gap where it acts and leaves it open elsewhere.

    deflection : u = A p, linear, symmetric, positive.  gap : g0 [m], any shape.
    total : sum of p over the patches [Pa], for load control; else approach : delta [m].
    start : first guess of p.  precondition : z = P r, about the inverse of A.
    scale : length by which gap and penetration are judged [m].  tolerance : on each of them, relative.

    Raises NotConverged after max_iterations, ValueError unless exactly one of total and approach is given.
    """
    if (total is None) == (approach is None):
        raise ValueError("give either total (load control) or approach, not both and not neither")
    p = np.maximum(start, 0.0)
    if total is not None:
        p *= total / p.sum()
    inside = p > 0
    u = deflection(p)
    convolutions = 1
    step, last_r, slope = np.zeros_like(p), np.zeros_like(p), 1.0
    restart = set_changed = True
    P_one = p
    history = []
    for iteration in range(max_iterations + 1):
        g = u + gap
        z = np.where(inside, precondition(np.where(inside, g if approach is None else g - approach, 0)), 0)
        if approach is None:
            if set_changed:
                P_one = np.where(inside, precondition(inside.astype(float)), 0)
            delta = z.sum() / P_one.sum()
            z -= delta * P_one
        else:
            delta = approach
        r = g - delta
        open_inside = float(np.max(np.abs(r), where=inside, initial=0)) / scale
        penetration = float(np.max(-r, where=~inside, initial=0)) / scale
        history.append((open_inside, penetration))
        if max(open_inside, penetration) <= tolerance:
            # recompute what was carried along: the test must hold for A p itself
            u = deflection(p)
            convolutions += 1
            r = u + gap - delta
            open_inside = float(np.max(np.abs(r), where=inside, initial=0)) / scale
            penetration = float(np.max(-r, where=~inside, initial=0)) / scale
            if max(open_inside, penetration) <= tolerance:
                error = 0.0 if total is None else abs(float(p.sum()) / total - 1)
                return Contact(
                    p,
                    u,
                    float(delta),
                    open_inside,
                    penetration,
                    error,
                    iteration,
                    convolutions,
                    tuple(history),
                )
            restart = True
        enter = ~inside & (r < 0)
        if enter.any():
            # patches that the indenter has sunk into join before the step, so that it can load them
            inside |= enter
            z = np.where(inside, precondition(np.where(inside, r, 0)), 0)
            if approach is None:
                P_one = np.where(inside, precondition(inside.astype(float)), 0)
                z -= z.sum() / P_one.sum() * P_one
            restart = True
        descent = float(np.vdot(r, z))
        beta = 0.0 if restart else max(0.0, descent - float(np.vdot(last_r, z))) / slope
        step = z + beta * step
        slope, last_r = descent, r
        Au = deflection(step)
        convolutions += 1
        alpha = float(np.vdot(r, step)) / float(np.vdot(step, Au))
        p = p - alpha * step
        negative = p < 0
        restart = set_changed = bool(negative.any())
        if set_changed:
            p[negative] = 0
            inside &= ~negative
            if total is not None:
                p *= total / p.sum()
            u = deflection(p)
            convolutions += 1
        else:
            u = u - alpha * Au
    raise NotConverged(
        f"gap in contact {open_inside:.1e} and penetration {penetration:.1e} of the scale {scale:.3g} m "
        f"after {max_iterations} iterations (asked for {tolerance:.0e}); raise max_iterations or tolerance"
    )
