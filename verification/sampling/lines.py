"""Profiles of a solution along the lines of a case."""

from collections.abc import Mapping, Sequence

import numpy as np

from verification.problem.arrays import Array
from verification.problem.body import on_body
from verification.problem.contact import BALL, FLAT, CoatedContact, Solution, stress_with_uncertainty
from verification.problem.profile import Line, Profile
from verification.problem.quantity import BALL_PEAKS, IN_PLANE, PEAKS, QUANTITIES, SCALARS, SLOPES
from verification.sampling import oblique
from verification.sampling.tension import Search

__all__ = ["positions", "sample", "sample_contact"]

# Of a: distances from the contact edge of points on the surface line, either side.
NEAR_EDGE = np.array([0.0, 1e-4, 1e-3, 1e-2])


def sample_contact(solution: Solution, source: str, problem: CoatedContact) -> tuple[Profile, ...]:
    """Every scalar of the contact as a profile of one point [SI]; no slope where the solution has none."""
    found = []
    for name in (*SCALARS, *(name for name in SLOPES if getattr(solution, name, None) is not None)):
        value = np.array([QUANTITIES[name].value(solution, problem)])
        stated = QUANTITIES[name].uncertainty(solution, problem)
        U = None if stated is None else np.array([stated])
        found.append(Profile(name, "contact", np.zeros(1), value, source, U))
    return tuple(found)


def positions(
    problem: CoatedContact, lines: Sequence[Line], solutions: Mapping[str, Solution]
) -> dict[Line, Array]:
    """Positions along each line [m]: in x the surface nodes of the first solution, in z inside the layers.

    The semi-analytical method comes first and needs no interpolation at its nodes; finite elements have
    shape functions anywhere. The surface has points at the contact edge of the last solution, the reference,
    and ``NEAR_EDGE``.
    """
    a = max(solution.contact_radius for solution in solutions.values())
    nodes = next(iter(solutions.values())).surface_nodes
    wanted = 2.5 * a * np.linspace(0, 1, 101)
    if problem.friction:
        wanted = np.concatenate([-wanted[:0:-1], wanted])
    wanted = wanted[np.abs(wanted) <= np.abs(nodes).max()]
    x = nodes[np.unique(np.abs(nodes[None, :] - wanted[:, None]).argmin(axis=1))]
    z = {body: _depths(problem.seen_from(body), a) for body in problem.bodies}
    edge = list(solutions.values())[-1].contact_radius * np.concatenate([1 + NEAR_EDGE, 1 - NEAR_EDGE])
    surface = np.unique(np.concatenate([x, edge, -edge] if problem.friction else [x, edge]))
    return {
        line: z[line.body]
        if line.coordinate == "z"
        else oblique.positions(problem, line, a)
        if line.depth is None
        else (surface if line.depth == 0 else x)
        for line in lines
    }


def _depths(problem: CoatedContact, a: float) -> Array:
    """Depths on the axis [m]: at least six in each layer, none on an interface; spacing grows with depth."""
    bounds = np.array([0.0, *problem.interfaces, max(4 * a, *(2 * z for z in problem.interfaces), 0.0)])
    inside = bounds[:-1, None] + np.diff(bounds)[:, None] * (np.arange(6) + 0.5) / 6
    return np.unique(np.concatenate([inside.ravel(), 4 * a * ((np.arange(40) + 0.5) / 40) ** 1.5]))


def sample(
    solution: Solution, source: str, line: Line, position: Array, problem: CoatedContact | None = None
) -> tuple[Profile, ...]:
    """Every quantity of ``line`` at ``position`` [m]: the four stresses, on the surface the pressure too.

    Off the plane y = 0 see ``oblique``. On a line of the ball x is that of the flat.

    problem : on the surface also its largest tension with its place, as ``PEAKS`` of the contact.
    """
    if line.depth is None and line.coordinate != "z":
        return oblique.sample(solution, source, line, position)
    solution, turned = on_body(solution, line.body), -1.0 if line.body == BALL else 1.0
    x, _, z = line.points(position)
    x = turned * x
    stated = solution.uncertainty is not None
    profiles = []
    if line.name == "surface":  # the pressure is that of both bodies
        profiles.append(
            Profile(
                "pressure",
                line.name,
                position,
                solution.pressure(x),
                source,
                solution.pressure_uncertainty(x) if stated else None,
            )
        )
    count = x.size
    search = None
    if problem is not None and line.place == "surface":
        search = Search(solution, problem.seen_from(line.body))
    if search is not None:  # in one call, whose cost hardly depends on the number of points
        x, z = np.concatenate([x, search.x]), np.zeros(count + search.x.size)
    sigma, U = stress_with_uncertainty(solution, x, 0.0, z, layer=line.layer)
    if search is not None:
        found = search.largest(sigma[0, 0, count:], None if U is None else U[0, 0, count:])
        numbers = ((found.value, found.uncertainty), (turned * found.place, found.place_uncertainty))
        names = PEAKS if line.body == FLAT else BALL_PEAKS
        for name, (value, uncertain) in zip(names, numbers, strict=True):
            spread = None if uncertain is None else np.array([uncertain])
            profiles.append(Profile(name, "contact", np.zeros(1), np.array([value]), source, spread))
        sigma, U = sigma[..., :count], None if U is None else U[..., :count]
    sigma[0, 2] = sigma[2, 0] = turned * sigma[0, 2]
    for name, component in IN_PLANE.items():
        profiles.append(
            Profile(
                name,
                line.name,
                position,
                sigma[component],
                source,
                None if U is None else U[component],
            )
        )
    return tuple(profiles)
