"""Response of a layered half-space to a normal load, in complex balls.

A field e^{ikL} under the surface solves y' = k N y for y = (2 G1 k U, 2 G1 k w, T, S), with G1 of the first
layer, u_L = i U, u_z = w, s_Lz = i T, s_zz = S. In each layer, s from its top, t from its bottom, x = k h,

    y = B e^{-ks} X(ks) c + J B e^{-kt} X(kt) g,   X(x) = [[1, x], [0, 1]],   J = diag(1, -1, -1, 1)
    B = [U0; T0],  U0 = [[1, 0], [-1, -(3 - 4 nu)]] G1/G,  T0 = [[-1, -(1 - 2 nu)], [1, 2 (1 - nu)]]

N B = B [[-1, 1], [0, -1]] is Hooke's law with equilibrium; J mirrors z. The waves that rise from the bottom
are g = R d, with d = P c those that arrive there, P = e^{-x} X(x). Both sides of an interface have one y.
With ' for the layer below, S' = P' R' P', 0 of the substrate, and constant 2 x 2 matrices R0, V, Q, F,

    [J B, -B'] (R0, V) = -B,   [J B, -B'] (Q, F) = J B',   R = R0 + Q S' (1 - F S')^{-1} V           (R1)
    surface T = 0, S = -1:   c = (1 + F0 S)^{-1} c0,   T0 F0 = J T0,   T0 c0 = (0, -1)               (R2)

Long waves, for which (R2) is nearly singular below a stiff layer, use the propagator instead,

    y(top) = exp(-N x) y(bottom)
    exp(N x) = cosh x + N sinh x + Q (x sinh x)/2 + N Q (x cosh x - sinh x)/2,   Q = N^2 - 1,   Q^2 = 0   (R3)

Reflection matrices: Kennett, Seismic Wave Propagation in Stratified Media (1983), ch. 6; derived for statics.
"""

from collections.abc import Iterator
from dataclasses import dataclass, fields
from itertools import pairwise

from flint import acb, arb, arb_mat

from verification.problem.array_types import Coatings

Matrix = tuple[acb, acb, acb, acb]  # 2 x 2, by rows
LONG = 3.0  # k times all thicknesses, below which waves are long


@dataclass(frozen=True)
class Amplitudes:
    """Balls of the response at one wavenumber, per unit pressure; (sigma_xx + sigma_yy)/2 of the stresses.

    excess : M - 1, with u_z = (1 - nu1)/(G1 k) M p on the surface.
    surface : less that of the homogeneous solid of the first material.
    upper, lower : at the first interface.
    """

    excess: acb
    surface: acb
    upper: acb
    lower: acb

    def __iter__(self) -> Iterator[acb]:
        return (getattr(self, f.name) for f in fields(self))


