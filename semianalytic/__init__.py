"""Semi-analytical contact of a rigid indenter on a coated elastic half-space.

>>> import semianalytic
>>> steel = (210e9, 0.3)
>>> contact = semianalytic.solve(radius=10e-3, load=20.0, coatings=(), substrate=steel, patches=65)
>>> f"{contact.peak_pressure / 1e9:.2f} GPa"
'1.27 GPa'
"""

from semianalytic.contact import NotConverged
from semianalytic.solution import Diagnostics, Solution
from semianalytic.solver import indent, solve, solve_prescribed
from semianalytic.uncertainty import Uncertainty

__all__ = ["Diagnostics", "NotConverged", "Solution", "Uncertainty", "indent", "solve", "solve_prescribed"]
