"""Axisymmetric finite element model of a sphere, rigid or elastic, on a coated elastic half-space.

>>> from fem_reference import solve
>>> steel = (210e9, 0.3)
>>> contact = solve(radius=10e-3, load=20.0, coatings=((420e9, 0.3, 70e-6),), substrate=steel, quality="fast")
>>> bool(contact.contact_radius < 86.7e-6)  # stiffer than bare steel
True
"""

from fem_reference.contact.levels import ElementsNotConverged
from fem_reference.contact_solver import solve, solve_prescribed
from fem_reference.not_round.shaped_contact import ShapedContact, solve_shape
from fem_reference.solved_contact import ElementSolution
from fem_reference.vtu import write_vtu

__all__ = [
    "ElementSolution",
    "ElementsNotConverged",
    "ShapedContact",
    "solve",
    "solve_prescribed",
    "solve_shape",
    "write_vtu",
]
