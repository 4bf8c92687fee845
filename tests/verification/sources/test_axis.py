"""Towards the axis every source is smooth: its stresses there are the limit of those beside it."""

import numpy as np
import pytest

from verification.problem.coated_contact import CoatedContact
from verification.sources.source_registry import solvers

CONTACT = CoatedContact(10e-3, 20.0, ((630e9, 0.2, 20e-6),), (210e9, 0.3), friction=0.4)
SETTINGS = {"fem_reference": {"quality": "fast", "estimate_uncertainty": False}}


@pytest.mark.parametrize("source", ["semianalytic", "fem_reference", "integral_equation"])
def test_stresses_next_to_the_axis_tend_to_those_on_it(source):
    solution = solvers()[source](CONTACT, SETTINGS.get(source, {"estimate_uncertainty": False}))
    a = solution.contact_radius
    x = np.concatenate([[0.0], np.geomspace(1e-9, 1e-2, 15)])
    for z, layer in ((0.0, 0), (10e-6, 0), (20e-6, 1)):
        for along in ((1.0, 0.0), (0.0, 1.0), (0.6, -0.8)):
            sigma = solution.stress(a * x * along[0], a * x * along[1], z, layer=layer) / CONTACT.p_h
            far = np.abs(sigma - sigma[..., :1])
            # Linear in the distance, and to the digits of the source.
            assert np.all(far <= 10 * x + (1e-5 if source == "fem_reference" else 1e-8))
