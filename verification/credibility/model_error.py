"""Error of the model itself at a problem: the cost of each assumption, from a model without it.

A fast model is evaluated at the problem; for a slow one the recorded map is read, see ``ASSUMPTIONS``.

A further assumption is one more entry of ``ASSUMPTIONS``: ``model_error``, the report and the manual show it.
``tests/tools assumptions`` measures its map, over the axes stated there.
"""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, fields
from functools import cache, partial

from verification.evidence.assumption_maps import SHIPPED, AssumptionMaps, read_maps
from verification.problem.coated_contact import CoatedContact
from verification.problem.display_units import prefixed
from verification.problem.quantity import BALL_PEAKS, PEAKS
from verification.sources.assumptions.contact_change import SCALARS, Change, of_goodman, of_sphere
from verification.sources.assumptions.finite_bodies import of_half_spaces
from verification.sources.assumptions.strain_cost_of_pair import of_pair

QUANTITIES = tuple(one.name for one in fields(Change))
PARABOLA, GOODMAN = "parabola for the sphere", "Goodman's assumption"
HALF_SPACES = "half-spaces for the ball and a disc as thick as its radius"
HALF_SPACES_OF = "half-spaces for the ball and a disc of {}"
SMALL_STRAINS = "small strains"
Reading = Callable[[CoatedContact], tuple[Change, Change]]


@dataclass(frozen=True)
class Assumption:
    """An assumption of all sources, with its ``title`` in sentences.

    change : change of a contact by dropping it, with the uncertainty; ValueError where there is none.
        None where the model is too slow for this, so that its map is read.
    warned : beginning of the warning of implausible input that says the same, which is not repeated.
    read : change of a problem by that of others, which the map holds; where the map alone is not enough.
    """

    title: str
    change: Reading | None = None
    warned: str = ""
    read: Callable[[CoatedContact, Reading], tuple[Change, Change]] = lambda problem, at: at(problem)


ASSUMPTIONS: dict[str, Assumption] = {
    "sphere": Assumption(PARABOLA, of_sphere, warned="contact radius a ="),
    "goodman": Assumption(GOODMAN, of_goodman),
    "bodies": Assumption(HALF_SPACES, of_half_spaces),
    "strains": Assumption(SMALL_STRAINS, read=of_pair),
}

WORDS = {
    "contact_radius": "contact radius",
    "peak_pressure": "peak pressure",
    "tension": "tension at the trailing edge",
    "shear": "shear of the first interface",
}
LIMIT = 0.05  # relative; a larger cost triggers a warning
LEAST = 1e-6  # relative; a smaller cost is not reported


@dataclass(frozen=True)
class Cost:
    """Relative change of ``quantity`` when ``assumption`` is dropped, with its absolute uncertainty."""

    assumption: str
    quantity: str
    change: float
    uncertainty: float

    @property
    def size(self) -> float:
        """Magnitude of the change and its uncertainty together."""
        return abs(self.change) + self.uncertainty

    @property
    def words(self) -> str:
        """Size in per cent, with a bound where it is tiny, and quantity."""
        percent = f"{100 * self.size:.2g} %" if self.size >= LEAST else "less than 0.0001 %"
        return f"{percent} of the {WORDS.get(self.quantity, self.quantity)}"