class LayeredSolid:
    """``coatings`` ((E, nu, thickness), ...) on ``substrate`` (E, nu), binary numbers taken as exact."""

    def __init__(self, coatings: Coatings, substrate: tuple[float, float]) -> None:
        solids = [(arb(E), arb(nu)) for E, nu, *_ in (*coatings, substrate)]
        self.nu = [nu for _, nu in solids]
        G = [E / (2 * (1 + nu)) for E, nu in solids]
        self.g = [one / G[0] for one in G]
        self.thickness = [arb(h) for _, _, h in coatings]
        basis = [_basis(g, nu) for g, nu in zip(self.g, self.nu, strict=True)]
        self._interfaces = [_interface(above, below) for above, below in pairwise(basis)]
        U0, T0 = _rows(basis[0], 0), _rows(basis[0], 2)
        JU, JT = (_rows(_mirrored(basis[0]), start) for start in (0, 2))
        self._F0 = _complex(T0.inv() * JT)
        start = T0.inv() * arb_mat([[0], [-1]])
        self._c0 = acb(start[0, 0]), acb(start[1, 0])
        # displacements in excess of the homogeneous solid's: (J U0 - U0 F0) S c
        self._excess = _complex(JU - U0 * T0.inv() * JT)
        self._base = basis[-1]
        self._first = [(basis[0][j, 0], basis[0][j, 1]) for j in (0, 3)]

    def amplitudes(self, k: acb) -> Amplitudes:
        """Response at wavenumber ``k`` [rad/m]: a point or a rectangle.

        Values are not finite where a system cannot be shown to be regular over the rectangle.
        """
        x = [k * h for h in self.thickness]
        return self.propagated(x) if sum(abs(one) for one in x) < LONG else self.reflected(x)

    def propagated(self, x: list[acb]) -> Amplitudes:
        """By (R3), of the thicknesses ``x`` = k h."""
        columns = [[acb(self._base[j, i]) for j in range(4)] for i in range(2)]
        for i in reversed(range(len(x))):
            below = columns
            columns = [_raised(column, x[i], self.g[i], self.nu[i]) for column in columns]
        (a, b), (c, d) = ([column[row] for column in columns] for row in (2, 3))
        one = 1 / (a * d - b * c)
        # the tractions (0, -1) of the combination of both columns
        v = b * one, -a * one
        U, w = (v[0] * columns[0][row] + v[1] * columns[1][row] for row in (0, 1))
        y = [v[0] * below[0][row] + v[1] * below[1][row] for row in (0, 3)]
        nu = self.nu[0]
        return self._of(U - (1 - 2 * nu), w - 2 * (1 - nu), y)

    def _of(self, U: acb, w: acb, y: list[acb]) -> Amplitudes:
        """From the surface displacements less the homogeneous solid's, and (U, S) on the interface."""
        nu = self.nu[0]
        # s_zz on the surface is prescribed, so that the excess has the part of U alone
        surface = -(1 + nu) / (2 * (1 - nu)) * U
        return Amplitudes(w / (2 * (1 - nu)), surface, self._mean(0, *y), self._mean(1, *y))

    def reflected(self, x: list[acb]) -> Amplitudes:
        """By (R1) and (R2), of the thicknesses ``x`` = k h."""
        R, S = self._reflection(x)
        c = _times(_inverse(_plus(IDENTITY, _product(self._F0, S))), self._c0)
        U, w = _times(self._excess, _times(S, c))
        e = (-x[0]).exp()
        d = e * (c[0] + x[0] * c[1]), e * c[1]
        g = _times(R, d)
        # J leaves the rows of U, of S as they are
        y = [B[0] * (d[0] + g[0]) + B[1] * (d[1] + g[1]) for B in self._first]
        return self._of(U, w, y)

    def _mean(self, layer: int, U: acb, S: acb) -> acb:
        """(s_LL + s_TT)/2 with s_LL = [nu S - 2 G k U]/(1 - nu), s_TT = nu (s_LL + S)."""
        g, nu = self.g[layer], self.nu[layer]
        return ((1 + nu) * (nu * S - g * U) / (1 - nu) + nu * S) / 2

    def _reflection(self, x: list[acb]) -> tuple[Matrix, Matrix]:
        """R, S of the first layer by (R1), from the substrate upwards."""
        S = ZERO
        for depth, interface in zip(reversed(x), reversed(self._interfaces), strict=True):
            R = _reflected(interface, S)
            a, b, c, d = R
            e = (-2 * depth).exp()
            S = (e * (a + depth * c), e * (b + depth * (a + d + depth * c)), e * c, e * (d + depth * c))
        return R, S

    def tail(self, k: arb) -> tuple[arb, arb]:
        """Bounds beyond a wavenumber ``k`` > 0, with x = k h of the first layer.

        Returns C, D such that for every greater wavenumber |excess| and |surface| <= C (1 + x)^2 e^{-2x},
        |upper| and |lower| <= D (1 + x) e^{-x}.

        |P| <= (1 + x) e^{-x} in the maximum norm, which falls with x, so that (R1) and (R2) with rectangles
        that hold every S beyond k bound R and c. Not finite where these may be singular.
        """
        S = ZERO
        for h, interface in zip(reversed(self.thickness), reversed(self._interfaces), strict=True):
            R = _norm(_reflected(interface, S))
            S = _within(R * ((1 + k * h) * (-k * h).exp()) ** 2)
        c = _times(_inverse(_plus(IDENTITY, _product(self._F0, S))), self._c0)
        c_max = c[0].abs_upper().max(c[1].abs_upper())
        nu = self.nu[0]
        C = (1 + nu.max(arb(0))) / (2 * (1 - nu)) * _norm(self._excess) * R * c_max
        U, stress = ((abs(B[0]) + abs(B[1])) * (1 + R) * c_max for B in self._first)
        D = arb(0)
        for g, nu in zip(self.g[:2], self.nu[:2], strict=True):
            D = D.max(((1 + nu) * (abs(nu) * stress + g * U) / (1 - nu) + abs(nu) * stress) / 2)
        return C.upper(), D.upper()


