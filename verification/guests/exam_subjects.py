"""Subjects of a guest's exam: the contact of a case, then its solid under a uniform disc, under a square.

A prescribed load tries the response of the solid without the search for the contact, whose iteration or edge
profile hides the error of a poor influence coefficient.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from verification.cases.case_file import Case
from verification.guests.guest_description import Guest
from verification.judging.verdict import Claim
from verification.problem.array_types import Array, Coatings
from verification.problem.coated_contact import CoatedContact, PrescribedLoad
from verification.problem.line_profile import Line, Profile, line_of, lines_of, oblique_lines
from verification.problem.quantity import DISPLACEMENTS, IN_PLANE, QUANTITIES, STRESSES
from verification.running.case_result import CaseResult
from verification.sampling.line_sampling import positions, sample, sample_contact
from verification.sources.exact_sources import hertz, solve_exactly
from verification.sources.references.patch_displacement import surface_coefficient
from verification.sources.source_registry import EXACT, METHODS

REFERENCE = EXACT[0]
CLOSED_FORM = "hertz"
SPHERE, DISC, SQUARE = "sphere", "disc", "square"
PLANE, ROW, DIAGONAL = "plane", "row", "diagonal"
DEPTH = 0.6  # of the plane over a_h
RIM = 0.05  # of the radius: half-width of the zone left out at the rim of a disc, where p is discontinuous
ACROSS = np.linspace(-0.8, 0.8, 25)  # positions along the line in the plane, over a
PATCHES = 33  # over 2.24 a_h, as many squares as a coarse grid has
STEPS = np.unique(np.round(np.geomspace(1, PATCHES - 1, 9)))


@dataclass(frozen=True)
class SquareLoad:
    """Uniform ``pressure`` [Pa] on a square of ``side`` [m] on ``coatings`` on ``substrate``."""

    pressure: float
    side: float
    coatings: Coatings
    substrate: tuple[float, float]


Load = CoatedContact | PrescribedLoad | SquareLoad


def reference_of(problem: CoatedContact | Mapping[str, Any]) -> str:
    """The source of the exact values of a contact, or of its record: of an ellipsoid Hertz's closed form."""
    indenter = problem.get("indenter") if isinstance(problem, Mapping) else problem.indenter
    return CLOSED_FORM if indenter else REFERENCE


def exact_profile(result: CaseResult, quantity: str, line: str = "contact") -> Profile | None:
    """The exact values of ``quantity`` on ``line`` in ``result``; None where it has none."""
    return result.profile_of.get((quantity, line, reference_of(result.problem)))


def exact_radius(result: CaseResult) -> float:
    """Contact radius [m] of the exact reference in ``result``."""
    return float(result.profile_of["contact_radius", "contact", reference_of(result.problem)].value[0])


@dataclass(frozen=True)
class Subject(Case):
    """A case, or its solid under another ``load``: sphere, disc or square; ``problem`` is always the contact.

    The disc carries p_h on the radius a_h, the square p_h on a patch of a coarse grid over the contact.
    """

    load: str = SPHERE

    @property
    def loaded(self) -> Load:
        """The problem to solve."""
        p = self.problem
        if self.load == SQUARE:
            return SquareLoad(p.p_h, 2.24 * p.a_h / PATCHES, p.coatings, p.substrate)
        return p.under_disc(p.p_h, p.a_h) if self.load == DISC else p

    @property
    def lines(self) -> tuple[Line, ...]:
        """Those of the case with the plane; of the square two rows of patches."""
        if self.load == SQUARE:
            return Line(ROW, None, 0), Line(DIAGONAL, None, 0, direction=(0.5**0.5, 0.5**0.5, 0.0))
        return (*lines_of(self.problem), *oblique_lines(self.problem), plane_of(self.problem))

    def line(self, name: str) -> Line:
        """The line called ``name``."""
        own = {line.name: line for line in self.lines}
        return own[name] if name in own else line_of(name, self.problem)

    def exact(self) -> tuple[Profile, ...]:
        """The exact values on every line, with those numbers of the contact that differences refer to."""
        problem = self.loaded
        if isinstance(problem, SquareLoad):
            return self._under_square(problem)
        if self.problem.indenter is not None:
            return sample_contact(hertz(self.problem), CLOSED_FORM)
        solution = solve_exactly(problem)
        places = positions(
            self.problem, [line for line in self.lines if line.name != PLANE], {REFERENCE: solution}
        )
        found = list(sample_contact(solution, REFERENCE))
        peaks = self.problem if self.load == SPHERE else None
        for line in self.lines:
            at = places[line] if line in places else ACROSS * solution.contact_radius
            if self.load == DISC and line.place in ("surface", "oblique surface"):
                at = at[np.abs(np.abs(at) - solution.contact_radius) >= RIM * solution.contact_radius]
            found += sample(solution, REFERENCE, line, at, peaks)
        return tuple(found)

    def _under_square(self, load: SquareLoad) -> tuple[Profile, ...]:
        """u_z of the surface at the centres of patches beside a loaded one, with the patch as the contact."""
        side, p = load.side, load.pressure
        places = {ROW: side * np.array([0.0, *STEPS]), DIAGONAL: 2**0.5 * side * STEPS}
        found = []
        for line in self.lines:
            x, y, _ = line.points(places[line.name])
            K = [
                surface_coefficient(*at, side, load.coatings, load.substrate) for at in zip(x, y, strict=True)
            ]
            found.append(_exact("u_z", line.name, places[line.name], p * np.array(K)))
        scales = {"contact_radius": side / 2, "peak_pressure": p, "approach": float(found[0].value[0])}
        return (*found, *(_exact(q, "contact", np.zeros(1), np.array([v])) for q, v in scales.items()))


