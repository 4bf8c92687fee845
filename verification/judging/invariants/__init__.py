"""Invariants of a solution: load balance, equilibrium, bonds, symmetry, limits."""

from verification.judging.invariant_verdict import Invariant
from verification.judging.invariants.resolved_invariants import resolved
from verification.judging.invariants.solution_invariants import check

__all__ = ["Invariant", "check", "resolved"]
