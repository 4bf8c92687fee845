"""Contour and pressure under which the gap that finite elements find inside a contact vanishes.

By hand: no package solves a contact by the compliance of one meridian plane.

Unknown are the contour and the coefficients of the pressure, see ``star_contact``, and the approach delta.
The part of the gap  u_z + height - delta  inside that functions

    s^n T_j(2 s^2 - 1) cos(n tau),   n + 2 j <= degree + MORE,

hold is made least in the norm of the weight (1 - s^2)^2.5, which leaves out the edge, where elements are too
stiff; the pressure is to carry the load. The root of a pressure misses the displacement by about h^1.5 on a
width h beside the edge, so that its product with such a condition errs by h^((WEIGHT + 5)/2). Gauss and
Newton's method: the pressure is linear in its coefficients, and moving the edge by c_n cos(n tau) changes it
by  -dp/ds s^(n + 1) cos(n tau) c_n.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fem_reference import element_numbers as chosen
from fem_reference.contact.levels import ElementsNotConverged
from fem_reference.not_round.harmonic_compliance import HarmonicCompliance
from fem_reference.not_round.indenter_height import Height
from fem_reference.not_round.star_contact import Quadrature, StarPressure

# Roache's grid convergence index for two meshes, times the change from the companion: of what the conditions
# give, with their order, (WEIGHT + 5)/2
BY_CONDITIONS = chosen.SAFETY / (chosen.SHAPED_COARSER ** ((chosen.WEIGHT + 5) / 2) - 1)
ADVICE = "; the contact may have a hole or more parts, change the shape or the load"


@dataclass(frozen=True, eq=False)
class Closed:
    """A pressure under which the gap vanishes, its approach, and the compliances of the bodies below it.

    covariance : of coefficients, change of the edge and approach, by what the conditions leave of the gap
    asked : height of the indenter, load and last harmonic that corrects the pressure, as of ``closed``
    """

    compliances: tuple[HarmonicCompliance, ...]
    pressure: StarPressure
    approach: float
    steps: int
    converged: bool
    covariance: np.ndarray
    asked: tuple[Height, float, int]

    @cached_property
    def nodal_loads(self) -> np.ndarray:
        """Products of the pressure with the shape functions, (harmonics, nodes)."""
        one = self.compliances[0]
        parts = [one.on_arcs(at.theta, forces[None], one.last) for at, forces in self._forces]
        r = np.concatenate([at.r for at, _ in self._forces])
        return one.nodal_loads(r, np.concatenate(parts))[..., 0]

    def of_degree(self, degree: int) -> "Closed":
        """The contact by a pressure of another degree."""
        return closed(self.compliances, self.pressure.of_degree(degree), *self.asked)

    def moved(self, other: "Closed") -> float:
        """Relative change of the contact radius to the ``other``, if no part of the edge offset another."""
        p = self.pressure
        x, y = np.array(p.contour_points)
        away = np.hypot(*(np.array(other.pressure.contour_points) - (x, y)))
        area = np.trapezoid(away, np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))]))
        return float(area * (2 if p.centre else 1) / p.area)

    @property
    def residual(self) -> float:
        """Root mean square of the gap left inside, weighted with the pressure, over the approach."""
        gap, weight = np.concatenate(self._gaps), np.abs(np.concatenate([p.ravel() for _, p in self._forces]))
        return float(np.sqrt((weight * gap**2).sum() / weight.sum()) / self.approach)

    @cached_property
    def missed(self) -> float:
        """By what the approach is too small: the mean gap left inside under the pressure of a flat punch.

        By Betti's theorem, with the displacement of the same contact under a flat punch, which is constant
        inside; what the contour misses counts to the second order. The weight 1/sqrt(1 - s^2) is the punch's
        on an ellipse of bare solids (K. L. Johnson, Contact Mechanics, section 3.3).
        """
        punch = [(at.weights / np.sqrt(1 - at.s**2)).ravel() for at, _ in self._forces]
        return float(np.average(np.concatenate(self._gaps), weights=np.concatenate(punch)))

    @property
    def errors(self) -> np.ndarray:
        """Relative standard errors of contact radius, approach, pressure at the centre and extents."""
        p, zero = self.pressure, np.zeros(1)
        n, k = len(p.coefficients), len(p.coefficients) + len(p.waves)
        rows = np.zeros((5, k + 1))
        rows[0, n], rows[1, k] = 1.0, 1 / self.approach
        centre = p.polynomials(zero, zero, p.degree)[:, 0]
        rows[2, :n] = centre / (centre @ p.coefficients)
        rows[3, n:k], rows[4, n:k] = 1.0, np.cos(np.pi / 2 * np.array(p.waves))
        return np.asarray(np.sqrt(np.maximum(np.einsum("ri,ij,rj->r", rows, self.covariance, rows), 0.0)))

    def check_rest(self, name: str) -> None:
        """Raises ElementsNotConverged unless the contour came to rest."""
        if not self.converged:
            raise ElementsNotConverged(
                f"the contour under the {name} is not at rest after {self.steps} steps{ADVICE}"
            )

    def check(self, name: str) -> None:
        """Raises ElementsNotConverged unless the contour rests, with p >= 0 inside and a gap >= 0 outside."""
        self.check_rest(name)
        p = self.pressure
        w, tau = np.meshgrid(np.linspace(0.05, 0.99, 20), np.linspace(0, np.pi, 37))
        x, y = p.points(w, tau)
        inside = p(x, y)
        if inside.min() < -chosen.ALLOWED * inside.max():
            at = np.unravel_index(int(inside.argmin()), inside.shape)
            raise ElementsNotConverged(
                f"the pressure under the {name} is negative, {inside[at] / inside.max():.2g} of its largest, "
                f"at x = {x[at]:.3g}, y = {y[at]:.3g} of the contact's extent{ADVICE}"
            )
        nodes = self.compliances[0].vertices
        x, y = (v.ravel() for v in p.points(*np.meshgrid([1.02, 1.1, 1.3, 1.7], np.linspace(0, np.pi, 37))))
        r, theta = np.hypot(x, y), np.arctan2(y, x)
        near = (r > nodes[0]) & (r < nodes[-1]) & (x * (p.centre > 0) >= 0)
        gap = self._gap(r[near], theta[near, None])
        if gap.size and gap.min() < -chosen.ALLOWED * self.approach:
            raise ElementsNotConverged(
                f"the {name} penetrates by {-gap.min() / self.approach:.2g} of the approach outside the "
                f"contact{ADVICE}"
            )

    def _gap(self, r: np.ndarray, theta: np.ndarray) -> np.ndarray:
        """Gap on arcs of radius r (arcs,) at theta (arcs, points)."""
        u = self.compliances[0].deflection(self._deflections, r, theta) - self.approach
        return np.asarray(u + self.asked[0](r[:, None] * np.cos(theta), r[:, None] * np.sin(theta)))

    @cached_property
    def _gaps(self) -> list[np.ndarray]:
        """Gap inside at the points of ``_forces``, flat."""
        return [self._gap(at.r, at.theta).ravel() for at, _ in self._forces]

    @cached_property
    def _deflections(self) -> np.ndarray:
        """Amplitudes of u_z of all bodies, (nodes, harmonics)."""
        return np.asarray(sum(one.deflections(self.nodal_loads) for one in self.compliances))

    @cached_property
    def _forces(self) -> list[tuple[Quadrature, np.ndarray]]:
        """Points of quadrature and the pressure there times their weights, (arcs, points)."""
        one = self.compliances[0]
        batches = self.pressure.quadrature(one.vertices, one.last, one.fold)
        return [(at, at.weights * self.pressure(at.x, at.y)) for at in batches]


def closed(
    compliances: tuple[HarmonicCompliance, ...],
    pressure: StarPressure,
    height: Height,
    load: float,
    last: int,
    enough: float = chosen.EDGE_SIZE,
) -> Closed:
    """Contour and pressure whose gap below an indenter of ``height`` (x, y) vanishes; scaled units.

    last : harmonic at which the compliance is cut off, since the conditions are smooth
    """
    one = compliances[0]
    matrices = sum(body.matrices(last) for body in compliances)
    delta, size = 0.0, np.inf
    for step in range(1, chosen.MOST_STEPS + 1):
        steps = step
        batches, n = pressure.quadrature(one.vertices, last, one.fold), len(pressure.coefficients)
        k = n + len(pressure.waves)
        norm, total, raised, on_arcs = *np.zeros((3, 1)), []
        for at in batches:
            tests, forces = _forces(pressure, at)
            flat = forces.reshape(len(forces), -1)
            norm = norm + flat[k:] @ tests.reshape(len(tests), -1).T
            total = total + flat.sum(axis=1)
            raised = raised + flat[k:] @ height(at.x, at.y).ravel()
            on_arcs.append(one.on_arcs(at.theta, forces, last))
        # orthonormal with the weight root^5: the squares of the products then add up to the gap's norm
        orthonormal = np.linalg.inv(np.linalg.cholesky(norm))
        L = one.nodal_loads(np.concatenate([at.r for at in batches]), np.concatenate(on_arcs))
        work = np.einsum("mit,mic->tc", L[:, :, k:], matrices @ L[:, :, :k], optimize=True)
        A = np.zeros((len(norm) + 1, k + 1))
        A[:-1, :k], A[:-1, k], A[-1, :k] = orthonormal @ work, -orthonormal @ total[k:], total[:k]
        b = np.append(-orthonormal @ raised, load)
        # the load counts so much that it is kept
        heavy = chosen.FIRM * np.abs(A[:-1, k]).max() / np.abs(A[-1]).max()
        A[-1], b[-1] = heavy * A[-1], heavy * b[-1]
        columns = np.abs(A).max(axis=0)
        x = np.linalg.lstsq(A / columns, b, rcond=1e-12)[0] / columns
        covariance = np.linalg.pinv(A.T @ A) * float(np.sum((A @ x - b) ** 2)) / (len(A) - len(x))
        size, delta = float(np.abs(x[n:k]).max()), float(x[k])
        share = min(1.0, chosen.LARGEST_MOVE / size)
        pressure = pressure.moved(share * x[n:k], share * x[:n] + (1 - share) * pressure.coefficients)
        leaves_mesh = pressure.reach[1] > one.vertices[-1] or pressure.reach[0] < one.vertices[0]
        if size < enough or leaves_mesh:
            break
    rests = size < chosen.EDGE_CLOSE
    return Closed(compliances, pressure, delta, steps, rests, covariance, (height, load, last))


@dataclass(frozen=True, eq=False)
class OnTwoMeshes:
    """A contact by a pressure of one degree, on the mesh and on its coarser ``companion``."""

    found: Closed
    companion: Closed

    def uncertain(self, lower: "OnTwoMeshes") -> float:
        """Uncertainty of the edge over the contact radius, by the mesh and by a ``lower`` degree."""
        by_degree = chosen.OF_FIELDS * self.found.moved(lower.found)
        return BY_CONDITIONS * self.found.moved(self.companion) + by_degree

    def by(self, more: int) -> "OnTwoMeshes":
        """The contact by a degree that is ``more``."""
        degree = self.found.pressure.degree + more
        return OnTwoMeshes(self.found.of_degree(degree), self.companion.of_degree(degree))


def as_rich_as_helps(poorest: OnTwoMeshes, most: int) -> tuple[OnTwoMeshes, list[OnTwoMeshes]]:
    """The contact by that degree of the pressure whose edge is least uncertain; by the next lower degree and
    those tried beyond.

    What elements miss at the edge cannot be closed, and a pressure of too many terms follows it: degrees from
    that of the ``poorest`` to ``most`` are tried until ``WORSE`` in turn are worse than the best. Its change
    from the lower one is the least of all, maybe by chance: those from the others tell that.
    """
    tried = [poorest.by(-2), poorest]
    best, uncertain = 1, tried[1].uncertain(tried[0])
    while tried[-1].found.pressure.degree + 2 <= most and len(tried) - 1 - best < chosen.WORSE:
        more = tried[-1].by(2)
        if not (more.found.converged and more.companion.converged):
            break
        tried.append(more)
        less = more.uncertain(tried[-2])
        if less < uncertain:
            best, uncertain = len(tried) - 1, less
    return tried[best], [tried[best - 1], *tried[best + 1 :]]


def _forces(pressure: StarPressure, at: Quadrature) -> tuple[np.ndarray, np.ndarray]:
    """Conditions at the points; and what is integrated, times the weights of that.

    This is: terms of the pressure, its changes as the edge moves, and conditions with their own weight.
    """
    most, root = pressure.degree + chosen.MORE, np.sqrt(1 - at.s**2)
    tests = pressure.polynomials(at.s, at.tau, most)
    trial = tests[[pressure.terms(most).index(one) for one in pressure.terms(pressure.degree)]]
    values, slopes = np.tensordot([pressure.coefficients, pressure.radial_slope], trial, 1)
    steepness = at.s**2 / root * values - root * slopes  # -s dp/ds
    # times ds/dc_n: of a shift of the centre (1), of the half axes (0, 2), of the contour
    powers = [n if n > 2 else (n + 1) % 2 - 1 for n in pressure.waves]
    moved = [steepness * at.s**q * np.cos(n * at.tau) for q, n in zip(powers, pressure.waves, strict=True)]
    return tests, np.concatenate([trial * root, moved, tests * root**chosen.WEIGHT]) * at.weights
