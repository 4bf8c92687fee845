"""The Fredholm equation of the contact at a given radius, with a proven bound of the error.

With x = a s, phi = E1* a^2/(pi R) f and m(kappa) = M(kappa/a) - 1,

    f + K f = d - s^2,   K f = (2/pi) int_0^inf m cos(kappa s) F(kappa) dkappa
    F(kappa) = int_0^1 f cos(kappa t) dt

Lebedev and Ufliand, PMM 22 (1958) 320-326. f = d f1 - f2 with f1, f2 of the right sides 1, s^2. In L2(0, 1)
(2/pi) int F^2 = |f|^2 by Plancherel, so that

    <f, f + K f> = (2/pi) int M F^2 >= min M |f|^2
    |f - g| <= |r| / min M,   r = right side - g - K g                                              (E1)

for every g. Here g is a sum of the orthonormal e_n = sqrt(4n + 1) P_2n(s), n < N, by floating point;

    c_n(kappa) = int_0^1 e_n cos(kappa s) ds = (-1)^n sqrt(4n + 1) j_2n(kappa)

With K g by the nodes of ``Panels``, V_j = (2/pi) w_j m_j G(kappa_j), the residual has the parts

    |r| <= |coefficients n < N| + sum_j |V_j| t_j + (2/pi) error |g|                                 (E2)
    t_j^2 = |cos(kappa_j s)|^2 - sum_{n < N} c_n(kappa_j)^2

j_2n by j_{n-1} + j_{n+1} = (2n + 1) j_n / x, DLMF 10.51.1, upwards from sin x / x or downwards from 10.53.1.
"""

from dataclasses import dataclass

import numpy as np
from flint import acb, arb, arb_mat

from enclosures_made.enclosed_integrals import Panels
from enclosures_made.enclosed_response import LayeredSolid

REFINEMENTS = 8


@dataclass(frozen=True, repr=False)
class Waves:
    """Transforms of the basis: c[j, n] at the nodes of ``panels``, tail[j] = t_j of (E2)."""

    panels: Panels
    c: arb_mat
    tail: list[arb]
    approximate: np.ndarray


@dataclass(frozen=True, repr=False)
class Approximation:
    """g for one right side: coefficients, transforms G at the nodes, |g|, bound of |f - g|."""

    y: list[arb]
    transform: list[arb]
    norm: arb
    error: arb


def waves(panels: Panels, terms: int) -> Waves:
    """Transforms of ``terms`` basis functions."""
    rows, tails = [], []
    root = [arb(4 * n + 1).sqrt() * (-1) ** n for n in range(terms)]
    for x in panels.kappa:
        j = _even_bessel(x, terms)
        c = [factor * value for factor, value in zip(root, j, strict=True)]
        rest = (1 + (2 * x).sin() / (2 * x)) / 2 - sum((one * one for one in c), arb(0))
        rows.append(c)
        tails.append(rest.upper().max(arb(0)).sqrt().upper())
    return Waves(panels, arb_mat(rows), tails, np.array([[float(one) for one in row] for row in rows]))


def _even_bessel(x: arb, count: int) -> list[arb]:
    """j_0, j_2, ... j_2(count - 1) of x > 0, upwards beyond all orders, downwards elsewhere."""
    top = 2 * count
    if x > top:
        j = [x.sin() / x, x.sin() / x**2 - x.cos() / x]
        for n in range(1, top):
            j.append((2 * n + 1) / x * j[n] - j[n - 1])
        return j[:top:2]
    above, here = (_by_series(top + i, x) for i in (1, 0))
    found = []
    for n in range(top, 0, -1):
        above, here = here, (2 * n + 1) / x * here - above
        if n % 2:
            found.append(here)
    return found[::-1]


def _by_series(n: int, x: arb) -> arb:
    """j_n(x) = sqrt(pi)/2 (x/2)^n / Gamma(n + 3/2) 0F1(n + 3/2; -x^2/4)."""
    order = arb(2 * n + 3) / 2
    return arb.pi().sqrt() / 2 * (x / 2) ** n / order.gamma() * (-x * x / 4).hypgeom_0f1(order)


