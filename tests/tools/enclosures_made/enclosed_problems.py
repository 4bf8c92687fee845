"""Problems with proven enclosures: layers from soft to stiff, from thin to thick, under one sphere.

Thicknesses are multiples of a_h; the numbers of each record are exact as binary numbers.
"""

from verification.problem.coated_contact import CoatedContact

RADIUS, LOAD = 10e-3, 20.0  # m, N
STEEL = (210e9, 0.3)
RATIOS = (0.1, 0.25, 0.5, 2.0, 4.0, 10.0)  # E1/E2
_Layers = tuple[tuple[float, float, float], ...]  # E over that of the substrate, nu, thickness over a_h
_OTHERS: dict[str, tuple[_Layers, tuple[float, float]]] = {
    "uncoated": ((), STEEL),
    "uncoated_nu_0.45": ((), (3e9, 0.45)),
    "same_material": (((1.0, 0.3, 1.0),), STEEL),
    "soft_nu_0.45": (((0.25, 0.45, 0.5),), STEEL),
    "stiff_on_nu_0.45": (((4.0, 0.2, 0.5),), (3e9, 0.45)),
    "nu_0": (((2.0, 0.0, 0.3),), (210e9, 0.2)),
    "nu_0.45_in_both": (((0.5, 0.45, 0.25),), (3e9, 0.45)),
    "two_stiff_on_soft": (((4.0, 0.2, 0.2), (0.5, 0.45, 0.3)), STEEL),
    "two_soft_on_stiff": (((0.25, 0.45, 0.3), (4.0, 0.2, 0.2)), STEEL),
    "two_graded": (((4.0, 0.25, 0.5), (2.0, 0.3, 0.5)), STEEL),
    "three_graded": (((4.0, 0.2, 0.2), (3.0, 0.25, 0.2), (2.0, 0.3, 0.2)), STEEL),
    "three_alternating": (((2.0, 0.3, 0.25), (0.5, 0.4, 0.25), (2.0, 0.3, 0.25)), STEEL),
    "three_soft_between_stiff": (((3.0, 0.1, 0.3), (0.3, 0.45, 0.1), (2.0, 0.3, 0.4)), (70e9, 0.45)),
}


def problems() -> dict[str, CoatedContact]:
    """Every problem by its name."""
    single = {f"ratio_{ratio:g}_h_{h:g}": (((ratio, 0.3, h),), STEEL) for ratio in RATIOS for h in (0.1, 1.0)}
    return {name: _problem(*solid) for name, solid in (single | _OTHERS).items()}


def _problem(layers: _Layers, substrate: tuple[float, float]) -> CoatedContact:
    a_h = CoatedContact(RADIUS, LOAD, (), substrate).a_h
    coatings = tuple((ratio * substrate[0], nu, h * a_h) for ratio, nu, h in layers)
    return CoatedContact(RADIUS, LOAD, coatings, substrate)


def profile_radii(name: str) -> tuple[float, ...]:
    """Radii [m] at which the pressure is enclosed too: those of the published tables, otherwise none."""
    if name not in ("ratio_0.5_h_1", "same_material", "ratio_2_h_1"):
        return ()
    a_h = problems()[name].a_h
    return tuple(i / 20 * a_h for i in range(27))
