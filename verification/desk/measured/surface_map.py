"""A measured surface as heights on a grid, read by SurfaceTopography: in metres, levelled, with orientation.

Heights count out of the measured body, as instruments store them; its highest points touch first.
"""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import RectBivariateSpline, griddata

from verification.cases.toml_file import CaseError
from verification.cases.unit_numbers import LENGTHS
from verification.problem.array_types import Array

SHADES = " .:-=+*#%@"  # from the lowest to the highest
BOWL = 0.5  # share of the variance of the heights that a paraboloid with a high rim explains


@dataclass(frozen=True, eq=False)
class SurfaceMap:
    """Levelled ``heights`` [m] at x, y [m] about the middle of the map, ``heights[i, j]`` at (x[i], y[j]).

    unit : of the file.   tilt : largest height that levelling took off [m].   filled : points without data,
    from those around them.
    """

    x: Array
    y: Array
    heights: Array
    unit: str
    tilt: float
    filled: int

    @property
    def half_width(self) -> float:
        """Half the side [m] of the square about the middle that the map covers, with the last pixels."""
        return 0.5 * min(np.ptp(self.x) + self.x[1] - self.x[0], np.ptp(self.y) + self.y[1] - self.y[0])

    def on_ball(self, radius: float) -> "SurfaceMap":
        """The map on a ball of ``radius`` [m], whose summit is in the middle."""
        r2 = self.x[:, None] ** 2 + self.y[None, :] ** 2
        return SurfaceMap(self.x, self.y, self.heights - r2 / (2 * radius), self.unit, self.tilt, self.filled)

    def gap(self, x: Any, y: Any) -> Array:
        """Height above the lowest point of the body that presses down [m], by cubic splines."""
        return np.asarray(self.heights.max() - self._spline.ev(*np.broadcast_arrays(x, y)))

    @cached_property
    def _spline(self) -> RectBivariateSpline:
        return RectBivariateSpline(self.x, self.y, self.heights)

    @property
    def curvature(self) -> tuple[float, float]:
        """Curvature [1/m] of the best paraboloid, positive of a hill, and the share that it explains."""
        r2 = self.x[:, None] ** 2 + self.y[None, :] ** 2
        r2, h = r2 - r2.mean(), self.heights - self.heights.mean()
        slope = float((r2 * h).sum() / (r2 * r2).sum())
        variance = float((h * h).sum())
        return -2 * slope, slope**2 * float((r2 * r2).sum()) / variance if variance else 0.0

    @property
    def is_bowl(self) -> bool:
        """Whether its rim is high and its middle low, as of a ball's map that is upside down."""
        bend, share = self.curvature
        return bend < 0 and share > BOWL

    @property
    def skewness(self) -> float:
        """Third moment of the heights over the cube of their standard deviation: below 0 for plateaus."""
        h = self.heights - self.heights.mean()
        return float((h**3).mean() / (h * h).mean() ** 1.5) if h.any() else 0.0

    def shades(self, columns: int = 40) -> list[str]:
        """The map as lines of characters, the highest ones as @; x to the right, y upwards."""
        rows = max(columns * self.y.size // (2 * self.x.size), 1)
        picked = self.heights[
            np.ix_(*(np.arange(n) * size // n for n, size in ((columns, self.x.size), (rows, self.y.size))))
        ]
        level = (picked - picked.min()) / (np.ptp(picked) or 1.0) * (len(SHADES) - 1)
        return ["".join(SHADES[round(k)] for k in row) for row in level.T[::-1].tolist()]


def read_map(
    path: Path, unit: str | None = None, size: float | None = None, *, turned: bool = False
) -> SurfaceMap:
    """The levelled map of a file that SurfaceTopography reads.

    unit : of lengths and heights, where the file has none.   size : of its side along x [m], likewise.
    turned : upside down.   Raises CaseError, and ModuleNotFoundError without the extra ``surfaces``.
    """
    from SurfaceTopography import open_topography

    if not path.is_file():
        raise CaseError(f"{path}: there is no such file")
    try:
        reader = open_topography(str(path))
        channel = reader.channels[0]
        own = channel.unit and channel.unit.replace("µ", "u").replace("μ", "u")
        if unit and own and unit != own:
            raise CaseError(f"{path}: has the unit {own}; leave out --unit {unit}")
        if (unit := own or unit) not in LENGTHS:
            raise CaseError(f"{path}: has no unit that is known; give --unit um, or {', '.join(LENGTHS)}")
        pixels = tuple(channel.nb_grid_pts or ())
        if len(pixels) != 2 or min(pixels) < 8:
            raise CaseError(f"{path}: holds {' x '.join(map(str, pixels))} points; a map has 8 x 8 at least")
        sides = channel.physical_sizes
        if sides is None and size is None:
            raise CaseError(f'{path}: has no size; give that of its side along x, --size "100 um"')
        if sides is not None and size is not None:
            raise CaseError(f"{path}: has its own size, {sides[0]:g} {unit} along x; leave out --size")
        given = (
            {"physical_sizes": tuple(size / LENGTHS[unit] * n / pixels[0] for n in pixels)} if size else {}
        )
        topography = reader.topography(**given)
        heights: Array = np.ma.filled(np.ma.asarray(topography.heights(), dtype=float), np.nan)
        lengths = [LENGTHS[unit] * float(side) for side in topography.physical_sizes]
    except CaseError:
        raise
    except Exception as error:  # of a reader of some forty formats
        unknown = type(error).__name__ == "CannotDetectFileFormat"
        told = "of no format that it knows" if unknown else " ".join(str(error).split())[:200]
        raise CaseError(f"{path}: SurfaceTopography does not read it: {told}") from None
    return levelled(heights * LENGTHS[unit] * (-1.0 if turned else 1.0), lengths, unit, path)


def levelled(heights: Array, lengths: list[float], unit: str, path: Path) -> SurfaceMap:
    """A map less its plane of least squares, its missing points filled. Raises CaseError."""
    x, y = (
        (np.arange(n) + 0.5) / n * side - side / 2 for n, side in zip(heights.shape, lengths, strict=True)
    )
    X, Y = np.meshgrid(x, y, indexing="ij")
    known = np.isfinite(heights)
    filled = int((~known).sum())
    if filled > heights.size // 10:
        raise CaseError(f"{path}: {filled} of {heights.size} points have no data; fill or crop the map first")
    plane = np.stack([np.ones(heights.size), X.ravel(), Y.ravel()], axis=1)
    found, *_ = np.linalg.lstsq(plane[known.ravel()], heights[known], rcond=None)
    taken = (plane @ found).reshape(heights.shape)
    flat = heights - taken
    if filled:
        flat[~known] = griddata((X[known], Y[known]), flat[known], (X[~known], Y[~known]), method="nearest")
    return SurfaceMap(x, y, flat, unit, float(np.ptp(taken)), filled)
