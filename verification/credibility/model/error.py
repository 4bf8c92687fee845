"""Error of the model itself at a problem: what its assumptions cost, each measured by a model without it.

A fast model is evaluated at the problem; of a slow one the recorded map is read, see ``assumptions``.
"""

from dataclasses import dataclass, fields
from functools import cache

from verification.credibility.model.assumptions import ASSUMPTIONS, GOODMAN, HALF_SPACES, PARABOLA
from verification.credibility.model.maps import SHIPPED, AssumptionMaps, read_maps
from verification.problem.contact import CoatedContact
from verification.sources.assumptions.change import Change

__all__ = ["GOODMAN", "HALF_SPACES", "PARABOLA", "Cost", "ModelError", "model_error"]

WORDS = {
    "contact_radius": "contact radius",
    "peak_pressure": "peak pressure",
    "tension": "tension at the trailing edge",
    "shear": "shear of the first interface",
}


THINNEST = 0.02  # h/a_h; the exact reference needs memory and time in proportion to (a/h)^2 and more


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


@dataclass(frozen=True)
class ModelError:
    """Costs of the assumptions at a problem; ``missing`` : (assumption, reason) of those not evaluated."""

    costs: tuple[Cost, ...]
    missing: tuple[tuple[str, str], ...] = ()

    def largest(self, quantity: str | None = None) -> Cost | None:
        """The largest cost of ``quantity``, of all of them if None; None where nothing was evaluated."""
        of = [cost for cost in self.costs if quantity in (None, cost.quantity)]
        return max(of, key=lambda cost: cost.size, default=None)

    def message(self, quantity: str | None = None) -> str:
        """One sentence: how good the model is, and the assumption that dominates."""
        worst = self.largest(quantity)
        if worst is None:
            return "the error of the model was not evaluated"
        name = WORDS.get(worst.quantity, worst.quantity)
        return f"the model itself is good to {100 * worst.size:.2g} % of the {name}: {worst.assumption}"


def model_error(problem: CoatedContact, maps: AssumptionMaps | None = None) -> ModelError:
    """What the assumptions cost at ``problem``, in a few tenths of a second of a coating of a_h/10 or more.

    maps : to read the assumptions in that are not evaluated; those of the package if None.
    """
    maps = _shipped() if maps is None else maps
    thinnest = min((h for body in problem.bodies for *_, h in problem.seen_from(body).coatings), default=1e9)
    costs: list[Cost] = []
    missing: list[tuple[str, str]] = []
    for name, assumption in ASSUMPTIONS.items():
        try:
            if not assumption.direct:
                change, uncertainty = _read(maps, name, problem)
            elif thinnest < THINNEST * problem.a_h:
                raise ValueError(f"a coating thinner than {THINNEST:g} a_h; its model would need too long")
            else:
                change, uncertainty = assumption.change(problem)
        except ValueError as error:
            missing.append((assumption.title, str(error)))
            continue
        costs += [
            Cost(assumption.title, field.name, value, getattr(uncertainty, field.name))
            for field in fields(change)
            if (value := getattr(change, field.name)) is not None
        ]
    return ModelError(tuple(costs), tuple(missing))


def _read(maps: AssumptionMaps, name: str, problem: CoatedContact) -> tuple[Change, Change]:
    found = maps.of(name)
    if found is None:
        raise ValueError(f"its map was not measured; coatcheck assumptions {name} --record makes it")
    return found.at(problem)


@cache
def _shipped() -> AssumptionMaps:
    return read_maps(SHIPPED) or AssumptionMaps(())
