"""What every solution must satisfy, whatever the other sources say: balance, equilibrium, bonds, symmetry."""

from verification.invariants.check import check
from verification.invariants.laws import laws
from verification.invariants.record import Invariant

__all__ = ["Invariant", "check", "laws"]
