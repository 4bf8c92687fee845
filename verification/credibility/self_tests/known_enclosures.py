"""The exact reference held against proven enclosures, of a few problems that are quickly solved."""

from verification.credibility.enclosure_distance import distances
from verification.credibility.self_tests.known_answers import Answers
from verification.evidence.enclosure_record import SHIPPED, WIDTH, read_record
from verification.problem.coated_contact import keywords
from verification.sources.references import integral_equation

TEST = "exact reference"
COATED = ("ratio_10_h_1", "ratio_0.1_h_1", "two_soft_on_stiff")
# Of the value: an enclosure of the required width contains the reference.
ROUNDING = WIDTH / 2


def of_enclosures() -> Answers:
    record = read_record(SHIPPED)
    known = {one.name: one for one in record.enclosures} if record else {}
    for name in ("uncoated", *COATED):
        one = known[name]
        exact = integral_equation.solve(**keywords(one.problem), estimate_uncertainty=False)
        for bounds, distance, _ in distances(one, exact):
            what = f"{bounds.quantity} of {name}, {bounds.line}, in its enclosure"
            yield what, distance <= ROUNDING * abs(bounds.middle), True