@dataclass(frozen=True, repr=False)
class Equation:
    """The equation at the radius ``a`` [m], a point or a ball for which ``waves.panels`` hold.

    response : each of ``Amplitudes`` at the nodes.   solutions : f1, f2.
    """

    a: arb
    waves: Waves
    response: list[list[arb]]
    solutions: tuple[Approximation, Approximation]

    def integral(self, amplitude: int, factor: list[arb], power: int) -> tuple[arb, arb]:
        """int_0^inf A(kappa) w(kappa) F(kappa) dkappa for f1 and f2.

        factor : w at the nodes, with |w| <= |kappa|^power cosh(Im kappa).
        """
        panels = self.waves.panels
        weighted = [
            w * A * v for w, A, v in zip(panels.weight, self.response[amplitude], factor, strict=True)
        ]
        found = []
        for g in self.solutions:
            total = sum((v * G for v, G in zip(weighted, g.transform, strict=True)), arb(0))
            # (Q1) and (Q2) for g; |F - G| <= |f - g| on the real axis
            left_out = panels.error[amplitude][power] * g.norm + panels.size[amplitude][power] * g.error
            found.append(total + arb(0, left_out.upper()))
        return found[0], found[1]


def equation(solid: LayeredSolid, a: arb, waves: Waves) -> Equation:
    """Solve at ``a`` and bound the error by (E1) and (E2)."""
    panels, terms = waves.panels, waves.c.ncols()
    response: list[list[arb]] = [[], [], [], []]
    for kappa in panels.kappa:
        for values, amplitude in zip(response, solid.amplitudes(acb(kappa) / a), strict=True):
            values.append(amplitude.real)
    kernel = [2 / arb.pi() * w * m for w, m in zip(panels.weight, response[0], strict=True)]
    c = waves.approximate
    rough = np.array([float(value) for value in kernel])
    inverse = np.linalg.inv(np.eye(terms) + (c.T * rough) @ c)
    # s^2 = 1/3 + 2/3 P_2
    right = arb_mat(terms, 2)
    right[0, 0], right[0, 1], right[1, 1] = arb(1), arb(1) / 3, arb(2) / 3 / arb(5).sqrt()
    y = arb_mat(terms, 2)
    transposed = waves.c.transpose()
    size = np.inf
    for _ in range(REFINEMENTS):
        G = waves.c * y
        V = arb_mat([[k * G[j, i] for i in range(2)] for j, k in enumerate(kernel)])
        r = right - y - transposed * V
        change = np.array([[float(r[n, i].mid()) for i in range(2)] for n in range(terms)])
        if not np.abs(change).max() < 0.1 * size:
            break
        size, kept = np.abs(change).max(), (y, G, V, r)
        # scaled, so that small residuals keep their digits
        step = inverse @ (change / max(size, 1e-300)) * size
        y = arb_mat([[(y[n, i] + arb(float(step[n, i]))).mid() for i in range(2)] for n in range(terms)])
    y, G, V, r = kept
    solutions = []
    for i in range(2):
        norm = sum((y[n, i] ** 2 for n in range(terms)), arb(0)).sqrt().upper()
        inside = sum((abs(r[n, i]).upper() ** 2 for n in range(terms)), arb(0)).sqrt()
        beyond = sum((abs(V[j, i]).upper() * t for j, t in enumerate(waves.tail)), arb(0))
        residual = inside + beyond + 2 / arb.pi() * panels.error[0][0] * norm
        error = (residual / panels.least).upper()
        coefficients, transform = [y[n, i] for n in range(terms)], [G[j, i] for j in range(len(kernel))]
        solutions.append(Approximation(coefficients, transform, norm, error))
    return Equation(a, waves, response, (solutions[0], solutions[1]))
