"""Two bodies coupled at the surface on which they touch.

The ball is reflected in the surface: with v_z = -u_z of the ball, z into it, both bodies have one axial
displacement w on the contact but for the jump that closes the gap,

    u_z (flat) = w,   v_z (ball) = w - jump,   u_z (flat) + u_z (ball) = jump,

while their radial displacements are independent, since the contact transmits no shear. The matrix of both is
positive definite. Each body is eliminated as by itself; the unknowns w come last.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .axisymmetric import Discretisation, Stiffness, constrained_solve
from .dissection import unknowns
from .factorisation import Elimination, elimination
from .scaling import LayeredSolid

__all__ = ["Coupling"]

Solids = tuple[LayeredSolid, LayeredSolid]


@dataclass(frozen=True, eq=False)
class Coupling:
    """Discretisations of ``flat`` and ``ball`` with the same nodes on the surface.

    Raises ValueError where their surfaces differ.
    """

    flat: Discretisation
    ball: Discretisation

    def __post_init__(self) -> None:
        one, two = (d.locations[0, d.surface] for d in (self.flat, self.ball))
        if one.shape != two.shape or not np.allclose(one, two, rtol=1e-12, atol=0):
            raise ValueError("the meshes of flat and ball have different nodes on the surface")

    def moved(self, flat: Discretisation, ball: Discretisation) -> "Coupling":
        """The same coupling on other meshes; those of the same triangles keep the order of elimination."""
        new = Coupling(flat, ball)
        if "_elimination" in vars(self) and all(
            one.mesh.triangles is two.mesh.triangles for one, two in ((flat, self.flat), (ball, self.ball))
        ):
            vars(new).update(_elimination=self._elimination)
        return new

    @cached_property
    def _numbers(self) -> np.ndarray:
        """Unknown of the pair for each unknown of the ball, (2 N,): on the contact that of the flat."""
        flat, ball = self.flat, self.ball
        own = np.ones(2 * ball.N, dtype=bool)
        own[ball.N + ball.contact] = False
        numbers = 2 * flat.N - 1 + np.cumsum(own)
        numbers[ball.N + ball.contact] = flat.N + flat.contact
        return numbers

    @cached_property
    def _nodes(self) -> np.ndarray:
        """Unknowns of each triangle of the flat, then of the ball, by node, then field."""
        one, two = (unknowns(np.asarray(d.basis.element_dofs).T, 2, d.N) for d in (self.flat, self.ball))
        return np.concatenate([one, self._numbers[two]])

    @cached_property
    def _elimination(self) -> Elimination:
        def leaf() -> np.ndarray:
            one, two = self.flat.leaf, self.ball.leaf
            top = max(int(leaf.max()).bit_length() for leaf in (one, two))
            return np.concatenate([one, two + 2**top])

        return elimination(self._nodes, leaf)

    def solve(
        self, solids: Solids, jump: np.ndarray, far: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Displacements of flat and ball, several cases in columns.

        jump : of u_z at the contact nodes (nodes, columns).  far : load whose far field is prescribed,
        (columns,).
        Returns the field vectors (2 N, columns) of flat and ball, the nodal forces (nodes, columns) on the
        flat, and the forces out of balance (n, columns).
        """
        sign = np.tile([1.0, -1.0], self.flat.basis.Nbfun)
        elements = np.empty((len(self._nodes), sign.size, sign.size))
        halves = np.split(elements, [self.flat.mesh.layer.size])
        for d, solid, half in zip((self.flat, self.ball), solids, halves, strict=True):
            d.element_stiffness(solid.materials, 0, out=half)
        halves[1] *= sign[:, None] * sign
        K = Stiffness(elements, self._nodes, self._elimination)
        sides = ((self.flat, np.arange(2 * self.flat.N), 1.0), (self.ball, self._numbers, -1.0))
        given = np.zeros((int(self._nodes.max()) + 1, far.size))
        fixed = []
        for (d, number, axial), solid in zip(sides, solids, strict=True):
            u_r, u_z = solid.far_displacement(*d.locations[:, d.outer])
            given[number[d.outer]] = u_r[:, None] * far
            given[number[d.N + d.outer]] = axial * u_z[:, None] * far
            given[number[d.axis]] = 0.0
            fixed += [number[d.outer], number[d.N + d.outer], number[d.axis]]

        apart = np.zeros((2 * self.ball.N, far.size))
        apart[self.ball.N + self.ball.contact] = -jump
        load = np.zeros(given.shape)
        of_ball = Stiffness(halves[1], np.asarray(self.ball.basis.element_dofs).T, self._elimination)
        load[self._numbers] = -(of_ball @ apart)
        u = constrained_solve(K, given, np.concatenate(fixed), load)

        balance = K @ u - load
        balance[np.concatenate(fixed)] = 0.0
        flat, ball = u[: 2 * self.flat.N], u[self._numbers] + apart
        ball[self.ball.N :] *= -1
        of_flat = Stiffness(halves[0], np.asarray(self.flat.basis.element_dofs).T, self._elimination)
        reaction = (of_flat @ flat)[self.flat.N + self.flat.contact]
        return flat, ball, reaction, balance
