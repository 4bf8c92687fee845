"""The door of nodal files: stresses and displacements between the nodes of somebody else's mesh.

    f(x) = sum over the corners i of the simplex around x of lambda_i(x) q_i(x)

lambda_i : barycentric coordinates in the Delaunay triangulation of the nodes of one layer.   q_i : the cubic
polynomial that fits the nodes around node i best. The interpolation error is taken to be the largest
|q_i - f|; where this is more than the distance of f from linear interpolation, at kinks, f is the latter. A
node has one value for each layer that it belongs to; where it has the same one for two materials, their
stresses were averaged.
"""

from dataclasses import dataclass, field
from functools import cached_property, partial
from itertools import combinations_with_replacement
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import Delaunay

from verification.guests.doors.nodal_files import NodalFields, letters_of, read_nodes
from verification.guests.doors.serve_function import problem_of, values_of
from verification.guests.exam_subjects import Load
from verification.guests.guest_protocol import ProtocolError, Question
from verification.problem.array_types import Array
from verification.problem.evaluation_points import layer_at
from verification.problem.point_answers import NotClaimed
from verification.running.json_records import plain

SLACK = 1e-4  # of the reach of the points: by as much a node may miss an interface, a point the mesh
INSIDE = 1e-7  # by as much a point at the rim is moved into the mesh
BEYOND = 6.0  # times the reach of the points: nodes farther away are not used
LEAST = 12  # nodes of a layer
SAME = 1e-5  # of the largest stress on an interface, by which values of two layers differ by their digits
SYMMETRIC = {(0, 0): 0, (1, 1): 1, (2, 2): 2, (1, 2): 3, (0, 2): 4, (0, 1): 5}
ODD = np.array([[p.count(axis) % 2 for p in (*SYMMETRIC, (0,), (1,), (2,))] for axis in range(3)]) == 1


def answer_of(path: Path, axes: list[str], question: Question, stated: bool) -> dict[str, Any]:
    """Parts of an answer to ``question`` by the nodes of ``path``, with remarks.

    stated : whether the interpolation error is stated as the uncertainty.   Raises ProtocolError.
    """
    problem = problem_of(question)
    reach = max([question.edge or 0.0, *(abs(v) for q in question.lines for v in (*q.x, *q.y, *q.z))])
    nodes = LayeredNodes.of(read_nodes(path, axes), axes, problem, reach, path)
    result = {}
    for name in nodes.has:
        result[name] = partial(nodes.field, name, 0)
        if stated:
            result[f"{name}_uncertainty"] = partial(nodes.field, name, 1)
    found: dict[str, Any] = plain(values_of(result, problem, question))
    return found | {"warnings": nodes.remarks}