def _exact(quantity: str, line: str, position: Array, value: Array) -> Profile:
    # Ten digits, see ``patch``.
    return Profile(quantity, line, position, value, REFERENCE, 1e-10 * np.abs(value))


def plane_of(problem: CoatedContact) -> Line:
    """A line across the plane z = 0.6 a_h, off the planes of symmetry: FFT codes give whole planes."""
    a, z = problem.a_h, DEPTH * problem.a_h
    layer = int(np.searchsorted(problem.interfaces, z))
    return Line(PLANE, None, layer, (0.1 * a, -0.05 * a, z), (0.8, 0.6, 0.0))


def subject_of(case: Case, load: str = SPHERE) -> Subject:
    """``case`` under ``load``, with its claims about the exact reference."""
    given = {f.name: getattr(case, f.name) for f in fields(Case)}
    # Claims of a case are about pairs of sources; those of the first method are the ones that a guest meets.
    pattern = (METHODS[0], reference_of(case.problem))
    own = tuple(claim for claim in case.claims if claim.between == pattern)
    subject = Subject(**given | {"claims": own}, load=load)
    if load == SPHERE:
        # Of a case file with claims of its own nothing more is judged.
        whole = any(claim.line == "off plane" for claim in own)
        return replace(subject, claims=(*own, *(_claims(PLANE, STRESSES) if whole else ())))
    names = {DISC: "a uniform disc", SQUARE: "a uniform square"}
    claims = (
        _of_disc(case.problem) if load == DISC else [*_claims(ROW, ("u_z",)), *_claims(DIAGONAL, ("u_z",))]
    )
    title = f"{case.title}, under {names[load]}"
    return replace(subject, name=f"{case.name}_{load}", title=title, claims=tuple(claims))


def subjects_of(cases: Iterable[Case], guest: Guest) -> tuple[Subject, ...]:
    """``cases`` with the prescribed loads that ``guest`` supports: on the flat, without friction."""
    found = []
    for case in cases:
        found.append(subject_of(case))
        if not case.problem.friction and case.problem.ball is None and case.problem.indenter is None:
            found += [subject_of(case, load) for load in (DISC, SQUARE) if load in guest.supports.loads]
    return tuple(found)


def _of_disc(problem: CoatedContact) -> list[Claim]:
    found: list[Claim] = []
    for line in (*lines_of(problem), *oblique_lines(problem), plane_of(problem)):
        stresses: Iterable[str] = IN_PLANE if line.depth else STRESSES
        if line.name == "surface":
            stresses = ("sigma_xx", "sigma_yy")
        elif line.name == "axis":
            stresses = ("sigma_xx", "sigma_zz")
        elif line.name == "oblique surface":
            stresses = ()
        found += _claims(line.name, (*stresses, *(DISPLACEMENTS if line.name.startswith("oblique") else ())))
    return found


def _claims(line: str, quantities: Iterable[str]) -> tuple[Claim, ...]:
    why = "the response of the solid, without the search for the contact"
    pattern = (METHODS[0], REFERENCE)
    return tuple(Claim(name, line, pattern, QUANTITIES[name].cap, why) for name in quantities)
