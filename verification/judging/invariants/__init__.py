"""Invariants of a solution: load balance, equilibrium, bonds, symmetry, limits."""

from verification.judging.invariant import Invariant
from verification.judging.invariants.check import check
from verification.judging.invariants.resolved import resolved

__all__ = ["Invariant", "check", "resolved"]
