"""Constrained conjugate gradients for the pressure of a rigid indenter.

Complementarity on surface patches, u = A p the surface deflection, g0 the undeformed gap:

    g = u + g0 - delta,   g = 0 where p > 0,   g >= 0 where p = 0,   p >= 0,

with sum(p) prescribed (load control) or delta prescribed (approach control). As Polonsky and Keer (Wear
231 (1999) 206-219, section 3), with five changes: a preconditioner z = P g that keeps the load (sum z = 0
fixes delta in each step); g extended beyond the contact before P, an approximate inverse of A on the whole
plane, is applied (cut off at the edge it would cause large pressures there: twice the iterations, three times
under thin stiff coatings); the deflection updated with the pressure, one convolution per iteration; the
contact set kept until its residual has fallen, tension allowed meanwhile, then updated at once to the set
predicted for a vanishing residual (the primal-dual active set of Hintermueller, Ito and Kunisch, SIAM J.
Optim. 13 (2002) 865-888, with inexact inner solves); a stopping criterion on complementarity itself instead
of the change of p.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from semianalytic import numbers

Array = NDArray[np.floating]
Mask = NDArray[np.bool_]
Operator = Callable[[Array], Array]


class NotConverged(Exception):
    """The iteration ended before the tolerance was met; the message gives the quantity and a remedy."""


@dataclass(frozen=True, eq=False)
class Contact:
    """Pressure and approach on the patches, and how well they fulfil the contact conditions.

    pressure [Pa], gap [m] : shape of the undeformed gap.  approach [m].
    gap_inside, penetration_outside : largest |g| where p > 0 and largest -g where p = 0, over the scale
    of the gap.  load_error : relative.  history : (gap, penetration) before each iteration.
    convolutions : applications of A.  left : largest change of p [Pa] by a further step, z = P g, A^-1 of the
    gap left; inf where P was that of a half-space.
    """

    pressure: Array
    gap: Array
    approach: float
    gap_inside: float
    penetration_outside: float
    load_error: float
    iterations: int
    convolutions: int
    history: tuple[tuple[float, float], ...]
    left: float = 0.0

    @classmethod
    def of_load(cls, pressure: Array) -> "Contact":
        """A prescribed pressure: no condition to fulfil, no iteration."""
        return cls(pressure, np.zeros_like(pressure), 0.0, 0.0, 0.0, 0.0, 0, 1, ())

    def embedded(self, where: tuple[slice, slice], shape: tuple[int, int], open_gap: float) -> "Contact":
        """Contact on a grid of which it was a window; the gap beyond becomes ``open_gap``."""
        pressure, gap = np.zeros(shape), np.full(shape, open_gap)
        pressure[where], gap[where] = self.pressure, self.gap
        return replace(self, pressure=pressure, gap=gap)


@dataclass(frozen=True, eq=False)
class Problem:
    """Known quantities of a contact: gap, load or approach, first guess.

    deflection : u = A p, linear, symmetric, positive.  gap : g0 [m], (nx, ny).
    total : sum of p over the patches [Pa], for load control; else approach : delta [m], the other one None.
    start : computes a first guess of p.  precondition : z = P r, approximate inverse of A.  of_half_space :
    that of an uncoated half-space, which takes its place after ``PRECONDITIONED_ITERATIONS``.
    scale : length to which gap and penetration are relative [m].  tolerance : on each of them, relative.
    extension : patches over which the residual is extended beyond the contact.
    weight : patches that each entry represents, where the operators and the gap are those of a ``grid.Grid``
    held as a quarter.  mirror : of fields at the rim and at the axes of a quarter, as in ``scipy.ndimage``:
    "mirror" about a patch centre, "reflect" about a border.
    """

    deflection: Operator
    gap: Array
    total: float | None
    approach: float | None
    start: Callable[[], Array]
    precondition: Operator
    of_half_space: Operator
    scale: float
    tolerance: float
    max_iterations: int
    extension: float = numbers.EXTENSION
    weight: Array | None = None
    mirror: Literal["mirror", "reflect"] = "mirror"

    def balanced(self, p: Array) -> Array:
        """Pressure scaled to the load."""
        return p if self.total is None else p * (self.total / self.sum(p))

    def sum(self, a: Array) -> float:
        """Sum over all patches."""
        return float(np.sum(a) if self.weight is None else np.einsum("ij,ij->", a, self.weight))

    def dot(self, a: Array, b: Array) -> float:
        """Inner product over all patches."""
        # not by BLAS: its threads keep spinning after such a short sum and slow those of the FFT
        if self.weight is None:
            return float(np.einsum("ij,ij->", a, b))
        return float(np.einsum("ij,ij,ij->", a, b, self.weight))

    def mean(self, a: Array | Mask) -> Array:
        """Means by a Gaussian of ``extension`` patches, mirrored at the rim as at the axes of a quarter."""
        mean: Array = gaussian_filter(a, self.extension, output=np.float64, mode=self.mirror, truncate=3.0)
        return mean


class _ContactSet:
    """Contact set, with the extension of the residual beyond it."""

    def __init__(self, inside: Mask, problem: Problem) -> None:
        self.inside, self._problem = inside, problem
        self._share = problem.mean(inside)

    def one(self) -> Array:
        """Unit residual, extended beyond the contact set."""
        return np.where(
            self.inside, 1.0, np.minimum(self._share, numbers.FADED_RESIDUAL) / numbers.FADED_RESIDUAL
        )

    def extended(self, r: Array) -> Array:
        """r, which is 0 outside, in contact; its local mean just outside, 0 far away."""
        return np.where(
            self.inside, r, self._problem.mean(r) / np.maximum(self._share, numbers.FADED_RESIDUAL)
        )


@dataclass(slots=True, eq=False)
class _State:
    """One iterate.

    p, g, delta : pressure, gap, approach.  updated : g by recurrence, not from A p.
    contact : the set, P_one : P of the unit residual on it, new : it changed since the last step.
    extended, z : gap in contact, extended; P of that.  shift : last change of delta.
    step, slope, last : search direction, its (g, z), and g of the iteration before.
    residual, depth : largest |g| in contact over the scale; penetration [m], ``deep`` its limit.  first :
    residual at the first iteration on the set.
    tension : patches with p < 0.  admissible : no tension, no penetration.
    iterations, on_set, set_updates, convolutions : counts; on_set those since the last change of the set.
    """

    p: Array
    contact: _ContactSet
    delta: float
    g: Array = field(init=False)
    extended: Array = field(init=False)
    z: Array = field(init=False)
    P_one: Array = field(init=False)
    step: Array = field(init=False)
    last: Array = field(init=False)
    tension: Mask = field(init=False)
    shift: float = 0.0
    slope: float = 1.0
    residual: float = 0.0
    first: float = 0.0
    depth: float = 0.0
    deep: float = 0.0
    updated: bool = False
    new: bool = False
    admissible: bool = False
    iterations: int = 0
    on_set: int = 0
    set_updates: int = 0
    convolutions: int = 0
    history: list[tuple[float, float]] = field(default_factory=list)

    @property
    def left(self) -> float:
        """Largest |z|: the change of p by a further step."""
        return float(np.max(np.abs(self.z)))


def solve(problem: Problem) -> Contact:
    """Pressure p >= 0 that closes the gap where it acts and leaves it open elsewhere.

    Raises NotConverged after ``problem.max_iterations``.
    """
    # numbered as by Polonsky and Keer; their last steps come first, for the first guess may be the solution
    state = _first_guess(problem)
    _find_gap(state, problem)  # 1: gap, its preconditioned mean removed
    while not _is_solved(state, problem):  # 7: stopping criterion
        if not _update_set(state, problem):  # 5, 6: tension leaves, overlap enters; balance of the load
            _find_direction(state, problem)  # 2: conjugate direction
            _advance(state, problem)  # 3, 4: step length and step
            _choose_preconditioner(state, problem)
        _find_gap(state, problem)  # 1
    return _contact(state, problem)


def _first_guess(problem: Problem) -> _State:
    p = _start(problem)
    state = _State(p, _ContactSet(p > 0, problem), problem.approach or 0.0)
    state.step = np.zeros_like(p)
    _find_gap_of_pressure(state, problem)
    _find_P_one(state, problem)
    return state


def _start(problem: Problem) -> Array:
    p = np.maximum(problem.start(), 0.0)
    if not np.isfinite(np.sum(p)):
        raise NotConverged(
            "the first guess of the pressure is not finite; look at the influence coefficients"
        )
    if not np.any(p > 0):  # a flat punch, or a contact narrower than a patch
        p = np.asarray(problem.gap == np.min(problem.gap), dtype=np.float64)
    return problem.balanced(p)


def _choose_preconditioner(state: _State, problem: Problem) -> None:
    """Cut P off at the edge, later take that of a half-space; conjugate directions built so far are lost."""
    if state.iterations == numbers.PRECONDITIONED_ITERATIONS:
        # where the preconditioner misleads, the iterate is far from the solution: start from the first guess
        state.p = _start(problem)
        _find_gap_of_pressure(state, problem)
        state.contact = _ContactSet(state.p > 0, problem)
        state.set_updates = numbers.PREDICTED_UPDATES
    elif state.iterations != numbers.EXTENDED_ITERATIONS:
        return
    _find_P_one(state, problem)
    state.on_set = 0


def _precondition(r: Array, extended: Array, state: _State, problem: Problem) -> Array:
    """z = P r on the contact set, of r or of its extension; in the end P is that of a half-space."""
    if state.iterations >= numbers.PRECONDITIONED_ITERATIONS:
        return problem.of_half_space(r) * state.contact.inside
    z = problem.precondition(extended if state.iterations < numbers.EXTENDED_ITERATIONS else r)
    return z * state.contact.inside


def _find_P_one(state: _State, problem: Problem) -> None:
    one = np.where(state.contact.inside, 1.0, 0.0)
    state.P_one = _precondition(one, state.contact.one(), state, problem)


def _find_gap(state: _State, problem: Problem) -> None:
    """Step 1: z = P r, r the gap in contact; g with the delta for which sum z = 0 keeps the load."""
    r = state.g * state.contact.inside
    state.extended = state.contact.extended(r)
    state.z = _precondition(r, state.extended, state, problem)
    if problem.approach is None:
        shift = state.shift = problem.sum(state.z) / problem.sum(state.P_one)
        state.g = state.g - shift
        state.z = state.z - state.P_one * shift
        state.delta += shift
    _measure(state, problem)


def _find_gap_of_pressure(state: _State, problem: Problem) -> None:
    state.g = problem.deflection(state.p) + problem.gap - state.delta
    state.updated = False
    state.convolutions += 1


def _measure(state: _State, problem: Problem) -> None:
    """Residual, penetration and tension of the iterate."""
    inside = state.g * state.contact.inside
    state.residual = float(np.max(np.abs(inside))) / problem.scale
    if state.on_set == 0:
        state.first = state.residual
    state.depth = float(np.max(inside - state.g))
    state.tension = state.p < 0
    # a margin for patches that enter before the residual is small; then the tolerance alone
    margin = 1.0 if state.residual <= problem.tolerance else 0.5
    state.deep = margin * problem.tolerance * problem.scale
    state.admissible = not np.any(state.tension) and state.depth <= state.deep


def _is_solved(state: _State, problem: Problem) -> bool:
    """Step 7: whether the contact conditions hold within the tolerance, for A p itself.

    Raises NotConverged when they do not and the iterations are used up.
    """
    solved = _within_tolerance(state, problem)
    if solved and state.updated:
        state.p = problem.balanced(state.p)
        _find_gap_of_pressure(state, problem)
        _measure(state, problem)
        if not _within_tolerance(state, problem):
            _find_gap(state, problem)
            solved = _within_tolerance(state, problem)
    if not solved and state.iterations >= problem.max_iterations:
        raise NotConverged(
            f"gap in contact {state.residual:.1e} and penetration {state.depth / problem.scale:.1e} of the "
            f"scale {problem.scale:.3g} m after {problem.max_iterations} iterations (required: "
            f"{problem.tolerance:.0e}); raise max_iterations or tolerance"
        )
    return solved


def _within_tolerance(state: _State, problem: Problem) -> bool:
    """Whether gap and penetration are within the tolerance, and a further step changes p by no more than
    ``LEFT`` times that share of its peak: the shortest waves of p hardly move the gap."""
    tolerance = problem.tolerance
    if not (state.admissible and state.residual <= tolerance):
        return False
    settled = state.iterations >= numbers.PRECONDITIONED_ITERATIONS
    return settled or state.left <= numbers.LEFT * tolerance * float(np.max(state.p))


def _update_set(state: _State, problem: Problem) -> bool:
    """Steps 5 and 6: patches in tension leave the set, overlapping ones enter; the load is balanced.

    Returns False where the set is kept: it is admissible, new, or its residual has not fallen enough.
    """
    if state.admissible or state.new:
        return False
    inside, leave = state.contact.inside, state.tension  # p < 0 in contact alone
    fallen = state.residual <= max(numbers.RESIDUAL_FALL * state.first, 0.3 * problem.tolerance)
    if not fallen and state.on_set < numbers.ITERATIONS_PER_SET:
        return False
    if state.set_updates >= numbers.PREDICTED_UPDATES:
        enter = ~inside & (state.g < -state.deep)
    else:
        # the set predicted for a vanishing residual: g less its extension outside, p less z inside
        predicted = state.g - state.extended + state.contact.one() * state.shift
        enter = ~inside & (predicted < -0.5 * problem.tolerance * problem.scale)
        leave = leave & (state.p < state.z)
    if not (np.any(leave) or np.any(enter)):
        return False
    state.contact = _ContactSet((inside | enter) & ~leave, problem)
    _find_P_one(state, problem)
    state.set_updates, state.on_set, state.new = state.set_updates + 1, 0, True
    if np.any(leave):
        state.p = problem.balanced(np.where(leave, 0.0, state.p))
        _find_gap_of_pressure(state, problem)
    return True


def _find_direction(state: _State, problem: Problem) -> None:
    """Step 2: conjugate direction on the contact set, steepest descent after the set has changed."""
    descent = problem.dot(state.g, state.z)
    beta = 0.0 if state.on_set == 0 else max(0.0, descent - problem.dot(state.last, state.z)) / state.slope
    state.slope = descent
    state.step = state.step * beta + state.z


def _advance(state: _State, problem: Problem) -> None:
    """Steps 3 and 4: alpha = (g, t) / (t, A t), then p - alpha t and g - alpha A t."""
    state.history.append((state.residual, state.depth / problem.scale))
    Au = problem.deflection(state.step)
    state.convolutions += 1
    alpha = problem.dot(state.g, state.step) / problem.dot(state.step, Au)
    state.last = state.g
    state.p = state.p - state.step * alpha
    state.g = state.g - Au * alpha
    state.updated, state.new = True, False
    state.iterations, state.on_set = state.iterations + 1, state.on_set + 1


def _contact(state: _State, problem: Problem) -> Contact:
    error = 0.0 if problem.total is None else abs(problem.sum(state.p) / problem.total - 1)
    return Contact(
        pressure=state.p,
        gap=state.g,
        approach=state.delta,
        gap_inside=state.residual,
        penetration_outside=max(0.0, state.depth) / problem.scale,
        load_error=error,
        iterations=state.iterations,
        convolutions=state.convolutions,
        history=tuple(state.history),
        left=np.inf if state.iterations >= numbers.PRECONDITIONED_ITERATIONS else state.left,
    )
