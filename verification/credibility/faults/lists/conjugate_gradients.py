"""Faults in the contact iteration of the semi-analytical method."""

from verification.credibility.faults.planting import Edit, Fault

__all__ = ["FAULTS"]

GROUP = "conjugate_gradients"
SOLID = ("01_uncoated_steel", "14_ratio_4_sliding")
SCALARS = ("approach", "peak_pressure", "contact_radius", "pressure")
MEASURE = "semianalytic.contact:_measure"


def _fault(name: str, sentence: str, expected: tuple[str, ...], *changes: Edit) -> Fault:
    return Fault(name, GROUP, sentence, "semianalytic", changes, expected, SOLID)


FAULTS = (
    _fault(
        "loose_tolerance",
        "the iteration ends at a gap of 1e-2 of the approach, whatever was asked for",
        SCALARS,
        Edit(
            "semianalytic.contact:_within_tolerance",
            "state.residual <= problem.tolerance",
            "state.residual <= max(problem.tolerance, 1e-2)",
        ),
    ),
    _fault(
        "load_off",
        "the load on the patches is 0.5 % too large",
        SCALARS,
        Edit(
            "semianalytic.level:LevelProblem.solve",
            "(indenter.load - missing) /",
            "(1.005 * indenter.load - missing) /",
        ),
    ),
    _fault(
        "load_of_the_rim",
        "what the rim patches lack of the load is forgotten",
        (*SCALARS, "load balance"),
        Edit(
            "semianalytic.defect_correction:corrected",
            "missing = shape.load - float(on_patches.sum() * grid.d**2)",
            "missing = 0.0",
        ),
    ),
    _fault(
        "stale_contact_set",
        "the contact set stays that of the first guess: no patch enters it, none leaves",
        (*SCALARS, "sphere"),
        Edit(
            MEASURE,
            "state.admissible = not state.tension.any() and state.depth <= state.deep",
            "state.admissible = True",
        ),
    ),
    _fault(
        "tension_kept",
        "negative pressure is kept: no patch ever leaves the contact",
        (*SCALARS, "surface tractions"),
        Edit(MEASURE, "state.tension = state.p < 0", "state.tension = state.p < -np.inf"),
    ),
    _fault(
        "sphere_for_parabola",
        "the gap is that of a round sphere where every other source takes the parabola",
        SCALARS,
        Edit(
            "semianalytic.solver:solve",
            "grid.radius**2 / (2 * radius)",
            "radius - np.sqrt(radius**2 - grid.radius**2)",
        ),
    ),
    _fault(
        "diameter_for_radius",
        "the gap is that of a sphere of 1.001 times the radius",
        SCALARS,
        Edit(
            "semianalytic.solver:solve", "grid.radius**2 / (2 * radius)", "grid.radius**2 / (2.002 * radius)"
        ),
    ),
)
