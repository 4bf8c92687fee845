"""Semi-analytical contact of a rigid or elastic indenter on a coated elastic half-space.

For a sphere, an edge profile of the pressure is found by collocation of the exact deflection under it
(``collocation``). The patches (influence coefficients, DC-FFT, conjugate gradients) then solve the contact on
the grid, with the error of their deflection measured on the profile (``defect_correction``): they find what
the profile leaves, and the approach. Any other indenter is solved by the patches, corrected where its contact
has a smooth edge (``smooth_edge``); with ``edge_correction=False`` by the patches alone.

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
