"""Response of a layered half-space to surface tractions, wavenumber by wavenumber.

State vectors and surface impedances: in each layer the equations of elasticity are dy/dz = k N y, whose
propagator is known in closed form; the impedance of everything below is propagated up through the layers.
Nothing is shared with the Airy functions or Papkovich potentials of the methods under verification.

Frame of the wave vector: L along k, T across it, e^{ikL} understood, real amplitudes from

    u_L = i U,  u_z = w,  s_Lz = i T,  s_zz = S;    u_T = V,  s_Tz = t,  s_LT = i k G V
    U' = T/G - k w,            w' = [nu k U + (1-2nu) S/(2G)]/(1-nu),
    T' = -k s_LL,              S' = k T,          s_LL = [nu S - 2G k U]/(1-nu),   s_TT = nu (s_LL + S)

Kausel and Roesset, Bull. Seism. Soc. Am. 71 (1981) 1743-1761, for waves; derived for statics here.
"""

from dataclasses import dataclass

import numpy as np

from verification.problem.array_types import Array, Coatings

# Beyond this k h a layer is a half-space to better than rounding (exp(-80) is left of its lower side), while
# the propagator's condition number grows like (k h)^2.
THICK = 40.0


@dataclass(frozen=True, eq=False)
class Amplitudes:
    """Real amplitudes at one depth: displacements in m, stresses in Pa, per unit traction, shape of k.

    In-plane load (T, S on the surface) leaves V, t, lt zero, anti-plane load leaves the rest zero.
    """

    U: Array
    w: Array
    T: Array
    S: Array
    ll: Array
    tt: Array
    V: Array
    t: Array
    lt: Array


def contact_modulus(coatings: Coatings, substrate: tuple[float, float]) -> float:
    """E1* = E1/(1 - nu1^2) [Pa] of the material at the surface."""
    E, nu = coatings[0][:2] if coatings else substrate
    return E / (1 - nu**2)


def bending_length(coatings: Coatings, substrate: tuple[float, float]) -> float:
    """Length over which coatings bend like a plate on their base, h (E1/E2)^(1/3), at least h [m]."""
    stiffest = max(E for E, _, _ in coatings)
    return sum(h for _, _, h in coatings) * max(1.0, stiffest / substrate[0]) ** (1 / 3)


class LayeredHalfSpace:
    """Bonded ``coatings`` ((E, nu, thickness), ...) on ``substrate`` (E, nu), solved at wavenumbers ``k``."""

    def __init__(self, coatings: Coatings, substrate: tuple[float, float], k: Array) -> None:
        self.k = k
        self.E = np.array([c[0] for c in coatings] + [substrate[0]])
        self.nu = np.array([c[1] for c in coatings] + [substrate[1]])
        self.G = self.E / (2 * (1 + self.nu))
        self.thickness = np.array([c[2] for c in coatings])
        self.top = np.concatenate([[0.0], np.cumsum(self.thickness)])
        # Moduli are divided by the top layer's, so that impedances are of order one.
        self.g = self.G / self.G[0]
        self._impedances()

    @property
    def compliance(self) -> Array:
        """M(k) with u_z = (1 - nu1)/(G1 k) M p; M -> 1 for short waves, E1*/E2* for long ones."""
        u = np.linalg.solve(self.Z[0], np.array([0.0, -1.0])[None, :, None])
        return u[:, 1, 0] / (2 * (1 - self.nu[0]))

    def amplitudes(self, z: float, layer: int, load: str) -> Amplitudes:
        """Amplitudes at depth ``z`` [m] of ``layer`` under one unit of ``load``.

        load : "normal" (p = 1, S = -1), "shear" (T = 1) or "antiplane" (t = 1) at z = 0.
        """
        if load == "antiplane":
            return self._antiplane(z, layer)
        traction = np.array([0.0, -1.0] if load == "normal" else [1.0, 0.0])
        u = np.linalg.solve(self.Z[0], traction[None, :, None])
        for i in range(layer):
            u = self.down[i] @ u
        k, g, nu = self.k, self.g[layer], self.nu[layer]
        U0, T0 = _decaying(g, nu)
        c = _decay(k * (z - self.top[layer])) @ np.linalg.solve(U0, u)
        y = np.concatenate([U0 @ c, T0 @ c], axis=1)
        if layer < len(self.thickness):
            thin = k * self.thickness[layer] <= THICK
            rise = k[thin] * (self.top[layer + 1] - z)
            bottom = (self.down[layer] @ u)[thin]
            bottom = np.concatenate([bottom, self.Z[layer + 1][thin] @ bottom], axis=1)
            y[thin] = np.exp(rise)[:, None, None] * (_propagator(-rise, g, nu) @ bottom)
        U, w, T, S = y[:, :, 0].T
        ll = -g * U / (1 - nu) + nu / (1 - nu) * S
        tt = nu * (ll + S)
        zero = np.zeros_like(k)
        scale = 2 * self.G[0] * k
        return Amplitudes(U / scale, w / scale, T, S, ll, tt, zero, zero, zero)

    def _antiplane(self, z: float, layer: int) -> Amplitudes:
        k, zero = self.k, np.zeros_like(self.k)
        v = 1 / self.Za[0]
        for i in range(layer):
            v = self.down_a[i] * v
        g = self.g[layer]
        if layer == len(self.thickness):
            v = v * np.exp(-k * (z - self.top[layer]))
            t = -g * v
        else:
            rise, depth = k * (self.top[layer + 1] - z), k * (z - self.top[layer])
            bottom = v / self._rise_a(layer, k * self.thickness[layer])
            # cosh and sinh of ``rise`` times exp(-k thickness), so that nothing overflows.
            up, down = np.exp(-depth), np.exp(-depth - 2 * rise)
            ch, sh = 0.5 * (up + down), 0.5 * (up - down)
            below = self.Za[layer + 1]
            v, t = bottom * (ch - below * sh / g), bottom * (below * ch - g * sh)
        return Amplitudes(zero, zero, zero, zero, zero, zero, v / (self.G[0] * k), t, g * v)

    def _rise_a(self, layer: int, x: Array) -> Array:
        """Displacement ratio top/bottom of a layer in anti-plane shear, times exp(-x)."""
        return 0.5 * ((1 + np.exp(-2 * x)) - self.Za[layer + 1] * (1 - np.exp(-2 * x)) / self.g[layer])

    def _impedances(self) -> None:
        n = len(self.thickness)
        U0, T0 = _decaying(self.g[n], self.nu[n])
        Z, Za, down, down_a = ([np.empty(0)] * (n + 1) for _ in range(4))
        Z[n] = np.broadcast_to(T0 @ np.linalg.inv(U0), (self.k.size, 2, 2))
        Za[n] = np.full(self.k.shape, -self.g[n])
        self.Za = Za
        for i in reversed(range(n)):
            x = self.k * self.thickness[i]
            U0, T0 = _decaying(self.g[i], self.nu[i])
            Z[i] = np.tile(T0 @ np.linalg.inv(U0), (x.size, 1, 1))
            down[i] = U0 @ _decay(x) @ np.linalg.inv(U0)
            thin = x <= THICK
            P = _propagator(-x[thin], self.g[i], self.nu[i])
            u = P[:, :2, :2] + P[:, :2, 2:] @ Z[i + 1][thin]
            inverse = np.linalg.inv(u)
            Z[i][thin] = (P[:, 2:, :2] + P[:, 2:, 2:] @ Z[i + 1][thin]) @ inverse
            down[i][thin] = inverse * np.exp(-x[thin])[:, None, None]
            rise = self._rise_a(i, x)
            sh, ch = 0.5 * (1 - np.exp(-2 * x)), 0.5 * (1 + np.exp(-2 * x))
            Za[i] = (Za[i + 1] * ch - self.g[i] * sh) / rise
            down_a[i] = np.exp(-x) / rise
        self.Z, self.down, self.down_a = Z, down, down_a


