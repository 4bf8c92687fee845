"""The semi-analytical method as a guest: spheres, discs, squares by its influence coefficients."""

from typing import Any

import numpy as np

import semianalytic
from semianalytic.coefficients.influence import surface_coefficients
from semianalytic.inputs import Body, Numerics
from verification.problem.array_types import Array, Coatings

PATCHES = 33


def solve(**problem: Any) -> Any:
    """A sphere of ``radius``, a disc of ``load_radius`` or a square of ``side``."""
    if "side" in problem:
        return square(**problem)
    return (
        semianalytic.solve_prescribed(**problem) if "pressure" in problem else semianalytic.solve(**problem)
    )


def square(
    pressure: float, side: float, coatings: Coatings, substrate: tuple[float, float]
) -> dict[str, Any]:
    """u_z of the surface at the centres of patches beside a loaded one."""
    K = surface_coefficients(PATCHES, side, Body(coatings, substrate, 0.0), Numerics())

    def displacement(x: Array, y: Array, z: Array) -> Array:
        i, j = (np.rint(np.abs(v) / side).astype(int) for v in (x, y))
        u = np.full((3, x.size), np.nan)
        u[2] = pressure * K[i, j]
        return u

    return {"displacement": displacement}
