"""Profiles of a solution along the lines of a case."""

from collections.abc import Mapping, Sequence
from typing import Any, TypeGuard

import numpy as np

from verification.judging.invariants.companion_uncertainty import followed
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, ContactSolution
from verification.problem.either_body import on_body
from verification.problem.line_profile import EDGE_LINE, Line, Profile, line_of
from verification.problem.point_answers import BALL, EDGE, FIXED, FLAT, Points
from verification.problem.quantity import BALL_PEAKS, IN_PLANE, PEAKS, SCALARS, SLOPES
from verification.sampling import oblique_sampling
from verification.sampling.largest_tension import BESIDE, ENDS, Search, around_edge, edge_uncertainty

# Of a: distances from the contact edge of points on the surface line, either side.
NEAR_EDGE = np.array([0.0, 1e-4, 1e-3, 1e-2])


def sample_contact(solution: ContactSolution, source: str) -> tuple[Profile, ...]:
    """Every scalar of the contact that the solution gives as a profile of one point [SI]."""
    found = []
    for name in (*SCALARS, *SLOPES):
        number, stated = solution.sample(None, name)
        if number is None:
            continue
        value, U = np.array([number]), None if stated is None else np.array([stated])
        found.append(Profile(name, "contact", np.zeros(1), value, source, U))
    return tuple(found)


# Of a, around the edge of a contact that is no disc: no point there but on ``EDGE_LINE``, along which the
# meridian mesh is made for the edge.
CLEAR = 0.1
BESIDE_SHAPED = np.array([0.0, 0.01, 0.03, 0.08, 0.15, 0.25])  # of a, either side of it on ``EDGE_LINE``
SHAPED = 21  # points on either side of x = 0, of rings about which there are no tables


def positions(
    problem: CoatedContact, lines: Sequence[Line], solutions: Mapping[str, ContactSolution]
) -> dict[Line, Array]:
    """Positions along each line [m]: in x the surface nodes of the first solution, in z inside the layers.

    The semi-analytical method comes first and needs no interpolation at its nodes; finite elements have
    shape functions anywhere. The surface has points at the contact edge of the last solution, the reference,
    and ``NEAR_EDGE``.
    """
    a = max(solution.contact_radius for solution in solutions.values())
    edge = edge_of(solutions)
    nodes = next(iter(solutions.values())).surface_nodes
    shaped = problem.indenter is not None
    wanted = 2.5 * a * np.linspace(0, 1, SHAPED if shaped else 101)
    if problem.friction or shaped:
        wanted = np.concatenate([-wanted[:0:-1], wanted])
    wanted = wanted[np.abs(wanted) <= np.abs(nodes).max()]
    x = nodes[np.unique(np.abs(nodes[None, :] - wanted[:, None]).argmin(axis=1))]
    z = {body: _depths(problem.seen_from(body), a) for body in problem.bodies}
    first = next(iter(solutions.values()))
    if shaped:
        clear = _clear_of_edges(first, line_of("surface", problem), x, CLEAR * a)
    near = edge * np.concatenate([1 + NEAR_EDGE, 1 - NEAR_EDGE])
    if not shaped:
        clear = x[np.abs(np.abs(x) - edge) > NEAR_EDGE[1] * edge]
        clear = np.concatenate([clear, near, -near] if problem.friction else [clear, near])
    surface = np.unique(clear)

    def along(line: Line) -> Array:
        if line.coordinate == "z":
            return z[line.body]
        if line.name == EDGE_LINE:
            ends = ends_of(first)[:, None]
            return np.unique(np.concatenate([ends + BESIDE_SHAPED * a, ends - BESIDE_SHAPED * a]))
        if line.depth is None:
            at = oblique_sampling.positions(problem, line, a, getattr(first, "nodes", nodes))
            return _clear_of_edges(first, line, at, CLEAR * a) if shaped else at
        if shaped and line.depth > 0:
            return _clear_of_edges(first, line, x, CLEAR * a)
        return surface if line.depth == 0 else x

    return {line: along(line) for line in lines}


def ends_of(solution: ContactSolution) -> Array:
    """Ends of the contact on y = 0 [m], just outside it, found between the surface nodes."""
    x = solution.surface_nodes
    least = 1e-6 * solution.peak_pressure
    loaded = solution.pressure(x) > least
    low, high = (x[side][loaded[1:] != loaded[:-1]] for side in (slice(None, -1), slice(1, None)))
    begins = solution.pressure(high) > least
    for _ in range(40):
        middle = (low + high) / 2
        same = (solution.pressure(middle) > least) == begins
        low, high = np.where(same, low, middle), np.where(same, middle, high)
    return np.where(begins, low, high)


def _clear_of_edges(solution: ContactSolution, line: Line, at: Array, distance: float) -> Array:
    """Positions within ``distance`` of which the contact neither begins nor ends, all [m]."""
    least = 1e-6 * solution.peak_pressure
    x, y, z = line.points(at)
    reach = np.sqrt(np.maximum(distance**2 - z**2, 0.0))[:, None]
    turn = 2 * np.pi * np.arange(16) / 16
    loaded = solution.pressure(x[:, None] + reach * np.cos(turn), y[:, None] + reach * np.sin(turn)) > least
    return at[loaded.all(axis=1) | ~loaded.any(axis=1)]


def edge_of(solutions: Mapping[str, ContactSolution]) -> float:
    """Contact radius [m] of the last solution, the reference: where the surface line has r = a."""
    return float(list(solutions.values())[-1].contact_radius)


