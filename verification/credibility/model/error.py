"""Error of the model itself at a problem: what its assumptions cost, each measured by a model without it.

Of the assumptions that all sources share, two are measured so far: the parabola of the sphere, the pressure
that friction does not change (Goodman). Not yet: small strains, half-spaces for bodies of finite size.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields

from verification.problem.contact import CoatedContact
from verification.sources.assumptions.change import Change, of_goodman, of_sphere

PARABOLA, GOODMAN = "parabola for the sphere", "Goodman's assumption"
KNOWN: dict[str, Callable[[CoatedContact], tuple[Change, Change]]] = {
    PARABOLA: of_sphere,
    GOODMAN: of_goodman,
}


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
    costs: list[Cost] = []
    missing: list[tuple[str, str]] = []
    for assumption, change_of in KNOWN.items():
        try:
            change, uncertainty = change_of(problem)
        except ValueError as error:
            missing.append((assumption, str(error)))
            continue
        costs += [
            Cost(assumption, field.name, value, getattr(uncertainty, field.name))
            for field in fields(change)
            if (value := getattr(change, field.name)) is not None
        ]
    return ModelError(tuple(costs), tuple(missing))
