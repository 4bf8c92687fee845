"""Stresses of both methods in the plane y = 0 below the contact, as the report draws them.

Sampled once, from the very Solutions that were judged, at nodes of the semi-analytical grid: there its
stresses need no interpolation and the finite element model has shape functions anywhere. Kept beside the
result of the case in a file of its own that checks itself.
"""

from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from verification.problem import Solution
from verification.result import CaseResult, plain
from verification.store import StoreError, read_checked, write_checked

__all__ = [
    "COMPONENTS",
    "Plane",
    "depths_of",
    "plane_path",
    "read_plane",
    "read_planes",
    "sample_plane",
    "von_mises",
    "write_plane",
]

Array = NDArray[np.float64]

SCHEMA = "coatcheck-plane/1"
COMPONENTS = {"sigma_xx": (0, 0), "sigma_yy": (1, 1), "sigma_zz": (2, 2), "sigma_xz": (0, 2)}
DRAWN = ("semianalytic", "fem_reference")
WIDTH = 2.0  # half width over the contact radius, where the grid of the semi-analytical method goes as far
DEPTH = 1.5  # over the contact radius; at least 1.3 times the deepest interface, up to DEEPEST
DEEPEST = 3.0
COLUMNS = 65
LEVELS = 12  # over the depth of an uncoated solid
FEWEST = 4  # in a layer, both its sides included
CROWDING = 0.6  # levels are even in z ** CROWDING: close below the surface, wide apart below
SHALLOW = 1.5  # patches
EDGE = 0.06  # of a: so close to the contact edge no node is left out


@dataclass(frozen=True, eq=False)
class Plane:
    """Stresses at x [m], (nx,), and the depths z [m] of each layer, (nz,), both sides of its interfaces.

    stress : by source, for each layer the ``COMPONENTS`` [Pa], (4, nz, nx); sigma_xy = sigma_yz = 0 there.
    failures : by source the sentence of one whose stresses could not be had.   radius : contact radius [m].
    """

    x: Array
    depths: tuple[Array, ...]
    radius: float
    stress: Mapping[str, tuple[Array, ...]]
    failures: Mapping[str, str]


def von_mises(sigma: Array) -> Array:
    """Von Mises stress in the plane y = 0 from its four stresses xx, yy, zz, xz (4, ...), [Pa].

    sigma_vM^2 = ((xx - yy)^2 + (yy - zz)^2 + (zz - xx)^2) / 2 + 3 xz^2
    """
    xx, yy, zz, xz = sigma
    return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * xz**2)


def sample_plane(interfaces: tuple[float, ...], solutions: Mapping[str, Solution]) -> Plane:
    """Stresses of the methods among ``solutions`` at the same points; a method that fails leaves a sentence.

    interfaces : depths [m] from the surface down.
    """
    methods = {name: solutions[name] for name in DRAWN if name in solutions}
    if not methods:
        return Plane(np.zeros(0), (), 0.0, {}, {})
    first = next(iter(methods.values()))
    stress, failures = {}, {}
    x, every = _columns(first)
    depths = depths_of(first.contact_radius, interfaces, LEVELS)
    for name, solution in methods.items():
        try:
            stress[name] = tuple(_layer(solution, x, every, z, k) for k, z in enumerate(depths))
        except Exception as error:  # no picture is worth a result
            failures[name] = f"{type(error).__name__}: {' '.join(str(error).split())[:300]}"
    return Plane(x, depths, float(first.contact_radius), stress, failures)


def _layer(solution: Any, x: Array, every: NDArray[np.int_], z: Array, layer: int) -> Array:
    """The four stresses in one layer, (4, nz, nx)."""
    if hasattr(solution, "stress_plane"):
        middle, shallow = len(solution.nodes) // 2, SHALLOW * solution.diagnostics.patch_size
        planes = [
            # Whole planes are quicker, but stand on patches that are not refined towards the surface.
            solution.stress(x, 0.0, depth, layer=layer)
            if depth < shallow
            else solution.stress_plane(float(depth), layer)[:, :, every, middle]
            for depth in z
        ]
        sigma = np.stack(planes, axis=2)
    else:
        sigma = solution.stress(x[None, :], 0.0, z[:, None], layer=layer)
    return np.array([sigma[component] for component in COMPONENTS.values()])


