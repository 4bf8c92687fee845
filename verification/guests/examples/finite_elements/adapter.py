"""The finite elements: spheres, discs."""

from typing import Any

import fem_reference


def solve(**problem: Any) -> Any:
    """A sphere of ``radius`` or a disc of ``load_radius``."""
    return (
        fem_reference.solve_prescribed(**problem) if "pressure" in problem else fem_reference.solve(**problem)
    )
