"""The largest stresses of a contact with any number of coatings, each with place, layer, uncertainty.

The searches are those of the plane y = 0, where a sphere that slides along x has its largest stresses:

    sigma_1 = max(sigma_yy, (sigma_xx + sigma_zz)/2 + sqrt((sigma_xx - sigma_zz)^2/4 + sigma_xz^2))

since sigma_xy = sigma_yz = 0 there by symmetry. Under an ellipsoid that does not slide the plane x = 0, which
has the same symmetry, is searched too. An equibiaxial residual stress of a coating
adds to sigma_xx, sigma_yy within it alone: the half-space below balances it at no stress. The tractions of an
interface change near a free edge of the coating only, which is not part of this.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import accumulate
from typing import Any

import numpy as np

from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, ContactSolution
from verification.problem.either_body import on_body
from verification.problem.point_answers import BALL, Points
from verification.problem.quantity import first_principal, largest_shear, largest_strain, von_mises
from verification.sampling.along_axis import AlongAxis
from verification.sampling.largest_tension import Search
from verification.study.friction_planes import (
    XX,
    XZ,
    YY,
    ZZ,
    DepthLine,
    Parts,
    inner_planes,
    outer_planes,
    stress_at,
)
from verification.study.largest_stresses import (
    LayerGrid,
    Located,
    Measure,
    Unstated,
    inside,
    largest,
    stated,
    tensile,
    vertex,
    with_residual,
)

REACH, POINTS = 2.0, 401  # of a course, over a
ACROSS = {"sigma_xx": "sigma_yy", "|sigma_xz|": "|sigma_yz|"}  # a stress along x, and the same along y


@dataclass(frozen=True)
class Extreme:
    """The largest ``quantity`` at one place of a ``body``: ``value`` +- ``uncertainty`` [Pa] at x, z [m].

    quantity : sigma_xx, |sigma_xz|, across sigma_yy, |sigma_yz|, sigma_zz, sigma_1, von_mises, tau_max (half
    of Tresca's stress); strain, the largest principal one in magnitude, which has no unit.   where :
    "surface", "base of coating 1", "top of substrate", "interface 1", "coating 1" and the like.   x : along
    the sliding of the ball over the flat; NaN with value 0 where a tensile stress is nowhere positive, in a
    layer without residual stress.
    z : into the body.   y : across, of a contact that is not round.
    """

    body: str
    quantity: str
    where: str
    value: float
    uncertainty: float
    x: float
    z: float
    y: float = 0.0


@dataclass(frozen=True, eq=False)
class StressCourse:
    """sigma_xx, sigma_yy, sigma_zz, sigma_xz [Pa], (4, n), along ``x`` [m] at one place as of ``Extreme``."""

    body: str
    where: str
    x: Array
    stress: Array


def stresses(
    solution: ContactSolution,
    problem: CoatedContact,
    residual: Mapping[str, tuple[float, ...]] | None = None,
    layers: Mapping[str, tuple[int, ...]] | None = None,
) -> tuple[tuple[Extreme, ...], tuple[StressCourse, ...]]:
    """Every largest stress of ``solution``, first of the flat from its surface down, then of an elastic ball.

    With them the stresses along x on the surface, both sides of each interface, out to 2 a.
    residual : equibiaxial stress [Pa] of each layer by body, 0 unless given.
    layers : number of sub-layers of each coating by body, 1 unless given; they count as one coating.
    Raises what ``solution.stress`` raises.
    """
    # an ellipsoid along x, and where it does not slide along y
    axes = (False,) if problem.friction else (False, True)
    ellipse = [AlongAxis(solution, across=across) for across in axes if problem.elliptical]
    sides: list[Any] = [*ellipse] or [solution]
    found, drawn = [], []
    searched: dict[tuple[object, ...], tuple[_Layers, list[list[tuple[str, str, Located]]]]] = {}
    for body in problem.bodies:
        seen, turned = problem.seen_from(body), -1.0 if body == BALL else 1.0
        sublayers = (layers or {}).get(body) or (1,) * len(seen.coatings)
        own = (residual or {}).get(body, ())
        # two bodies of the same layers have the same stresses, each in its own frame
        twin = (seen.coatings, seen.substrate, own, sublayers)
        if twin not in searched:
            views = [_Layers(on_body(side, body), seen, own, sublayers) for side in sides]
            searched[twin] = views[0], [one.extremes() for one in views]
        layered, (along, *across) = searched[twin]
        places = [  # without -0
            Extreme(body, quantity, where, at.value, at.uncertainty, turned * at.x + 0.0, at.z)
            for quantity, where, at in along
        ]
        for other in across:
            beside = (
                Extreme(body, quantity, where, at.value, at.uncertainty, 0.0 * at.x + 0.0, at.z, at.x)
                for quantity, where, at in other
            )
            places = list(_of_both_planes(places, beside))
        found += places
        x = np.linspace(-REACH, REACH, POINTS) * float(sides[0].contact_radius)
        for where, line in layered.lines():
            stress = line(turned * x, seen.friction)
            stress[[XX, YY]] += layered.residual[line.layer]
            stress[XZ] *= turned
            drawn.append(StressCourse(body, where, x, stress))
    return tuple(found), tuple(drawn)


def _of_both_planes(along: Iterable[Extreme], across: Iterable[Extreme]) -> Iterator[Extreme]:
    """Largest stresses of the planes y = 0 and x = 0: of each component both, of any other the larger one."""
    for one, other in zip(along, across, strict=True):
        if one.quantity in ACROSS:
            yield one
            yield replace(other, quantity=ACROSS[one.quantity])
        else:
            yield max(one, other, key=lambda at: at.value)


class _Layers:
    """One body: planes on the upper side of each layer, ``tops``, the lower of each coating's, ``bases``.

    bounds : number of the layer with which each coating begins, then that of the substrate.
    residual : stress [Pa] of each layer, the substrate included.
    """

    def __init__(
        self,
        solution: ContactSolution,
        problem: CoatedContact,
        residual: tuple[float, ...],
        sublayers: tuple[int, ...],
    ) -> None:
        self.solution, self.problem, self.parts = solution, problem, Parts(solution, problem.friction)
        self.bounds = (0, *accumulate(sublayers))
        self.residual = (*(residual or [0.0] * len(problem.coatings)), 0.0)
        h = problem.interfaces[self.bounds[1] - 1] if problem.coatings else float(solution.contact_radius)
        self.tops, self.bases = outer_planes(self.parts, problem.interfaces, h)

    def _total(self, measure: Measure, layer: int) -> Measure:
        """``measure`` of a stress with the residual stress of its layer."""
        return with_residual(measure, self.residual[layer])

    def name(self, number: int) -> str:
        return "substrate" if number == len(self.bounds) - 1 else f"coating {number + 1}"

    def lines(self) -> Iterator[tuple[str, DepthLine]]:
        yield "surface", self.tops[0]
        for number, k in enumerate(self.bounds[1:]):
            yield f"base of {self.name(number)}", self.bases[k - 1]
            yield f"top of {self.name(number + 1)}", self.tops[k]

    def extremes(self) -> list[tuple[str, str, Located]]:
        """(quantity, where, the largest), the place in the frame of the body."""
        found = list(self._found())
        at = stated([one for *_, one in found], self.parts, self.problem.friction)
        return [
            (quantity, where, tensile(one) if alone else one)
            for (quantity, where, alone, _), one in zip(found, at, strict=True)
        ]

    def _found(self) -> Iterator[tuple[str, str, bool, Located]]:
        """(quantity, where, whether it is shown as a tension alone, the largest): without residual stress."""
        f = self.problem.friction
        yield "sigma_xx", "surface", not self.residual[0], self._surface()
        for where, line in list(self.lines())[1:]:
            measure = self._total(lambda s: s[XX], line.layer)
            yield "sigma_xx", where, not self.residual[line.layer], largest(line, measure, f)
        for k, base in enumerate(self.bases[i - 1] for i in self.bounds[1:]):
            yield "|sigma_xz|", f"interface {k + 1}", False, largest(base, lambda s: np.abs(s[XZ]), f)
            yield "sigma_zz", f"interface {k + 1}", True, largest(base, lambda s: s[ZZ], f)
        for number, layer in enumerate(self.bounds):
            below = (*self.bounds, layer + 1)[number + 1]
            if below - layer > 1:
                for quantity in self._measures(layer):
                    best, alone = self._graded(quantity, range(layer, below))
                    yield quantity, self.name(number), alone, best
                continue
            # They only locate: the uncertainty is evaluated at the place found.
            unstated = replace(self.parts, stated=False)
            between, knots = inner_planes(unstated, self.problem.interfaces, layer)
            planes = [self.tops[layer], *between, *self.bases[layer : layer + 1]]
            grid = LayerGrid.between(planes, knots, f)
            for quantity, measure in self._measures(layer).items():
                on = [largest(one, measure, f) for one in planes]
                within = inside(self.parts, grid, f, measure) + self._between(on, measure)
                found = max([on[0], on[-1], *within], key=lambda at: at.value)
                yield quantity, self.name(number), not self.residual[layer], found

    def _measures(self, layer: int) -> dict[str, Measure]:
        """Each measure of the stress of a ``layer``, with its residual stress."""
        E, nu = (*self.problem.coatings, self.problem.substrate)[layer][:2]
        strain = partial(largest_strain, E=E, nu=nu)
        of: dict[str, Measure] = {"sigma_1": first_principal, "von_mises": von_mises}
        of |= {"tau_max": largest_shear, "strain": strain}
        return {quantity: self._total(measure, layer) for quantity, measure in of.items()}

    def _graded(self, quantity: str, layers: range) -> tuple[Located, bool]:
        """The largest at the top and base of every sub-layer; uncertain too by the maximum between them.

        With it whether its sub-layer has no residual stress.
        """
        found = []
        for layer in layers:
            measure = self._measures(layer)[quantity]
            ends = [largest(p[layer], measure, self.problem.friction) for p in (self.tops, self.bases)]
            found.append(max(ends, key=lambda at: at.value))
        best = int(np.argmax([at.value for at in found]))
        at = found[best]
        # Between two planes it may be larger, but not beyond the outer ones.
        outer = at.z in (self.tops[layers[0]].z, self.bases[layers[-1]].z)
        near = sorted(one.value for one in found[max(best - 1, 0) : best + 2])
        excess = 0.0 if outer else near[-1] - near[-2]
        return replace(at, uncertainty=at.uncertainty + excess), not self.residual[layers[best]]

    def _between(self, found: Sequence[Unstated], measure: Measure) -> list[Unstated]:
        """The largest on the planes between, moved to the vertex in depth; none where an outer plane has it.

        found : on all planes.   Unlike ``inside`` it needs no interpolation in depth, whose error exceeds a
        small sigma_1 under strong compression. Its uncertainty contains the change by the move.
        """
        k = int(np.argmax([at.value for at in found]))
        if not 0 < k < len(found) - 1:
            return []
        near, layer = found[k - 1 : k + 2], found[0].layer
        z = np.array([at.z for at in near])
        depth = vertex(z, np.array([at.value for at in near]))
        x = np.array([found[k].x, np.interp(depth, z, [at.x for at in near])])
        z = np.array([found[k].z, depth])
        stress = stress_at(self.parts, x, z, layer, self.problem.friction)
        values = [float(measure(one)) for one in stress.T]
        best, moved = int(np.argmax(values)), abs(values[1] - values[0])
        at, radii = (float(x[best]), float(z[best])), np.abs(x[[best]])
        return [Unstated(values[best], moved, *at, layer, measure, stress[:, best], radii)]

    def _surface(self) -> Located:
        """The largest tension of the surface, with the cusp at the contact edge as a candidate."""
        search = Search(self.solution, self.problem)
        # the search needs uncertainties around the edges alone, and states its own elsewhere
        value = self.solution.stress(search.x, 0.0, 0.0, layer=0)[0, 0]
        _, around = self.solution.sample(Points(search.x[search.edges], layer=0), "stress")
        U = np.full_like(value, np.nan)
        U[search.edges] = np.nan if around is None else around[0, 0]
        found = search.largest(value, None if around is None else U)
        spread = float("nan") if found.uncertainty is None else found.uncertainty
        return Located(found.value + self.residual[0], spread, found.place, 0.0)