@dataclass(frozen=True, eq=False)
class LayeredNodes:
    """Nodes of each layer of ``problem`` at ``places`` (n, d), with ``values`` (n, 9): stress, displacement.

    Places are r, z of an axisymmetric model, else x, z of a plane or x, y, z; components lie along x, y, z,
    which at a node of an axisymmetric model are r, t, z.   has : the fields that there are.
    """

    problem: Load
    reach: float
    axisymmetric: bool
    places: tuple[Array, ...]
    values: tuple[Array, ...]
    has: tuple[str, ...]
    remarks: list[str] = field(default_factory=list)

    @classmethod
    def of(
        cls, given: NodalFields, axes: list[str], problem: Load, reach: float, path: Path
    ) -> "LayeredNodes":
        """The nodes of a file in the axes of coatcheck, in their layers. Raises ProtocolError."""
        Q, axisymmetric = turned(axes), any("r" in axis for axis in axes)
        x = given.points @ Q.T
        if axisymmetric:
            r, (c, s) = _direction(x[:, 0], x[:, 1])
            Q = np.moveaxis(_about_z(c, -s), 2, 0) @ Q
            x = np.array([r, 0 * r, x[:, 2]]).T
        if x[:, 2].max(initial=-1.0) <= SLACK * reach:
            raise ProtocolError(f'{path}: no node lies below z = 0; if z points upwards, set "-z" in axes')
        values, has = np.zeros((len(x), 9)), []
        if given.stress is not None:
            sigma = np.einsum("...ia,ab...,...jb->ij...", Q, given.stress, Q)
            values[:, :6] = np.array([sigma[c] for c in SYMMETRIC]).T
            has += ["stress", "pressure"]
        if given.displacement is not None:
            values[:, 6:] = np.einsum("...ia,a...->...i", Q, given.displacement)
            has += ["displacement"]
        flat = np.ptp(x[:, 1]) <= SLACK * reach
        depths = np.cumsum([0.0, *(h for _, _, h in problem.coatings)])
        keep = np.isfinite(values).all(axis=1) & (np.abs(x).max(axis=1) <= BEYOND * reach)
        places, found = [], []
        for layer, of in enumerate(layers_of(given, x, depths, SLACK * reach)):
            mine = keep & of
            if mine.sum() < LEAST:
                raise ProtocolError(f"{path}: {mine.sum()} nodes in layer {layer} near the contact")
            places.append(x[mine][:, [0, 2] if flat else [0, 1, 2]])
            found.append(values[mine])
        nodes = cls(problem, reach, axisymmetric, tuple(places), tuple(found), tuple(has))
        nodes.remarks.extend(f"{path.name}: {text}" for text in averaged(nodes, depths))
        return nodes

    @cached_property
    def interpolants(self) -> list["Interpolant"]:
        """One for each layer; nodes of half a body that lie on one side alone are mirrored."""
        even = [0, 1] if self.axisymmetric or not getattr(self.problem, "friction", 0.0) else [1]
        found = []
        for x, f in zip(self.places, self.values, strict=True):
            for column in range(x.shape[1] - 1):
                axis = 1 if column else 0
                lowest = x[:, column].min()
                if axis in even and lowest >= -SLACK * self.reach:
                    twice = x[:, column] > SLACK * self.reach
                    image = np.where(np.arange(x.shape[1]) == column, -1.0, 1.0)
                    x = np.concatenate([x, x[twice] * image])
                    f = np.concatenate([f, f[twice] * np.where(ODD[axis], -1.0, 1.0)])
            found.append(Interpolant(x, f, self.reach))
        return found

    def field(
        self, name: str, error: int, x: Array, y: Array, z: ArrayLike = 0.0, layer: int | None = None
    ) -> Array:
        """Values of a field at points, 0, or their interpolation errors, 1; on z = 0 the pressure."""
        x, y, z = np.broadcast_arrays(x, y, z)
        flat = self.places[0].shape[1] == 2
        if flat and not self.axisymmetric and np.abs(y).max(initial=0.0) > SLACK * self.reach:
            raise NotClaimed("the nodes lie in the plane y = 0 alone")
        r, (c, s) = _direction(x, y) if self.axisymmetric else (x, (1.0 + 0 * x, 0 * x))
        points = np.array([r, z] if flat else [x, y, z]).T
        layers = layer_at(z, self.problem.coatings, layer)
        v = np.empty((9, x.size))
        for k in np.unique(layers):
            v[:, layers == k] = self.interpolants[k].at(points[layers == k])[error].T
        Q = np.abs(_about_z(c, s)) if error else _about_z(c, s)
        if name == "displacement":
            return np.einsum("ian,an->in", Q, v[6:])
        sigma = np.array([[v[SYMMETRIC[min(i, j), max(i, j)]] for j in range(3)] for i in range(3)])
        sigma = np.einsum("ian,abn,jbn->ijn", Q, sigma, Q)
        return sigma if name == "stress" else sigma[2, 2] * (1 if error else -1)


def _direction(x: Array, y: Array) -> tuple[Array, Array]:
    """r, then x/r and y/r; along x on the axis."""
    r = np.hypot(x, y)
    return r, np.where(r > 0, np.array([x, y]) / np.where(r > 0, r, 1.0), [[1.0], [0.0]])


def _about_z(c: Array, s: Array) -> Array:
    """Matrices (3, 3, n) of a rotation about z by angles of these cosines and sines."""
    o, one = 0 * c, 1 + 0 * c
    return np.array([[c, -s, o], [s, c, o], [o, o, one]])


def turned(axes: list[str]) -> Array:
    """The matrix from the axes of a file to x, y, z; the axis that is not named is the third."""
    Q = np.zeros((3, 3))
    for column, letter in enumerate(letters_of(axes)):
        Q["xyz".index(letter), column] = -1.0 if column < len(axes) and axes[column][0] == "-" else 1.0
    return Q


def layers_of(given: NodalFields, x: Array, depths: Array, slack: float) -> list[NDArray[np.bool_]]:
    """Which nodes belong to each layer: by the middle of their cells, by their number, or by their depth.

    Raises ProtocolError where their numbers are not as many as the layers.
    """
    count = len(depths)
    found = [np.zeros(len(x), dtype=bool) for _ in range(count)]
    if given.layer is not None:
        numbers = np.unique(given.layer)
        if len(numbers) != count:
            raise ProtocolError(f"its nodes are of {len(numbers)} layers; this problem has {count}")
        order = np.argsort([x[given.layer == number, 2].mean() for number in numbers])
        return [given.layer == numbers[i] for i in order]
    for cells in given.cells:
        middle = x[cells, 2].mean(axis=1)
        of = np.searchsorted(depths, middle) - 1  # -1 above the surface: the indenter
        for layer in range(count):
            found[layer][cells[of == layer]] = True
    if not given.cells:
        for layer in range(count):
            end = depths[layer + 1] if layer + 1 < count else np.inf
            found[layer] = (x[:, 2] >= depths[layer] - slack) & (x[:, 2] <= end + slack)
    return found


