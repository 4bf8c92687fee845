"""Fields in the layered half-space under an edge profile, without patches.

With phi of `abel` the Hankel transform of the pressure is phat(k) = int_0^a phi cos(kt) dt, and every field
is a sum of integrals int F(k) phat(k) J_m(kr) k dk over the responses F to unit traction.

The homogeneous half-space of the first material has F = (c + c' k z) e^{-kz}. With zeta = z - it,
R = sqrt(r^2 + zeta^2), s = R + zeta, int_0^inf e^{-k zeta} J_m(kr) dk = (r/s)^m / R (Watson 1944, 13.2) and

    A_m = int phat J_m e^{-kz} k dk     = -Re int phi'(t) (r/s)^m d(ln s)
    B_m = z int phat J_m e^{-kz} k^2 dk =  z phi'(a) Re[(r/s_a)^m / R_a] + z Im int phi''(t) (r/s)^m d(ln s)
    C_m = int phat J_m e^{-kz} dk       = -Im int phi(t) (r/s)^m d(ln s),      t = i (s - r^2/s - 2z) / 2,

from any point of the imaginary axis of t to t = a, because dt / R = i d(ln s). In ln s the integrands are
entire, at the contact edge as well: Gauss points along three straight lines, joined where t is real, serve
every point z >= 0; one joint is t = r, since far from the real axis a polynomial of high degree would cancel.

The rest of the response decays like exp(-k L), L = 2 h - z in the first coating, and so does the whole
response in a deeper layer, L = z: Gauss panels in k. Sneddon, Fourier Transforms (1951), chapter 10.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.special import j0, j1

from semianalytic import abel, frf, point_force
from semianalytic.edge_profile import Profile
from semianalytic.inputs import Body

__all__ = ["displacement", "stress"]

Array = NDArray[Any]
Response = Callable[[frf.Load], Array]
Columns = list[tuple[Array, int]]

BLOCK = 300_000  # points times nodes held at a time
TAIL = 28.0  # exponent at which the layers' response is cut


def stress(profiles: Sequence[Profile], body: Body, x: Array, y: Array, z: Array, layer: Array) -> Array:
    """Stress under each profile with traction q = f p in +x at points (x, y, z) [m] of the layers named.

    x, y, z, layer : (n,).
    Returns xx, yy, zz, xy, xz, yz [Pa], (len(profiles), 6, n).
    """
    friction = body.friction

    def columns(response: Response) -> Columns:
        return point_force.stress_columns(response, friction)

    def homogeneous(load: frf.Load) -> Array:
        return frf.homogeneous_stress(body.materials[0][1], load)

    def rest(k: Array, depth: Array, number: int, load: frf.Load) -> Array:
        return k * frf.stress_frf(k, depth, number, **body.layers, load=load, excess=number == 0)

    radial = _radial(profiles, body, x, y, z, layer, columns, homogeneous, rest, 1)
    return np.array([point_force.combine_stress(one, *_direction(x, y), friction) for one in radial])


def displacement(
    profiles: Sequence[Profile], body: Body, x: Array, y: Array, z: Array, layer: Array
) -> Array:
    """Displacement u_x, u_y, u_z [m], (len(profiles), 3, n); arguments as in `stress`."""
    friction = body.friction
    E, nu = body.materials[0][:2]

    def columns(response: Response) -> Columns:
        return point_force.displacement_columns(response, friction)

    def homogeneous(load: frf.Load) -> Array:
        return frf.homogeneous_displacement(E, nu, load)

    def rest(k: Array, depth: Array, number: int, load: frf.Load) -> Array:
        return frf.displacement_frf(k, depth, number, **body.layers, load=load, excess=number == 0)

    radial = _radial(profiles, body, x, y, z, layer, columns, homogeneous, rest, 0)
    return np.array([point_force.combine_displacement(one, *_direction(x, y), friction) for one in radial])


def _direction(x: Array, y: Array) -> tuple[Array, Array]:
    r = np.maximum(np.hypot(x, y), np.finfo(float).tiny)
    return x / r, y / r


def _radial(profiles, body, x, y, z, layer, columns, homogeneous, rest, power: int) -> Array:
    """Radial functions of `point_force` under each profile, (len(profiles), columns, n).

    homogeneous(load) : c, c' of every field, (..., 2).  rest(k, z, layer, load) : k^power F of the layers.
    power : of k besides phat.
    """
    r = np.hypot(x, y)
    orders = [order for _, order in columns(homogeneous)]
    total = np.zeros((len(profiles), len(orders), r.size))
    first = np.flatnonzero(layer == 0)
    if first.size:
        points, where = np.unique(np.stack([r[first], z[first]]), axis=1, return_inverse=True)
        for out, profile in zip(total, profiles, strict=True):
            plain, linear = half_space_integrals(profile, points[0], points[1], power)
            for row, (c, order) in zip(out, columns(homogeneous), strict=True):
                row[first] = (c[0] * plain[order] + c[1] * linear[order])[where.ravel()]
    if body.coatings:
        for number, decay, at in _groups(body, z, layer):
            reach = profiles[0].radius + float(r[at].max())
            k, weight = abel.wavenumbers(reach, TAIL / decay, 6 / decay)
            phat = weight * np.array([_transform(profile, k) for profile in profiles])
            _add_layers(total, columns, rest, k, phat, r, z, at, number)
    return total


def half_space_integrals(profile: Profile, r: Array, z: Array, power: int) -> tuple[Array, Array]:
    """A_m and B_m [Pa] for m = 0..3 (power 1), or C_m and z A_m [Pa m] (power 0), each (4, n)."""
    a = profile.radius
    f = legendre.legmul([0.5, 0.5], abel.potential(profile.coefficients))  # phi / a of 1 - 2 (t/a)^2
    f1, f2 = legendre.legder(f), legendre.legder(f, 2)
    # |s| at which a path starts that would otherwise start nearer to the origin; |f| is of order 1 there
    nearest = min(0.25, 2 / f.size)
    nodes, weights = abel.gauss_legendre(int(14 + 1.4 * f.size))
    nodes, weights = (1 + nodes) / 2, weights / 2
    plain, linear = np.empty((4, r.size)), np.empty((4, r.size))
    step = max(1, BLOCK // (3 * nodes.size))
    for begin in range(0, r.size, step):
        part = slice(begin, begin + step)
        radius, depth = r[part] / a, z[part] / a
        R_a = _root(radius, depth)
        start = np.log(np.maximum(np.hypot(radius, depth) + depth, nearest))
        first = np.where(radius < 1, np.maximum(radius, nearest / 2), 1 / 3)
        joints = [start]
        for real in (first, np.where(radius < 1, np.maximum(radius, 0.25), 2 / 3), np.ones(radius.size)):
            joints.append(np.log(real * (_root(radius / real, depth / real) - 1j) + depth))
        end = joints[-1]
        legs = np.diff(joints, axis=0).T[:, :, None]
        s = np.transpose(joints[:-1])[:, :, None] + legs * nodes
        s, measure = np.exp(s.reshape(radius.size, -1)), (legs * weights).reshape(radius.size, -1)
        t = 0.5j * (s - radius[:, None] ** 2 / s - 2 * depth[:, None])
        tau = radius[:, None] / s
        y = 1 - 2 * t**2
        first_derivative = legendre.legval(y, f1)
        slope = -4 * t * first_derivative * measure
        if power:
            other = (16 * t**2 * legendre.legval(y, f2) - 4 * first_derivative) * measure
            z_over_R = np.where(R_a == 0, 0.0, depth / np.where(R_a == 0, 1.0, R_a))
            at_edge = -4 * legendre.legval(-1.0, f1)
        else:
            other = legendre.legval(y, f) * measure
        for m in range(4):
            A = -slope.sum(axis=1).real
            if power:
                jump = at_edge * ((radius / np.exp(end)) ** m * z_over_R).real
                plain[m, part], linear[m, part] = A, jump + depth * other.sum(axis=1).imag
            else:
                plain[m, part], linear[m, part] = -a * other.sum(axis=1).imag, a * depth * A
            slope, other = slope * tau, other * tau
    return plain, linear


def _root(r: Array, z: Array) -> Array:
    """R = sqrt(r^2 + (z - i)^2), Re R >= 0 >= Im R; lengths over a.

    The larger part comes first, without a difference; the product of the two is z.
    """
    d = (r - 1) * (r + 1) + z**2
    larger = np.sqrt((np.hypot(d, 2 * z) + np.abs(d)) / 2)
    smaller = z / np.where(larger == 0, 1.0, larger)
    return np.where(d >= 0, larger - 1j * smaller, smaller - 1j * larger)


def _groups(body: Body, z: Array, layer: Array) -> Iterator[tuple[int, float, Array]]:
    """Layer, length of decay [m] rounded down to a power of 2, and indices of the points that share them."""
    decay = np.where(layer == 0, 2 * body.thickness[0] - z, z)
    octave = np.floor(np.log2(decay) + 1e-9).astype(int)
    for number, power in np.unique(np.stack([layer, octave]), axis=1).T:
        yield int(number), 2.0**power, np.flatnonzero((layer == number) & (octave == power))


def _transform(profile: Profile, k: Array) -> Array:
    """phat(k) [N]."""
    return profile.radius**2 * abel.cosine_transform(abel.potential(profile.coefficients), k * profile.radius)


def _add_layers(total, columns, rest, k, phat, r, z, at, number: int) -> None:
    """Add sum_k phat F J_m(kr) to the radial functions of points ``at``, depth by depth."""
    depths, which = np.unique(z[at], return_inverse=True)
    few = max(1, BLOCK // (4 * k.size))
    for begin in range(0, depths.size, few):
        some = depths[begin : begin + few]
        table = columns(lambda load, some=some: rest(k, some, number, load))
        for i in range(some.size):
            here = at[which == begin + i]
            radii, inverse = np.unique(r[here], return_inverse=True)
            for first in range(0, radii.size, few):
                J = _bessel(np.outer(radii[first : first + few], k), max(order for _, order in table))
                chosen = (inverse >= first) & (inverse < first + few)
                for column, (F, order) in enumerate(table):
                    value = (phat * F[i]) @ J[order].T
                    total[:, column, here[chosen]] += value[:, inverse[chosen] - first]


def _bessel(x: Array, highest: int) -> list[Array]:
    """J_0 .. J_highest; upward recurrence loses digits below 2, where the power series serves."""
    J = [j0(x), j1(x)]
    small = x < 2
    square = (x[small] / 2) ** 2
    safe = np.where(small, 2.0, x)
    for m in range(2, highest + 1):
        higher = 2 * (m - 1) / safe * J[-1] - J[-2]
        series = np.ones_like(square)
        for j in range(12, 0, -1):
            series = 1 - series * square / (j * (j + m))
        higher[small] = series * (x[small] / 2) ** m / (2 if m == 2 else 6)
        J.append(higher)
    return J