def _columns(solution: Any) -> tuple[Array, NDArray[np.int_]]:
    """Nodes drawn [m], the one at x = 0 among them, with their numbers."""
    a = solution.contact_radius
    nodes = np.asarray(solution.nodes if hasattr(solution, "stress_plane") else solution.surface_nodes)
    inside = np.flatnonzero(np.abs(nodes) <= WIDTH * a)
    middle = int(np.argmin(np.abs(nodes)))
    step = max(1, round((inside.size - 1) / (COLUMNS - 1)))
    number = np.arange(nodes.size)
    chosen = (number - middle) % step == 0
    chosen |= np.abs(np.abs(nodes) - a) < EDGE * a
    every = inside[chosen[inside]]
    return nodes[every], every


def depths_of(a: float, interfaces: tuple[float, ...], levels: int) -> tuple[Array, ...]:
    """Depths [m] of each layer drawn under a contact of radius ``a`` [m], about ``levels`` in all.

    The first and the last of a layer lie on its interfaces; layers that begin below the drawing are left out.
    """
    bottom = max(DEPTH, min(1.3 * max(interfaces, default=0.0) / a, DEEPEST)) * a
    bounds = np.array([0.0, *(z for z in interfaces if z < bottom), bottom]) ** CROWDING
    counts = [max(FEWEST, 1 + round((levels - 1) * float(part) / bounds[-1])) for part in np.diff(bounds)]
    ladders = []
    for low, high, count in zip(bounds[:-1], bounds[1:], counts, strict=True):
        z = np.linspace(low, high, count) ** (1 / CROWDING)
        ladders.append(z)
    # Both sides of an interface lie on it to the last bit.
    for k, depth in enumerate(interfaces[: len(ladders) - 1]):
        ladders[k][-1] = ladders[k + 1][0] = depth
    return tuple(ladders)


def plane_path(folder: Path, name: str) -> Path:
    """Where the plane of the case called ``name`` lies in a run directory."""
    return folder / "planes" / f"{name}.json"


def write_plane(path: Path, plane: Plane, case_file: str) -> None:
    """Store ``plane`` with the case file it came from; nine digits, a billionth of the largest stress."""
    peaks = [float(np.max(np.abs(s))) for some in plane.stress.values() for s in some]
    largest = max((peak for peak in peaks if np.isfinite(peak)), default=0.0)
    digits = 0 if not largest > 0 else 9 - int(np.ceil(np.log10(largest)))
    content = {
        "schema": SCHEMA,
        "case_file": case_file,
        "x": plane.x.tolist(),
        "depths": [z.tolist() for z in plane.depths],
        "radius": plane.radius,
        "components": list(COMPONENTS),
        # NaN and infinity become text: what a method gave is kept, and the JSON stays strict.
        "stress": {name: [plain(np.round(s, digits)) for s in some] for name, some in plane.stress.items()},
        "failures": dict(plane.failures),
    }
    write_checked(path, content)


def read_plane(path: Path, case_file: str) -> Plane:
    """The plane stored at ``path``.

    Raises StoreError where it is missing, damaged or of another case file.
    """
    data = read_checked(path)
    if (data.get("schema"), data.get("case_file")) != (SCHEMA, case_file):
        raise StoreError(f"{path}: of another case file or version of this program; run the case again")
    try:
        return Plane(
            np.array(data["x"], dtype=float),
            tuple(np.array(z, dtype=float) for z in data["depths"]),
            float(data["radius"]),
            {
                str(name): tuple(np.array(s, dtype=float) for s in some)
                for name, some in data["stress"].items()
            },
            {str(name): str(sentence) for name, sentence in data["failures"].items()},
        )
    except (ValueError, KeyError, TypeError, AttributeError):
        raise StoreError(f"{path}: not a whole plane; it is damaged, run the case again") from None


def read_planes(folder: Path, results: Iterable[CaseResult]) -> dict[str, Plane]:
    """The planes that a run directory holds of ``results``, by name of the case."""
    found = {}
    for result in results:
        with suppress(StoreError):  # a case without a result, or printed, has no plane
            found[result.name] = read_plane(plane_path(folder, result.name), result.text)
    return found
