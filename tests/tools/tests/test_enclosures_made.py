"""Proofs by ball arithmetic: repeatable, two forms of the layers overlap, nothing is shared."""

import pytest
from code_checked.import_independence import imports_of
from enclosures_made.enclosed_problems import problems

from verification.evidence.enclosure_record import SHIPPED, read_record

flint = pytest.importorskip("flint", reason="ball arithmetic is an extra: pip install 'coatcheck[certify]'")
contact_enclosure = pytest.importorskip("enclosures_made.contact_enclosure")
enclosed_response = pytest.importorskip("enclosures_made.enclosed_response")


def test_enclosures_are_proven_without_a_method_or_another_reference():
    forbidden = ("semianalytic", "fem_reference", "scipy", "verification.sources.references")
    found = imports_of("enclosures_made", forbidden)
    assert found.files == 7
    assert found.passed


@pytest.mark.slow
def test_ball_arithmetic_repeats_an_enclosure():
    name = "ratio_4_h_1"
    made = next(one for one in read_record(SHIPPED).enclosures if one.name == name)
    bits, flint.ctx.prec = flint.ctx.prec, 128
    balls = contact_enclosure.enclose(problems()[name])
    flint.ctx.prec = bits
    for bounds, ball in zip(
        made.bounds,
        (balls.contact_radius, balls.approach, balls.pressure, balls.surface, *balls.interface),
        strict=True,
    ):
        assert bounds.distance(float(ball.mid())) < 1e-14 * abs(bounds.middle)


def test_both_forms_of_the_layers_overlap():
    solid = enclosed_response.LayeredSolid(
        ((4e11, 0.2, 0.3), (5e10, 0.45, 0.4), (3e11, 0.0, 0.2)), (1e11, 0.1)
    )
    for k in (1e-3, 0.3, 2.0, 5.0):
        x = [flint.acb(k) * h for h in solid.thickness]
        for one, other in zip(solid.propagated(x), solid.reflected(x), strict=True):
            assert one.overlaps(other)
            assert one.real.rad() < 1e-9


def test_the_bound_of_the_tail_holds_beyond_its_end():
    h = 0.3
    solid = enclosed_response.LayeredSolid(((4e11, 0.2, h), (5e10, 0.45, 0.4)), (1e11, 0.1))
    C, D = solid.tail(flint.arb(30))
    for k in (30.0, 31.0, 45.0, 80.0):
        x = k * flint.arb(h)
        fast, slow = C * (1 + x) ** 2 * (-2 * x).exp(), D * (1 + x) * (-x).exp()
        for value, bound in zip(solid.amplitudes(flint.acb(k)), (fast, fast, slow, slow), strict=True):
            assert value.abs_upper() < bound
            assert value.abs_upper() > bound / 1e5  # the bound is no triviality
