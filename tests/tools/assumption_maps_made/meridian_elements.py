"""Meridian plane of a layered half-space in spectral elements, graded to the contact edge.

Rectangles of a tensor grid, isoparametric, Lagrange polynomials at Gauss-Lobatto points:

    r = A [1 + e sinh(xi)],      z = e sinh(zeta),      uniform steps of xi, and of zeta between interfaces.

A is the contact radius, always the end of an element; with A all radii change and no depth does. A high
degree converges fast where fields are smooth and does not lock near incompressibility; the edge is left to
elements of the size e. Canuto, Hussaini, Quarteroni and Zang, Spectral Methods (2006).
"""

from typing import Any

import numpy as np
from numpy.polynomial import legendre
from scipy.interpolate import BarycentricInterpolator

from verification.problem.array_types import Array
from verification.problem.gauss_legendre import gauss_legendre

AXIS = 4  # elements in place of the one next to the axis, which the grading leaves too wide


def lagrange(nodes: Array, x: Array) -> tuple[Array, Array]:
    """Lagrange polynomials of ``nodes`` at ``x``, then their derivatives; (x, nodes) each."""
    coefficients = np.linalg.inv(legendre.legvander(nodes, nodes.size - 1))
    slopes = [legendre.legval(x, legendre.legder(column)) for column in coefficients.T]
    return BarycentricInterpolator(nodes, np.eye(nodes.size))(x), np.stack(slopes, axis=1)


class Meridian:
    """Grid of 0 <= r/A, z <= ``far``; lengths over the first contact radius.

    depths : of the interfaces.   degree : of the polynomials.   step : largest of xi and zeta in an element.
    edge : e.

    nodes : Gauss-Lobatto points on -1 .. 1.
    rho, z : r/A and z of the lines of nodes; node ``i * z.size + j`` lies at (A rho[i], z[j]).
    ends : elements within the contact, along r.   interface : line of nodes of the first interface.
    layer : (elements,) 0 at the surface; elements are numbered downwards, column by column.
    unknowns : (elements, 2 (degree + 1)^2) numbers 2 node of u_r, 2 node + 1 of u_z.
    B, weights : operator of the gradient, (elements, points, 5, unknowns), from displacements to the
        components rr, rz, zr, zz, tt at A = 1; r dr dz of each Gauss point at A = 1.
    """

    def __init__(self, depths: tuple[float, ...], far: float, degree: int, step: float, edge: float) -> None:
        self.degree, self.edge = degree, edge
        inner = legendre.legroots(legendre.legder([0] * degree + [1]))
        self.nodes = np.concatenate([[-1.0], inner, [1.0]])
        xi, _ = _divided(np.arcsinh(np.array([-1.0, 0.0, far - 1]) / edge), step)
        first = np.linspace(-1.0, edge * np.sinh(xi[1]), AXIS + 1)
        xi = np.concatenate([np.arcsinh(first / edge), xi[2:]])
        zeta, layers = _divided(np.arcsinh(np.array([0.0, *depths, far]) / edge), step)
        self.rho, self.z = 1 + edge * np.sinh(self._lines(xi)), edge * np.sinh(self._lines(zeta))
        self.rho[0] = 0.0
        self.ends = int(np.argmin(np.abs(xi)))
        self.interface = degree * int(np.count_nonzero(layers == 0))
        self.layer = np.tile(layers, xi.size - 1)
        across, down = self.of_elements(self.rho), self.of_elements(self.z)
        number = np.arange(self.rho.size * self.z.size).reshape(self.rho.size, -1)
        rows, columns = self._members(self.z.size), self._members(self.rho.size)
        nodes = number[columns[:, None, :, None], rows[None, :, None, :]].reshape(self.layer.size, -1)
        self.unknowns = (2 * nodes[..., None] + np.arange(2)).reshape(self.layer.size, -1)

        x, w = gauss_legendre(degree + 1)
        N, D = lagrange(self.nodes, x)
        r, dr, dz = across @ N.T, across @ D.T, down @ D.T

        def product(radial: Array, axial: Array) -> Array:
            """(elements, points, nodes) of (columns, x, nodes) and (rows, x, nodes)."""
            whole = np.einsum("isa,jtb->ijstab", radial, axial)
            return whole.reshape(self.layer.size, x.size**2, -1)

        wide, deep = np.ones((len(across), 1, 1)), np.ones((len(down), 1, 1))
        B = np.zeros((self.layer.size, x.size**2, 5, nodes.shape[1], 2))
        B[:, :, 0, :, 0] = B[:, :, 2, :, 1] = product(D / dr[..., None], deep * N)
        B[:, :, 1, :, 0] = B[:, :, 3, :, 1] = product(wide * N, D / dz[..., None])
        B[:, :, 4, :, 0] = product(N / r[..., None], deep * N)
        self.B = B.reshape(*B.shape[:3], -1)
        self.weights = np.einsum("is,jt->ijst", w * r * dr, w * dz).reshape(B.shape[:2])

    def _lines(self, ends: Array) -> Array:
        """Coordinates of all lines of nodes of the elements between ``ends``."""
        lines = ends[:-1, None] + np.diff(ends)[:, None] * (self.nodes[:-1] + 1) / 2
        return np.append(lines.ravel(), ends[-1])

    def _members(self, lines: int) -> Any:
        """Lines of each element, (elements along the line, degree + 1)."""
        first = np.arange(0, lines - 1, self.degree)
        return first[:, None] + np.arange(self.degree + 1)

    def of_elements(self, values: Array) -> Array:
        """``values`` at the nodes of a line by element, (elements, degree + 1)."""
        return values[self._members(values.size)]

    def density(self, r: Array, forces: Array) -> Array:
        """g at the nodes of a line at radii ``r``, with int g N r dr = ``forces``.

        The traction in equilibrium with nodal forces, by the quadrature of these.
        """
        x, w = gauss_legendre(self.degree + 1)
        N, D = lagrange(self.nodes, x)
        at, mass = self.of_elements(r), np.zeros((r.size, r.size))
        for members, weight in zip(self._members(r.size), w * (at @ N.T) * (at @ D.T), strict=True):
            mass[np.ix_(members, members)] += (N.T * weight) @ N
        return np.asarray(np.linalg.solve(mass, forces))


def _divided(levels: Array, step: float) -> tuple[Array, Array]:
    """Ends of elements no longer than ``step`` between ``levels``, then the interval of each element."""
    counts = np.maximum(np.ceil(np.diff(levels) / step), 1).astype(int)
    parts = [
        np.linspace(start, end, count, endpoint=False)
        for start, end, count in zip(levels[:-1], levels[1:], counts, strict=True)
    ]
    return np.append(np.concatenate(parts), levels[-1]), np.repeat(np.arange(counts.size), counts)