@dataclass(frozen=True)
class ModelError:
    """Costs of the assumptions at a problem; ``missing`` : (assumption, reason) of those not evaluated."""

    costs: tuple[Cost, ...]
    missing: tuple[tuple[str, str], ...] = ()

    def largest(self, quantities: Collection[str] = QUANTITIES, assumption: str = "") -> Cost | None:
        """The largest cost of ``quantities``, of one assumption or any; None where nothing was evaluated."""
        of = [c for c in self.costs if c.quantity in quantities and assumption in ("", c.assumption)]
        return max(of, key=lambda cost: cost.size, default=None)

    @property
    def dominating(self) -> tuple[Cost, ...]:
        """The largest cost of scalars and that of stresses."""
        stresses = [name for name in QUANTITIES if name not in SCALARS]
        return tuple(one for one in (self.largest(SCALARS), self.largest(stresses)) if one)

    @property
    def parts(self) -> tuple[str, ...]:
        """The dominating costs, each with its assumption."""
        return tuple(f"{one.words} ({one.assumption})" for one in self.dominating)

    def message(self) -> str:
        """One sentence: how good the model is."""
        if not self.parts:
            return "the error of the model was not evaluated"
        return f"the model itself is good to {' and '.join(self.parts)}"

    @property
    def sentences(self) -> str:
        """The message with its notes, those that begin alike in one sentence."""
        found: dict[str, list[str]] = {}
        for start, _, rest in (note.partition(": ") for note in self.notes):
            found.setdefault(start, []).append(rest)
        notes = (f"{start}: {'; '.join(rests)}" for start, rests in found.items())
        return " ".join(f"{line[0].upper()}{line[1:]}." for line in (self.message(), *notes))

    @property
    def notes(self) -> tuple[str, ...]:
        """A line for each assumption that dominates nowhere, for each whose cost is not known here."""
        named = {one.assumption for one in self.dominating}
        others = dict.fromkeys(one.assumption for one in self.costs if one.assumption not in named)
        worst = [cost for one in others if (cost := self.largest(assumption=one)) and cost.size >= LEAST]
        unknown = (f"not known here: {assumption} ({reason})" for assumption, reason in self.missing)
        return (*(f"less: {one.words} ({one.assumption})" for one in worst), *unknown)

    def warnings(self, judged: Collection[str] = QUANTITIES, told: Sequence[str] = ()) -> tuple[str, ...]:
        """A line for each assumption that costs more than ``LIMIT`` of a quantity among ``judged``.

        told : warnings of implausible input, which are not repeated.
        """
        found = []
        known = {one.title: one.warned for one in ASSUMPTIONS.values()}
        for title in dict.fromkeys(cost.assumption for cost in self.costs):
            warned = known.get(title, "")
            if warned and any(line.startswith(warned) for line in told):
                continue
            worst = self.largest(judged, title)
            if worst is not None and worst.size > LIMIT:
                hint = "; give yours, --thickness-of-sample" if title == HALF_SPACES else ""
                found.append(f"{title} costs {worst.words}{hint}")
        return tuple(found)


def model_error(
    problem: CoatedContact, maps: AssumptionMaps | None = None, sample: float | None = None
) -> ModelError:
    """Costs of the assumptions at ``problem``, in tenths of a second; in seconds under h < a_h/20.

    maps : to read the assumptions in that are not evaluated; those of the package if None.
    sample : thickness of the flat with its coatings [m], in place of the radius of the ball.
    """
    if problem.indenter is not None:
        return ModelError((), tuple((one.title, "it is known for spheres") for one in ASSUMPTIONS.values()))
    maps = _shipped() if maps is None else maps
    costs: list[Cost] = []
    missing: list[tuple[str, str]] = []
    assumptions = dict(ASSUMPTIONS)
    if sample is not None:
        own = partial(of_half_spaces, thickness=sample / problem.radius)
        assumptions["bodies"] = Assumption(HALF_SPACES_OF.format(prefixed(sample, "m")), own)
    for name, assumption in assumptions.items():
        try:
            change, uncertainty = (
                assumption.change(problem) if assumption.change else _read(maps, name, problem)
            )
        except ValueError as error:
            missing.append((assumption.title, str(error)))
            continue
        if change.tension is None:
            reason = "its model has a rigid ball, no friction"
            missing.append((f"{assumption.title}, of the stresses", reason))
        costs += [
            Cost(assumption.title, field.name, value, getattr(uncertainty, field.name))
            for field in fields(change)
            if (value := getattr(change, field.name)) is not None
        ]
    return ModelError(tuple(costs), tuple(missing))


def judged_quantities(claimed: Collection[str]) -> tuple[str, ...]:
    """The members of ``QUANTITIES`` that claims on the quantities ``claimed`` judge."""
    by = {
        "peak_pressure": ("peak_pressure", "pressure"),
        "tension": ("sigma_xx", *PEAKS, *BALL_PEAKS),
        "shear": ("sigma_xz",),
    }
    return tuple(name for name in QUANTITIES if any(one in claimed for one in by.get(name, (name,))))


def _read(maps: AssumptionMaps, name: str, problem: CoatedContact) -> tuple[Change, Change]:
    found = maps.of(name)
    if found is None:
        raise ValueError(f"its map was not measured; run: python tests/tools assumptions {name} --record")
    return ASSUMPTIONS[name].read(problem, found.at)


@cache
def _shipped() -> AssumptionMaps:
    return read_maps(SHIPPED) or AssumptionMaps(())
