"""What every solution must satisfy, whatever the other sources say: balance, equilibrium, bonds, symmetry."""

from verification.judging.invariant import Invariant
from verification.judging.invariants.check import check
from verification.judging.invariants.resolved import resolved

__all__ = ["Invariant", "check", "resolved"]
