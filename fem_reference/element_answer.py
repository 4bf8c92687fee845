"""Points at which a solution is asked, and the answer: a value with its uncertainty."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np


class ElementPoints(NamedTuple):
    """Places x, y, z [m], broadcast, z into the ``body``: "flat" or "ball", x and y as on the flat.

    layer : 0 at the surface to the number of coatings in the substrate; selects the side of an interface,
        None the upper one
    frame : of all or of each; "fixed", or "edge" for places meant as the same share of the way to the edge
    """

    x: Any
    y: Any = 0.0
    z: Any = 0.0
    layer: int | None = None
    body: str = "flat"
    frame: Any = "fixed"


class ElementAnswer(NamedTuple):
    """Value and absolute numerical uncertainty in SI units.

    pressure has the shape of the points, stress (3, 3) + it, displacement (3,) + it, a scalar is a float
    uncertainty : None when none was estimated; both are None of a quantity that is not supported
    """

    value: Any
    uncertainty: Any = None


@dataclass(frozen=True)
class ElementUncertainty:
    """Absolute numerical uncertainty in SI units; ``budget`` has rows (quantity, origin, value)."""

    contact_radius: float
    approach: float
    peak_pressure: float
    budget: tuple[tuple[str, str, float], ...]


class PlainFields:
    """The fields of a solution as plain arrays, its values without uncertainty; see ``ElementPoints``."""

    def sample(self, points: Any, quantity: str, uncertainty: bool = True) -> ElementAnswer:
        """Value of a quantity at points, with its uncertainty."""
        raise NotImplementedError

    def _repr_html_(self) -> str:
        """Sentence and table of the numbers for a notebook."""
        units = {"peak_pressure": ("MPa", 1e6), "contact_radius": ("µm", 1e-6), "approach": ("µm", 1e-6)}
        cells = ""
        for name, (unit, size) in units.items():
            value, U = self.sample(None, name)
            stated = "-" if U is None else f"{U / size:.0e}"
            label = f"{name.replace('_', ' ')} [{unit}]"
            cells += f"<tr><td>{label}</td><td>{value / size:.6g}</td><td>{stated}</td></tr>"
        head = "<p>Contact by finite elements.</p><table><tr><th></th><th>value</th><th>±</th></tr>"
        return f"{head}{cells}</table>"

    def pressure(self, x: Any, y: Any = 0.0) -> np.ndarray:
        """Contact pressure [Pa] at the surface points (x, y), broadcast; zero outside the contact."""
        return np.asarray(self.sample(ElementPoints(x, y), "pressure", False).value)

    def stress(self, x: Any, y: Any, z: Any, layer: int | None = None, body: str = "flat") -> np.ndarray:
        """Stress tensor sigma[i, j, ...] [Pa] in x, y, z; shape (3, 3) + broadcast shape of the points."""
        return np.asarray(self.sample(ElementPoints(x, y, z, layer, body), "stress", False).value)

    def displacement(self, x: Any, y: Any, z: Any, body: str = "flat") -> np.ndarray:
        """Displacement (u_x, u_y, u_z) [m], u_z into the body; shape (3,) + that of the points."""
        return np.asarray(self.sample(ElementPoints(x, y, z, None, body), "displacement", False).value)