def averaged(nodes: LayeredNodes, depths: Array) -> list[str]:
    """A remark for each interface where most nodes have one stress in its plane for both materials."""
    found = []
    for k, depth in enumerate(depths[1:]) if "stress" in nodes.has else ():
        sides: list[dict[tuple[float, ...], Array]] = []
        for x, f in zip(nodes.places[k : k + 2], nodes.values[k : k + 2], strict=True):
            on = np.abs(x[:, -1] - depth) <= SLACK * nodes.reach
            keys = np.round(x[on, :-1] / (SLACK * nodes.reach)).tolist()
            sides.append({tuple(key): v for key, v in zip(keys, f[on, :2], strict=True)})
        both = sides[0].keys() & sides[1].keys()
        scale = max((np.abs(side[key]).max() for side in sides for key in both), default=0.0)
        same = sum(bool(np.abs(sides[0][key] - sides[1][key]).max() <= SAME * scale) for key in both)
        if both and 2 * same > len(both):
            found.append(
                f"{same} of {len(both)} nodes of the interface at z = {depth:.4g} have one value for two "
                "materials: sigma_xx and sigma_yy are averaged across it; write a value for each layer"
            )
    return found


class Interpolant:
    """Values ``f`` (n, m) at scattered places ``x`` (n, d) of one layer; those of one place are averaged."""

    def __init__(self, x: Array, f: Array, reach: float) -> None:
        _, first, same = np.unique(
            np.round(x / (0.01 * SLACK * reach)), axis=0, return_index=True, return_inverse=True
        )
        count = np.bincount(same.ravel())
        self.f = np.array([np.bincount(same.ravel(), column) / count for column in f.T]).T
        self.x, self.reach = x[first], reach
        self.low, self.high = self.x.min(axis=0), self.x.max(axis=0)
        self.mesh = Delaunay(self.x / reach)
        self.fits: dict[int, tuple[float, Array]] = {}

    def at(self, points: Array) -> Array:
        """Values and interpolation errors at ``points`` (k, d): (2, k, m). Raises IndexError outside."""
        slack, inside = SLACK * self.reach, INSIDE * self.reach
        if ((points < self.low - slack) | (points > self.high + slack)).any():
            raise IndexError("outside the nodes of this layer")
        points = np.clip(points, self.low + inside, self.high - inside)
        found = self.mesh.find_simplex(points / self.reach, tol=1e-9)
        values = np.empty((2, len(points), self.f.shape[1]))
        for k, (x, simplex) in enumerate(zip(points, found, strict=True)):
            if simplex < 0:
                raise IndexError("outside the nodes of this layer")
            corners = self.mesh.simplices[simplex]
            T = self.mesh.transform[simplex]
            part = T[:-1] @ (x / self.reach - T[-1])
            share = np.clip([*part, 1 - part.sum()], 0.0, 1.0)
            linear, q = share @ self.f[corners], np.array([self._polynomial(i, x) for i in corners])
            error = np.abs(q - share @ q).max(axis=0)
            smooth = error < np.abs(share @ q - linear)
            values[:, k] = np.where(smooth, share @ q, linear), error
        return values

    def _polynomial(self, i: int, x: Array) -> Array:
        """The cubic around node ``i`` at ``x``."""
        if i not in self.fits:
            near = self._around(i)
            d = self.x[near] - self.x[i]
            distance = np.linalg.norm(d, axis=1)
            weight = 1 / np.maximum(distance, distance[distance > 0].min())[:, None]
            size = distance.max()
            fit = np.linalg.lstsq(weight * _powers(d / size), weight * self.f[near])[0]
            self.fits[i] = size, fit
        size, fit = self.fits[i]
        return _powers((x - self.x[i])[None] / size)[0] @ fit

    def _around(self, i: int) -> NDArray[np.int_]:
        """The neighbours of node ``i`` with their own neighbours."""
        start, nodes = self.mesh.vertex_neighbor_vertices
        ring = nodes[start[i] : start[i + 1]]
        return np.unique(np.concatenate([ring, *(nodes[start[j] : start[j + 1]] for j in ring)]))


def _powers(d: Array) -> Array:
    """Monomials up to the third degree of displacements (n, d)."""
    terms = [c for degree in range(4) for c in combinations_with_replacement(range(d.shape[1]), degree)]
    return np.array([np.prod(d[:, c], axis=1) for c in terms]).T
