"""Every planted fault by name, group after group, with the trials in which nothing is planted."""

from verification.credibility.faults.lists import (
    conjugate_gradients,
    conversion_fft,
    finite_elements,
    frf,
    harness,
    material,
    references,
    stress,
)
from verification.credibility.faults.planting import Edit, Fault

__all__ = ["BLANKS", "FAULTS", "GROUPS", "chosen"]

# The title of each group, in the order of the matrix.
GROUPS = {
    "material": "Material",
    "frf": "Frequency response functions",
    "conversion_fft": "Conversion and FFT",
    "conjugate_gradients": "Conjugate gradients",
    "stress": "Stress",
    "finite_elements": "Finite elements",
    "references": "References",
    "harness": "Harness",
}
_MODULES = (
    material,
    frf,
    conversion_fft,
    conjugate_gradients,
    stress,
    finite_elements,
    references,
    harness,
)
FAULTS: dict[str, Fault] = {fault.name: fault for module in _MODULES for fault in module.FAULTS}

_CASES = ("01_uncoated_steel", "14_ratio_4_sliding")
_ALL = ("01_uncoated_steel", "13_uncoated_sliding", "14_ratio_4_sliding", "15_dlc_chromium_sliding")
# What catches a fault must not catch these.
BLANKS: dict[str, Fault] = {
    fault.name: fault
    for fault in (
        Fault(
            "blank_semianalytic",
            "blank",
            "nothing is planted",
            "semianalytic",
            (),
            (),
            (*_ALL, "10_silver_steel"),
        ),
        Fault(
            "blank_finite_elements",
            "blank",
            "nothing is planted",
            "fem_reference",
            (),
            (),
            (*_ALL[:1], *_ALL[2:]),
        ),
        Fault("blank_references", "blank", "nothing is planted", "integral_equation", (), (), _ALL),
        Fault(
            "blank_printed",
            "blank",
            "nothing is planted",
            "published",
            (),
            (),
            published=("kenpave_three_layer_axis", "ahlvin_ulery_1962"),
        ),
        # A faulty method is sampled at the points of the clean run, which are no nodes of its own grid where
        # the fault moves the contact: that by itself must raise no alarm.
        Fault(
            "blank_other_grid",
            "blank",
            "nothing is wrong: the grid is 1 % wider, so that no point of comparison is a node of it",
            "semianalytic",
            (Edit("semianalytic.solver:solve", "fill: float = 1.12", "fill: float = 1.13"),),
            (),
            _CASES,
        ),
    )
}


def chosen(names: tuple[str, ...], group: str | None) -> list[Fault]:
    """The faults named, those of a group, or all with the blanks. Raises KeyError for one there is not."""
    known = FAULTS | BLANKS
    if names:
        return [known[name] for name in dict.fromkeys(names)]
    if group is not None:
        return [fault for fault in FAULTS.values() if fault.group == group]
    return [*FAULTS.values(), *BLANKS.values()]