def _in_plane(g: float, nu: float) -> Array:
    """N of dy/dz = k N y for y = (2 G1 k U, 2 G1 k w, T, S), with g = G/G1."""
    c = 1 / (1 - nu)
    return np.array(
        [[0, -1, 2 / g, 0], [nu * c, 0, 0, (1 - 2 * nu) * c / g], [g * c, 0, 0, -nu * c], [0, 0, 1, 0]]
    )


def _decay(x: Array) -> Array:
    """Change of the two decaying solutions' coefficients over a depth x/k: exp(-x) [[1, x], [0, 1]]."""
    decay = np.exp(-x)
    return np.stack([np.stack([decay, x * decay], -1), np.stack([0 * x, decay], -1)], -2)


def _propagator(x: Array, g: float, nu: float) -> Array:
    """exp(-|x|) exp(N x), shape x.shape + (4, 4); (N^2 - 1)^2 = 0 leaves four terms.

    exp(N x) = cosh x + N sinh x + (N^2-1) (x sinh x)/2 + N (N^2-1) (x cosh x - sinh x)/2
    """
    N = _in_plane(g, nu)
    Q = N @ N - np.eye(4)
    m = np.abs(x)
    decay = np.exp(-2 * m)
    ch, sh = 0.5 * (1 + decay), 0.5 * np.sign(x) * (-np.expm1(-2 * m))
    # x cosh x - sinh x cancels for small x, where its series x^3/3 + x^5/30 + ... is exact.
    series = x**3 / 3 * (1 + x**2 / 10 * (1 + x**2 / 28 * (1 + x**2 / 54 * (1 + x**2 / 88))))
    odd = np.where(m < 0.5, series * np.exp(-m), x * ch - sh)
    terms = ((ch, np.eye(4)), (sh, N), (0.5 * x * sh, Q), (0.5 * odd, N @ Q))
    return sum(coefficient[..., None, None] * matrix for coefficient, matrix in terms)  # type: ignore[return-value]


def _decaying(g: float, nu: float) -> tuple[Array, Array]:
    """Displacements (2 G1 k U, 2 G1 k w) and tractions (T, S) of the two decaying solutions, as columns.

    The second column is that of z psi with psi = e^{-kz}/k; at depth x/k it gains x times the first.
    """
    U0 = np.array([[1.0, 0.0], [-1.0, -(3 - 4 * nu)]]) / g
    T0 = np.array([[-1.0, -(1 - 2 * nu)], [1.0, 2 * (1 - nu)]])
    return U0, T0