def _raised(y: list[acb], x: acb, g: arb, nu: arb) -> list[acb]:
    """exp(-N x) y of (R3), N from Hooke's law and equilibrium."""

    def N(y: list[acb]) -> list[acb]:
        U, w, T, S = y
        return [2 * T / g - w, (nu * U + (1 - 2 * nu) * S / g) / (1 - nu), (g * U - nu * S) / (1 - nu), T]

    ch, sh = x.cosh(), x.sinh()
    first = N(y)
    second = [twice - once for twice, once in zip(N(first), y, strict=True)]
    terms = zip(y, first, second, N(second), strict=True)
    return [ch * a - sh * b + x * sh / 2 * c - (x * ch - sh) / 2 * d for a, b, c, d in terms]


def _basis(g: arb, nu: arb) -> arb_mat:
    """B of the docstring, 4 x 2."""
    return arb_mat([[1 / g, 0], [-1 / g, -(3 - 4 * nu) / g], [-1, -(1 - 2 * nu)], [1, 2 * (1 - nu)]])


def _mirrored(B: arb_mat) -> arb_mat:
    """J B."""
    return arb_mat([[sign * B[j, 0], sign * B[j, 1]] for j, sign in enumerate((1, -1, -1, 1))])


def _rows(B: arb_mat, start: int) -> arb_mat:
    """Two rows of a matrix of two columns."""
    return arb_mat([[B[start + j, 0], B[start + j, 1]] for j in range(2)])


def _complex(A: arb_mat) -> Matrix:
    return acb(A[0, 0]), acb(A[0, 1]), acb(A[1, 0]), acb(A[1, 1])


def _interface(above: arb_mat, below: arb_mat) -> tuple[Matrix, Matrix, Matrix, Matrix]:
    """R0, V, Q, F of (R1)."""
    up = _mirrored(above)
    inverse = arb_mat([[up[j, 0], up[j, 1], -below[j, 0], -below[j, 1]] for j in range(4)]).inv()
    first, second = inverse * -above, inverse * _mirrored(below)
    return _complex(first), _complex(_rows(first, 2)), _complex(second), _complex(_rows(second, 2))


def _reflected(interface: tuple[Matrix, Matrix, Matrix, Matrix], S: Matrix) -> Matrix:
    """R of (R1) above a layer of this S."""
    R0, V, Q, F = interface
    if S is ZERO:
        return R0
    a, b, c, d = _product(F, S)
    one_less = 1 - a, -b, -c, 1 - d
    return _plus(R0, _product(_product(Q, S), _product(_inverse(one_less), V)))


ZERO: Matrix = (acb(0), acb(0), acb(0), acb(0))
IDENTITY: Matrix = (acb(1), acb(0), acb(0), acb(1))


def _plus(A: Matrix, B: Matrix) -> Matrix:
    return A[0] + B[0], A[1] + B[1], A[2] + B[2], A[3] + B[3]


def _product(A: Matrix, B: Matrix) -> Matrix:
    a, b, c, d = A
    e, f, g, h = B
    return a * e + b * g, a * f + b * h, c * e + d * g, c * f + d * h


def _times(A: Matrix, v: tuple[acb, acb]) -> tuple[acb, acb]:
    return A[0] * v[0] + A[1] * v[1], A[2] * v[0] + A[3] * v[1]


def _inverse(A: Matrix) -> Matrix:
    """Not finite where the determinant may vanish."""
    a, b, c, d = A
    one = 1 / (a * d - b * c)
    return d * one, -b * one, -c * one, a * one


def _norm(A: Matrix) -> arb:
    """Maximum norm, rounded up."""
    a, b, c, d = (entry.abs_upper() for entry in A)
    return (a + b).max(c + d).upper()


def _within(bound: arb) -> Matrix:
    """Rectangles that hold the entries of every 2 x 2 matrix of that maximum norm."""
    ball = acb(arb(0, bound), arb(0, bound))
    return ball, ball, ball, ball
