"""The assumptions that all sources share, with the models that drop them one at a time.

A further assumption is one more entry of ``ASSUMPTIONS``: ``model_error``, the report and the manual show it.
``tests/tools assumptions`` measures its map, over the axes stated there.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields

from verification.problem.coated_contact import CoatedContact
from verification.sources.assumptions.contact_change import Change, of_goodman, of_sphere
from verification.sources.assumptions.finite_bodies import of_half_spaces
from verification.sources.assumptions.strain_cost_of_pair import of_pair

QUANTITIES = tuple(one.name for one in fields(Change))
PARABOLA, GOODMAN = "parabola for the sphere", "Goodman's assumption"
HALF_SPACES = "half-spaces for the ball and a disc as thick as its radius"
SMALL_STRAINS = "small strains"
Reading = Callable[[CoatedContact], tuple[Change, Change]]


@dataclass(frozen=True)
class Assumption:
    """What all sources assume, with its ``title`` in sentences.

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
    "sphere": Assumption(PARABOLA, of_sphere, warned="contact radius a_h"),
    "goodman": Assumption(GOODMAN, of_goodman),
    "bodies": Assumption(HALF_SPACES, of_half_spaces),
    "strains": Assumption(SMALL_STRAINS, read=of_pair),
}
