"""Mutants: one operator, constant, index or term of the source changed by rule, as a sampled measure.

Beside the named catalogue of planted faults, which people chose, this measures with what nobody chose. An own
sampler, since a mutant is put to the numerical checks of the default run first, whose verdicts need the
solutions of a clean run, and to the unit tests of its room only after them. mutmut runs the unit tests that
reach a mutated function, cosmic-ray one command for every mutant; both judge by the exit code of that.
"""
