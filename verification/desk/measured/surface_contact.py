"""The contact of a measured surface with a coated body: patches, real area, largest stresses with places.

The largest stresses are those below the patches at several depths, all patches of a plane at once.
"""

import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

import semianalytic
from verification.cases.case_file import Case
from verification.desk.answer_stresses import Extreme
from verification.desk.contact_answer import ContactAnswer
from verification.desk.measured.surface_map import SurfaceMap
from verification.problem.array_types import Array
from verification.problem.quantity import SCALARS, STRESSES, first_principal, von_mises
from verification.study.largest_stresses import Measure

MOST_PATCHES, DEPTHS, FINE = 513, 4, 33  # a side; planes below the contact; depths between two of them
INDICES = tuple(map(list, zip(*STRESSES.values(), strict=True)))  # xx, yy, zz, xz, xy, yz

Place = tuple[float, float, float, float]  # value [Pa] at x, y, z [m]


@dataclass(frozen=True, eq=False)
class SurfaceContact:
    """``solution`` of patches, ``answer`` as of a ball's contact, real ``area`` with its uncertainty [m2]."""

    solution: semianalytic.Solution
    answer: ContactAnswer
    area: tuple[float, float]


def pressed(surface: SurfaceMap, case: Case) -> SurfaceContact:
    """The contact of ``surface`` under the load of a ``case``, with the bodies of it.

    Raises ValueError, and NotConverged where the contact reaches the rim of the map.
    """
    begin, problem = time.perf_counter(), case.problem
    n = min(MOST_PATCHES, min(surface.heights.shape) // 2 * 2 + 1)
    solution = semianalytic.indent(
        profile=surface.gap,
        half_width=surface.half_width,
        load=problem.load,
        coatings=problem.coatings,
        substrate=problem.substrate,
        friction=problem.friction,
        ball=problem.ball,
        patches=n,
    )
    found = [at for body in problem.bodies for at in _extremes(solution, case, body)]
    numbers = {name: tuple(solution.sample(None, name)) for name in SCALARS}
    a, U = numbers["contact_radius"]
    answer = ContactAnswer("semianalytic", time.perf_counter() - begin, numbers, tuple(found), ())
    return SurfaceContact(solution, answer, (np.pi * a * a, 2 * np.pi * a * U))


WITHIN: dict[str, Measure] = {"sigma_1": first_principal, "von_mises": von_mises}
ACROSS: dict[str, Measure] = {"|sigma_xz|": lambda s: np.hypot(s[3], s[5]), "sigma_zz": lambda s: s[2]}


def _extremes(solution: semianalytic.Solution, case: Case, body: str) -> Iterator[Extreme]:
    """The largest sigma_1 and von Mises stress of every layer, shear and tension of every interface.

    With d1, d2 the changes from the grids of half and of a quarter as many patches a side,
    U = 3 max(d1, d2/2): Roache's factor of safety at the first order of patches alone.
    """
    seen, levels = case.problem.seen_from(body), [solution]
    while levels[-1].coarser is not None:
        levels.append(levels[-1].coarser)
    edges = (0.0, *seen.interfaces, np.inf)
    a, d = solution.contact_radius, solution.diagnostics.patch_size
    inside = np.geomspace(d, max(a, 2 * d), DEPTHS).tolist()
    planes = [
        (layer, z)
        for layer, (top, base) in enumerate(pairwise(edges))
        for z in (top, *(z for z in inside if top < z < base), base)
        if z < np.inf
    ]
    residual = (*((case.residual or {}).get(body) or [0.0] * len(seen.coatings)), 0.0)

    def largest(job: tuple[semianalytic.Solution, int, float]) -> dict[tuple[str, int], Place]:
        of, layer, z = job
        stress: Array = np.asarray(of.stress_plane(z, layer, body)[INDICES], dtype=np.float64)
        stress[:2] += residual[layer]
        found = {}
        for quantity, measure in (WITHIN | (ACROSS if z == edges[layer + 1] else {})).items():
            value = np.asarray(measure(stress))
            i, j = np.unravel_index(int(np.argmax(value)), value.shape)
            found[quantity, layer] = float(value[i, j]), float(of.nodes[i]), float(of.nodes[j]), z
        return found

    with ThreadPoolExecutor(2) as pool:
        found = list(pool.map(largest, [(of, *plane) for of in levels for plane in planes]))
    n = len(planes)
    by_level = [_of_all_planes(found[k * n : (k + 1) * n]) for k in range(len(levels))]
    for (quantity, layer), (value, x, y, z) in by_level[0].items():
        name = "substrate" if layer == len(seen.coatings) else f"coating {layer + 1}"
        where = f"interface {layer + 1}" if quantity in ACROSS else name
        on_plane, half, quarter = (one[quantity, layer][0] for one in by_level)
        if quantity in WITHIN:  # between the planes, below the same point
            own = [depth for of, depth in planes if of == layer]
            k = own.index(z)
            line = np.linspace(own[max(k - 1, 0)], own[min(k + 1, len(own) - 1)], FINE)
            stress: Array = np.asarray(solution.stress(x, y, line, layer, body)[INDICES], dtype=np.float64)
            stress[:2] += residual[layer]
            deeper = WITHIN[quantity](stress)
            if deeper.max() > value:
                value, z = float(deeper.max()), float(line[deeper.argmax()])
        U = 3 * max(abs(on_plane - half), abs(half - quarter) / 2)
        yield Extreme(body, quantity, where, value, U, x, z, y)


def _of_all_planes(found: Sequence[dict[tuple[str, int], Place]]) -> dict[tuple[str, int], Place]:
    """The largest of several planes."""
    best: dict[tuple[str, int], Place] = {}
    for plane in found:
        for key, at in plane.items():
            best[key] = max(best.get(key, at), at)
    return best
