"""Semi-analytical contact of a rigid or elastic indenter on a coated elastic half-space.

Frequency response functions of the layers (``frf``) give influence coefficients of surface patches
(``influence``). Constrained conjugate gradients (``contact``) with discrete convolution (``convolution``)
find the pressures of the patches. A smooth edge between the patches is corrected from these pressures
(``edge_correction``); the stresses below follow from the influence of point forces (``subsurface``). A sphere
is an indenter with a round profile; with ``edge_correction=False`` the patches are left alone.

>>> import semianalytic
>>> steel = (210e9, 0.3)
>>> contact = semianalytic.solve(radius=10e-3, load=20.0, coatings=(), substrate=steel, patches=65)
>>> f"{contact.peak_pressure / 1e9:.2f} GPa"
'1.27 GPa'
"""

from semianalytic.patches.contact import NotConverged
from semianalytic.solution import Diagnostics, Solution
from semianalytic.solver import indent, solve, solve_prescribed
from semianalytic.uncertainty import Uncertainty

__all__ = ["Diagnostics", "NotConverged", "Solution", "Uncertainty", "indent", "solve", "solve_prescribed"]
