"""Types of arrays that the rooms exchange."""

import numpy as np
from numpy.typing import NDArray

__all__ = ["Array", "Coatings", "FloatArray"]

Array = NDArray[np.float64]
FloatArray = NDArray[np.floating]  # as the methods return them
Coatings = tuple[tuple[float, float, float], ...]
