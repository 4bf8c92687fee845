"""Error of the model itself at a problem: what its assumptions cost, each measured by a model without it.

Of the assumptions that all sources share, two are measured so far: the parabola of the sphere, the pressure
that friction does not change (Goodman). Not yet: small strains, half-spaces for bodies of finite size.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields

from verification.problem.contact import CoatedContact
from verification.sources.assumptions.change import Change, of_goodman, of_sphere

PARABOLA, GOODMAN = "parabola for the sphere", "Goodman's assumption"
# The relative error of a stress by the terms beyond the first order in C = f beta is below this times C^2: 0.17
# of a shear, 0.32 of a tension at C up to 0.3 by patches without an expansion. That of a scalar's change is
# 0.3 C^2 of it; of a peak pressure on a ring, below 0.25 C^2 of the pressure.
BEYOND = 0.5


@dataclass(frozen=True)
class Cost:
    """Relative change of ``quantity`` when ``assumption`` is dropped, with its absolute uncertainty."""

    assumption: str
    quantity: str
    change: float
    uncertainty: float


@dataclass(frozen=True)
class ModelError:
    """Costs of the assumptions at a problem; ``missing`` : (assumption, reason) of those not evaluated."""

    costs: tuple[Cost, ...]
    missing: tuple[tuple[str, str], ...] = ()

    def largest(self, quantity: str | None = None) -> Cost | None:
        """The largest cost of ``quantity``, of all of them if None; None where nothing was evaluated."""
        of = [cost for cost in self.costs if quantity in (None, cost.quantity)]
        return max(of, key=lambda cost: abs(cost.change) + cost.uncertainty, default=None)

    def message(self, quantity: str | None = None) -> str:
        """One sentence: how good the model is, and the assumption that dominates."""
        worst = self.largest(quantity)
        if worst is None:
            return "the error of the model was not evaluated"
        size = 100 * (abs(worst.change) + worst.uncertainty)
        name = worst.quantity.replace("_", " ")
        return f"the model itself is good to {size:.2g} % of the {name}: {worst.assumption}"


def model_error(problem: CoatedContact) -> ModelError:
    """What the assumptions cost at ``problem``, in a few tenths of a second."""
    coupled = (problem.friction * problem.dundurs_beta) ** 2
    costs: list[Cost] = []
    missing: list[tuple[str, str]] = []
    known: tuple[tuple[str, Callable[[CoatedContact], Change], float], ...] = (
        (PARABOLA, of_sphere, 0.0),
        (GOODMAN, of_goodman, coupled),
    )
    for assumption, change_of, second in known:
        try:
            change = change_of(problem)
        except ValueError as error:
            missing.append((assumption, str(error)))
            continue
        for field in fields(change):
            value = getattr(change, field.name)
            if value is not None:
                costs.append(Cost(assumption, field.name, value, _beyond(field.name, value, second)))
    return ModelError(tuple(costs), tuple(missing))


def _beyond(quantity: str, change: float, coupled: float) -> float:
    """Terms beyond those computed, of ``coupled`` = C^2."""
    if quantity in ("tension", "shear"):
        return BEYOND * coupled
    if quantity == "peak_pressure":
        return BEYOND * coupled * max(abs(change), 0.5)
    return BEYOND * coupled * abs(change)
