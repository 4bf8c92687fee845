"""Profiles of a solution along the lines of a case."""

from collections.abc import Mapping, Sequence

import numpy as np

from verification.problem.arrays import Array
from verification.problem.contact import CoatedContact, Solution, stress_with_uncertainty
from verification.problem.profile import Line, Profile
from verification.problem.quantity import IN_PLANE, PEAKS, QUANTITIES, SCALARS, SLOPES
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
    bounds = np.array([0.0, *problem.interfaces, max(4 * a, *(2 * z for z in problem.interfaces), 0.0)])
    # At least six points in each layer, none on an interface; spacing grows with depth.
    inside = bounds[:-1, None] + np.diff(bounds)[:, None] * (np.arange(6) + 0.5) / 6
    z = np.unique(np.concatenate([inside.ravel(), 4 * a * ((np.arange(40) + 0.5) / 40) ** 1.5]))
    edge = list(solutions.values())[-1].contact_radius * np.concatenate([1 + NEAR_EDGE, 1 - NEAR_EDGE])
    surface = np.unique(np.concatenate([x, edge, -edge] if problem.friction else [x, edge]))
    return {
        line: z
        if line.coordinate == "z"
        else oblique.positions(problem, line, a)
        if line.depth is None
        else (surface if line.depth == 0 else x)
        for line in lines
    }


def sample(
    solution: Solution, source: str, line: Line, position: Array, problem: CoatedContact | None = None
) -> tuple[Profile, ...]:
    """Every quantity of ``line`` at ``position`` [m]: the four stresses, on the surface the pressure too.

    Off the plane y = 0 see ``oblique``.

    problem : on the surface also its largest tension with its place, as ``PEAKS`` of the contact.
    """
    if line.depth is None and line.coordinate != "z":
        return oblique.sample(solution, source, line, position)
    x, _, z = line.points(position)
    stated = solution.uncertainty is not None
    profiles = []
    if line.name == "surface":
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
    search = Search(solution, problem) if problem is not None and line.name == "surface" else None
    if search is not None:  # in one call, whose cost hardly depends on the number of points
        x, z = np.concatenate([x, search.x]), np.zeros(count + search.x.size)
    sigma, U = stress_with_uncertainty(solution, x, 0.0, z, layer=line.layer)
    if search is not None:
        found = search.largest(sigma[0, 0, count:], None if U is None else U[0, 0, count:])
        numbers = ((found.value, found.uncertainty), (found.place, found.place_uncertainty))
        for name, (value, uncertain) in zip(PEAKS, numbers, strict=True):
            spread = None if uncertain is None else np.array([uncertain])
            profiles.append(Profile(name, "contact", np.zeros(1), np.array([value]), source, spread))
        sigma, U = sigma[..., :count], None if U is None else U[..., :count]
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
