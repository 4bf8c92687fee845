"""Every planted fault by name, group after group, with the negative controls."""

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
from verification.credibility.faults.planting import Edit, Fault, faults_of

__all__ = ["CONTROLS", "FAULTS", "GROUPS", "chosen"]

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
_NOTHING = "nothing is planted"
_control = faults_of("control", "semianalytic", _CASES)
# No check that catches a fault may fail in these trials.
CONTROLS: dict[str, Fault] = {
    fault.name: fault
    for fault in (
        _control("control_semianalytic", _NOTHING, (), cases=(*_ALL, "10_silver_steel")),
        _control(
            "control_finite_elements", _NOTHING, (), where="fem_reference", cases=(*_ALL[:1], *_ALL[2:])
        ),
        _control("control_references", _NOTHING, (), where="integral_equation", cases=_ALL),
        _control(
            "control_published",
            _NOTHING,
            (),
            where="published",
            cases=(),
            published=("kenpave_three_layer_axis", "ahlvin_ulery_1962"),
        ),
        # A faulty method is sampled at the points of the clean run, which are not nodes of its own grid where
        # the fault moves the contact: that alone must raise no alarm.
        _control(
            "control_other_grid",
            "no fault: the grid is 1 % wider, so that no point of comparison is a node of it",
            (),
            Edit("semianalytic.solver:solve", "fill: float = 1.12", "fill: float = 1.13"),
        ),
    )
}


def chosen(names: tuple[str, ...], group: str | None) -> list[Fault]:
    """The faults named, those of a group, or all with the controls. Raises KeyError for an unknown name."""
    known = FAULTS | CONTROLS
    if names:
        return [known[name] for name in dict.fromkeys(names)]
    if group is not None:
        return [fault for fault in FAULTS.values() if fault.group == group]
    return list(known.values())
