"""Displacement beside a loaded square against closed forms and limits."""

import numpy as np
import pytest

from verification.sources.references.patch_displacement import over_square, surface_coefficient

STEEL = (210e9, 0.3)  # E [Pa], nu
PLACES = [(0, 0), (1, 0), (1, 1), (3, 2), (20, 0), (64, 64)]


def potential(x, y, side, depth=0.0):
    """int int 1/sqrt(r^2 + depth^2) over a square; Love (1929), as a sum over its corners."""

    def corner(X, Y):
        rho = np.sqrt(X * X + Y * Y + depth**2)
        value = X * np.arcsinh(Y / np.hypot(X, depth)) + Y * np.arcsinh(X / np.hypot(Y, depth))
        return value - (depth * np.arctan(X * Y / (depth * rho)) if depth else 0.0)

    b = side / 2
    return corner(x + b, y + b) - corner(x - b, y + b) - corner(x + b, y - b) + corner(x - b, y - b)


@pytest.mark.parametrize(("i", "j"), PLACES)
def test_quadrature_of_an_uncoated_patch_is_loves_closed_form(i, j):
    E, nu = STEEL
    d = 3e-6
    love = (1 - nu**2) / (np.pi * E) * potential(i * d, j * d, d)
    # Both sums lose digits as the square of the distance over the side.
    assert surface_coefficient(i * d, j * d, d, (), STEEL) == pytest.approx(
        love, rel=1e-15 * (10 + i * i) * 10, abs=0
    )


@pytest.mark.parametrize(("i", "j"), PLACES)
@pytest.mark.parametrize("depth", [0.5, 2.0, 30.0])
def test_ring_integral_of_an_image_is_its_closed_form(i, j, depth):
    # M = e^(-b k) is the homogeneous solid seen from depth b: g = 1/sqrt(r^2 + b^2).
    found = over_square(i, j, 1.0, lambda r: 1 / (np.sqrt(r**2 + depth**2) + depth), panels=2)
    assert found == pytest.approx(potential(i, j, 1.0, depth), rel=1e-10, abs=0)


def test_coating_of_the_substrates_own_moduli_changes_nothing():
    d, h = 3e-6, 80e-6
    for i, j in PLACES:
        bare = surface_coefficient(i * d, j * d, d, (), STEEL)
        assert surface_coefficient(i * d, j * d, d, ((*STEEL, h),), STEEL) == pytest.approx(
            bare, rel=1e-10, abs=0
        )