def _depths(problem: CoatedContact, a: float) -> Array:
    """Depths on the axis [m]: at least six in each layer, none on an interface; spacing grows with depth."""
    bounds = np.array([0.0, *problem.interfaces, max(4 * a, *(2 * z for z in problem.interfaces), 0.0)])
    inside = bounds[:-1, None] + np.diff(bounds)[:, None] * (np.arange(6) + 0.5) / 6
    return np.unique(np.concatenate([inside.ravel(), 4 * a * ((np.arange(40) + 0.5) / 40) ** 1.5]))


def sample(
    solution: ContactSolution,
    source: str,
    line: Line,
    position: Array,
    problem: CoatedContact | None = None,
    edge: float | Array | None = None,
) -> tuple[Profile, ...]:
    """Every quantity of ``line`` at ``position`` [m]: the four stresses, on the surface the pressure too.

    Off the plane y = 0 see ``oblique``. On a line of the ball x is that of the flat.

    problem : on the surface also its largest tension with its place, as ``PEAKS`` of the contact.
    edge : as of ``edge_of``, or of a contact that is no disc as of ``ends_of``; points within ``BESIDE`` of
           that edge [m] are evaluated at the same x/a of the solution's own edge, where a value does not
           depend on the error of the radius.
    """
    if line.depth is None and line.coordinate != "z":
        return oblique_sampling.sample(solution, source, line, position)
    solution, turned = on_body(solution, line.body), -1.0 if line.body == BALL else 1.0
    x, _, z = (np.array(along) for along in line.points(position))
    x = turned * x
    surface = line.place == "surface"
    a = float(solution.contact_radius)
    moving = EDGE in solution.frames
    near = np.zeros(x.shape, dtype=bool)
    if isinstance(edge, np.ndarray):
        if line.name == EDGE_LINE and (here := ends_of(solution)).shape == edge.shape:
            nearest = np.abs(position[:, None] - edge).argmin(axis=1)
            near = np.abs(position - edge[nearest]) <= (1 + 1e-9) * BESIDE * a
            x[near] += (here - edge)[nearest[near]]
        edge = None
    elif edge is not None:
        near = (np.hypot(np.abs(position) - edge, z) <= BESIDE * edge) & (line.coordinate == "x")
        x[near] *= a / edge
    # of a solution that does not state its uncertainty relative to the edge, that of points on it is followed
    at = np.flatnonzero(np.abs(position) == edge) if surface and not moving else np.arange(0)
    side = np.sign(x[at])
    x[at] = side * a
    around = (side[:, None] * around_edge(solution)).ravel()
    search = Search(solution, problem.seen_from(line.body)) if _has_peak(problem) and surface else None
    # In one call, whose cost hardly depends on the number of points.
    parts = (x, around, np.zeros(0) if search is None else search.x)
    points = np.concatenate(parts)
    depth, beside = (np.concatenate([one, np.zeros(points.size - z.size)]) for one in (z, near))
    places = Points(points, 0.0, depth, line.layer, frame=np.where(beside, EDGE, FIXED))
    ends = np.cumsum([part.size for part in parts])[:-1]

    def sampled(field: str) -> tuple[Array, Array | None, Array, Array | None]:
        """Values and uncertainties along the line, then those of the search."""
        value, U = solution.sample(places, field)
        here, edges, sought = np.split(value, ends, axis=-1)
        if U is None:
            return here, None, sought, None
        wide, edges_U, sought_U = np.split(U, ends, axis=-1)
        if at.size:
            wide[..., at] = _at_edge(solution, edges, edges_U, field)
        return here, wide, sought, sought_U

    values, wide, sought, sought_U = sampled("stress")
    values[0, 2] = values[2, 0] = turned * values[0, 2]
    found = [(name, values[c], None if wide is None else wide[c]) for name, c in IN_PLANE.items()]
    if line.name in ("surface", EDGE_LINE):  # the pressure is that of both bodies
        found.append(("pressure", *sampled("pressure")[:2]))
    profiles = [Profile(name, line.name, position, value, source, U) for name, value, U in found]
    if search is not None:
        best = search.largest(sought[0, 0], None if sought_U is None else sought_U[0, 0])
        numbers = ((best.value, best.uncertainty), (turned * best.place, best.place_uncertainty))
        names = PEAKS if line.body == FLAT else BALL_PEAKS
        for name, (number, uncertain) in zip(names, numbers, strict=True):
            own = None if uncertain is None else np.array([uncertain])
            profiles.append(Profile(name, "contact", np.zeros(1), np.array([number]), source, own))
    return tuple(profiles)


def _has_peak(problem: CoatedContact | None) -> TypeGuard[CoatedContact]:
    return problem is not None and problem.indenter is None


def _at_edge(solution: ContactSolution, value: Array, U: Array, field: str) -> Array:
    """Uncertainty at the solution's own edge from values at ``around_edge`` of each side, (..., 5 sides)."""

    def at_ends(one: Any) -> Array:
        found: Array = one.sample(Points(ENDS * one.contact_radius, layer=0), field, False).value
        return found

    change = followed(solution, at_ends, before=1.0)
    shape = (*value.shape[:-1], -1, 5)
    ends = None if change is None else change[..., None, :]
    return edge_uncertainty(value.reshape(shape), U.reshape(shape), ends)
