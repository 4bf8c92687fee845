"""Integrals over the wavenumber with proven bounds of their errors.

kappa = k a. An integrand A(kappa) w(kappa), A of the layers, |w| <= |kappa|^p cosh(Im kappa)^2 for a power p,
is integrated by Gauss panels of n nodes up to an end, beyond which a tail is bounded. On a panel of half
width H, with F analytic in the ellipse of semi-axes H (rho +- 1/rho)/2 about its middle,

    |int F - sum w_j F_j| <= 8 H rho^(1 - 2n) / (rho - 1) max |F|                                     (Q1)

The rule is exact for polynomials of degree 2n - 1; its weights add up to 2H. The error is therefore at most
4H times that of the Chebyshev sum of this degree, 2 rho^(1 - 2n)/(rho - 1) max |F|: Trefethen, Approximation
Theory and Approximation Practice (2013), theorem 8.2. A is bounded in rectangles that cover the ellipse; a
finite value on each also proves that A is analytic there.

    tail:  C (1 + x)^2 e^{-2x}, D (1 + x) e^{-x} of ``LayeredSolid.tail``, x = kappa h/a, beyond X
    int_X^inf (1 + x)^q x^p e^{-qx} dx <= (1 + X)^q X^p e^{-qX} / (q - (q + p)/X),   q = 1, 2         (Q2)

since the integrand's logarithmic derivative is at most (q + p)/X - q there.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

from flint import acb, arb, ctx

from enclosures_made.enclosed_response import LayeredSolid

NODES = 40
POWERS = (0, 1, 2)
ROUGH = 64  # bits, for bounds
MOST = 400  # rectangles on an ellipse
SMALL = arb(2) ** -66  # errors that are sought, of a panel and of the tail


@dataclass(frozen=True, repr=False)
class Panels:
    """Nodes ``kappa`` with their weights, and bounds of what a sum over them leaves out.

    error[i][p] : bound of |int_0^inf A w - sum|, of the i-th of ``Amplitudes`` with the power p.
    size[i][p] : bound of int_0^inf |A| kappa^p.   least : lower bound of M on (0, inf).
    """

    kappa: list[arb]
    weight: list[arb]
    error: list[list[arb]]
    size: list[list[arb]]
    least: arb


def panels(solid: LayeredSolid, a: arb) -> Panels:
    """Panels that hold for every contact radius in the ball ``a`` [m].

    Raises ValueError where no panel or no end can be bounded.
    """
    bits, ctx.prec = ctx.prec, ROUGH
    try:
        end, tails = _end(solid, a)
        edges, errors, sizes, least = [arb(0)], _zeros(), _zeros(), arb(1)
        width = end / 2**10
        while edges[-1] < end:
            start = edges[-1]
            stop = (start + width).mid()
            if stop > end:
                stop = end
            found = _panel(solid, a, start, stop)
            if found is None:
                width = width / 2
                if width < end / 2**18:
                    raise ValueError(f"no panel from kappa = {float(start):g} could be bounded")
                continue
            factor, most, reach = found
            on_axis, smallest = _on_axis(solid, a, start, stop)
            for i, largest in enumerate(most):
                for p in POWERS:
                    errors[i][p] += factor * largest * reach**p
                    sizes[i][p] += on_axis[i][p]
            least = _smaller(least, smallest)
            edges.append(stop)
            width = (stop - start) * 2
        at_end = 1 - _bound(solid.tail((end / a).lower())[0], 2, 0, (end * solid.thickness[0] / a).lower())
        least = _smaller(least, at_end)
        for i in range(4):
            for p in POWERS:
                errors[i][p] += tails[i][p]
                sizes[i][p] += tails[i][p]
    finally:
        ctx.prec = bits
    nodes, weights = [], []
    for left, right in pairwise(edges):
        middle, half = (left + right) / 2, (right - left) / 2
        for x, w in _gauss():
            nodes.append(middle + half * x)
            weights.append(half * w)
    return Panels(nodes, weights, errors, sizes, least)


_rule: dict[int, list[tuple[arb, arb]]] = {}


def _gauss() -> list[tuple[arb, arb]]:
    if ctx.prec not in _rule:
        _rule[ctx.prec] = [arb.legendre_p_root(NODES, j, weight=True) for j in range(NODES)]
    return _rule[ctx.prec]


def of_bounded(values: Callable[[arb], arb], end: arb, bound: Callable[[arb], arb]) -> arb:
    """int_0^end by one Gauss rule; |F| <= bound(b) where |Im| <= b, of an entire function F."""
    half = end / 2
    total = sum((half * w * values(half + half * x) for x, w in _gauss()), arb(0))
    rho = arb(5)
    error = 8 * half * rho ** (1 - 2 * NODES) / (rho - 1) * bound(half * (rho - 1 / rho) / 2)
    return total + arb(0, error.upper())


def _zeros() -> list[list[arb]]:
    return [[arb(0) for _ in POWERS] for _ in range(4)]


def _smaller(one: arb, other: arb) -> arb:
    return one.lower().min(other.lower())


def _bound(C: arb, q: int, p: int, X: arb) -> arb:
    """C (1 + X)^q X^p e^{-qX}."""
    return C * (1 + X) ** q * X**p * (-q * X).exp()


def _end(solid: LayeredSolid, a: arb) -> tuple[arb, list[list[arb]]]:
    """Wavenumber beyond which all tails are small, with their bounds by (Q2)."""
    h = solid.thickness[0]
    for x in range(32, 400, 4):
        end = (x * a / h).mid()
        X = (end * h / a).lower()
        C, D = solid.tail((end / a).lower())
        tails = _zeros()
        for i, (bound, q) in enumerate(((C, 2), (C, 2), (D, 1), (D, 1))):
            for p in POWERS:
                tails[i][p] = (_bound(bound, q, p, X) / (q - (q + p) / X) * (a / h) ** (p + 1)).upper()
        if all(tail < SMALL for row in tails for tail in row):
            return end, tails
    raise ValueError("the response does not decay: its tail could not be bounded")


def _panel(solid: LayeredSolid, a: arb, start: arb, stop: arb) -> tuple[arb, list[arb], arb] | None:
    """(Q1) with cosh^2 over max |A|, max |A|, max |kappa|; None where no ellipse is admissible."""
    middle, half = (start + stop) / 2, (stop - start) / 2
    tried = []
    for rho in (arb(6), arb(4.5), arb(3.5), arb(2.75), arb(2.25), arb(1.875), arb(1.625)):
        width, b = half * (rho + 1 / rho) / 2, half * (rho - 1 / rho) / 2
        factor = 8 * half * rho ** (1 - 2 * NODES) / (rho - 1) * b.cosh() ** 2
        reach = middle + width  # the largest |kappa| on the ellipse
        admissible = SMALL / (factor * (1 + reach) ** 2)
        tried.append((float(factor.log().upper()), factor, admissible, width, b, reach))
    for _, factor, admissible, width, b, reach in sorted(tried, key=lambda entry: entry[0]):
        if not admissible > 1:
            return None
        most = _largest(solid, a, middle, width, b, admissible)
        if most is not None:
            return factor.upper(), most, reach.upper()
    return None


def _largest(
    solid: LayeredSolid, a: arb, middle: arb, width: arb, b: arb, admissible: arb
) -> list[arb] | None:
    """Bounds of the amplitudes on the rectangle middle +- width, 0 to b; None where they are not admissible.

    The values at conjugate points are conjugate, so that the upper half is enough.
    """
    most = [arb(0)] * 4
    left = [(middle, b / 2, width, b / 2)]
    for _ in range(MOST):
        x, y, rx, ry = left.pop()
        found = [value.abs_upper() for value in solid.amplitudes(acb(_ball(x, rx), _ball(y, ry)) / a)]
        if all(value < admissible for value in found):
            most = [largest.max(value).upper() for largest, value in zip(most, found, strict=True)]
            if not left:
                return most
        elif rx > ry:
            left += [(x - rx / 2, y, rx / 2, ry), (x + rx / 2, y, rx / 2, ry)]
        else:
            left += [(x, y - ry / 2, rx, ry / 2), (x, y + ry / 2, rx, ry / 2)]
    return None


def _ball(middle: arb, radius: arb) -> arb:
    return arb(middle.mid(), (radius + middle.rad()).upper())


def _on_axis(solid: LayeredSolid, a: arb, start: arb, stop: arb) -> tuple[list[list[arb]], arb]:
    """Bounds of int |A| kappa^p over an interval, lower bound of M = 1 + excess there; by bisection.

    Raises ValueError where M cannot be shown to be positive.
    """
    sizes, least = _zeros(), arb("inf")
    left = [(start, stop)]
    for _ in range(100 * MOST):
        low, high = left.pop()
        found = solid.amplitudes(acb(_ball((low + high) / 2, (high - low) / 2)) / a)
        M = 1 + found.excess.real
        if M.rad() < 0.2 * abs(M.mid()) and all(value.is_finite() for value in found):
            for i, value in enumerate(found):
                for p in POWERS:
                    sizes[i][p] += (high - low) * value.abs_upper() * high**p
            least = _smaller(least, M)
            if not left:
                return sizes, least
        else:
            left += [(low, (low + high) / 2), ((low + high) / 2, high)]
    raise ValueError("the response could not be shown to be positive")
