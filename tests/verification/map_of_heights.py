"""A map of heights as an instrument writes it."""

from pathlib import Path

import numpy as np


def write_sdf(path: Path, heights: np.ndarray, side: float) -> None:
    """Square map ``heights[i, j]`` [m] of ``side`` [m] in the text format of ISO 25178-71, in nanometres."""
    n = len(heights)
    names = ("ManufacID = made", "CreateDate = 010120000000", "ModDate = 010120000000", f"NumPoints = {n}")
    scales = (f"NumProfiles = {n}", f"Xscale = {side / n!r}", f"Yscale = {side / n!r}", "Zscale = 1e-9")
    kinds = ("Zresolution = -1", "Compression = 0", "DataType = 7", "CheckType = 0")
    body = " ".join(f"{height / 1e-9:.9e}" for height in heights.T.ravel())
    path.write_text("\n".join(["aISO-1.0", *names, *scales, *kinds, "*", body, "*", ""]))
