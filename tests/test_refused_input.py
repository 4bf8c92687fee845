"""Both methods refuse the same bad input, each by itself, with the same message that names the quantity."""

import numpy as np
import pytest

import fem_reference
import semianalytic

E = 210e9
GOOD = {
    "radius": 1e-2,
    "load": 20.0,
    "coatings": ((2 * E, 0.3, 1e-5),),
    "substrate": (E, 0.3),
    "friction": 0.1,
}

# neither numbers nor convertible without a guess
NOT_NUMBERS = (True, "1e-2", "steel", np.array([1.0, 2.0]), (1.0,), 1j)
NOT_POSITIVE = (*NOT_NUMBERS, float("nan"), float("inf"), 0.0, -1.0)
COATING = (2 * E, 0.3, 1e-5)


def with_coating(position, value):
    return {"coatings": ((*COATING[:position], value, *COATING[position + 1 :]),)}


BAD = (
    [("radius", {"radius": value}) for value in (*NOT_POSITIVE, None)]
    + [("load", {"load": value}) for value in NOT_POSITIVE]
    + [("friction", {"friction": value}) for value in (*NOT_NUMBERS, None, float("nan"), float("inf"))]
    + [("E of coating 1", with_coating(0, value)) for value in (*NOT_POSITIVE, None)]
    + [("nu of coating 1", with_coating(1, value)) for value in (*NOT_NUMBERS, None, float("nan"), -1.0, 0.6)]
    + [("thickness of coating 1", with_coating(2, value)) for value in (*NOT_POSITIVE, None)]
    + [
        ("E of the substrate", {"substrate": (value, 0.3)})
        for value in (True, "2e11", None, float("nan"), -E)
    ]
    + [
        ("nu of the substrate", {"substrate": (E, value)})
        for value in (False, "0.3", None, float("nan"), 0.51)
    ]
    + [("substrate", {"substrate": value}) for value in (None, E, (E,), (E, 0.3, 1.0), np.array([E, 0.3]))]
    + [("coatings", {"coatings": value}) for value in (None, E, "none", np.array([COATING]))]
    + [("coating 1", {"coatings": value}) for value in (COATING, (None,), ((E, 0.3),), (np.array(COATING),))]
)


def refusal(solve, change):
    with pytest.raises(ValueError, match=" = ") as caught:
        solve(**{**GOOD, **change})
    return str(caught.value)


@pytest.mark.parametrize(("quantity", "change"), BAD, ids=lambda value: repr(value)[:60])
def test_bad_input_is_refused_by_both_methods_with_one_message(quantity, change):
    message = refusal(fem_reference.solve, change)
    assert message.startswith(f"{quantity} = ")
    assert message == refusal(semianalytic.solve, change)
