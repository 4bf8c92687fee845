"""Influence coefficients are held against direct quadrature, and a poor conversion does not pass."""

from types import SimpleNamespace

import pytest
from faults_planted.fault_anchor import Change
from faults_planted.fault_planting import planted

from verification.cases.case_file import read_case, shipped_cases
from verification.judging.invariants.influence_error import influence_coefficients
from verification.judging.verdict import Outcome

# The grid of a solution, all that the invariant takes from it.
GRID = SimpleNamespace(diagnostics=SimpleNamespace(patches_per_side=65, patch_size=8e-6))
POOR = {
    "coefficients 1 % off": Change(
        "semianalytic:surface_coefficients",
        "1 / (np.pi * body.contact_modulus)",
        "1.01 / (np.pi * body.contact_modulus)",
    ),
    "an image twice as deep": Change(
        "semianalytic:surface_coefficients",
        "halfspace.surface_deflection(n, d, b)",
        "halfspace.surface_deflection(n, d, 2 * b)",
    ),
    "a domain too small": Change(
        "semianalytic:Response._transformed", "1e-07 / max(b, self.total)", "0.05 / h"
    ),
    "a prefactor 1 % off": Change(
        "semianalytic:_one_coating_excess",
        "th * (lam * (u + Q * th) + kap * (u + L * th) + 4 * kap * x * (1 + x))",
        "1.01 * th * (lam * (u + Q * th) + kap * (u + L * th) + 4 * kap * x * (1 + x))",
    ),
    "a block that coarse grids alone reach": Change(
        "semianalytic:_gauss_block", "d * np.hypot(X, Y)", "1.0001 * d * np.hypot(X, Y)"
    ),
}


@pytest.mark.parametrize(
    "name",
    ["01_uncoated_steel", "12_polymer_glass", "15_dlc_chromium_sliding", "21_coated_carbide_dlc_steel"],
)
def test_the_default_conversion_meets_quadrature(name):
    problem = read_case(shipped_cases()[name]).problem
    row = influence_coefficients(GRID, "semianalytic", problem)
    assert row.outcome is Outcome.AGREES
    assert row.value < 1e-9


@pytest.mark.parametrize("edit", POOR.values(), ids=list(POOR))
def test_a_poor_conversion_does_not_pass(edit):
    problem = read_case(shipped_cases()["05_ratio_4"]).problem
    with planted((edit,)):
        assert influence_coefficients(GRID, "semianalytic", problem).outcome is Outcome.DISAGREES
