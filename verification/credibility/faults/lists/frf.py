"""Faults in the frequency response functions of the layered half-space."""

from verification.credibility.faults.planting import Edit, Fault

__all__ = ["FAULTS"]

GROUP = "frf"
SOLID = ("01_uncoated_steel", "14_ratio_4_sliding")
FILMS = ("01_uncoated_steel", "15_dlc_chromium_sliding")
ONE = "semianalytic.frf:_one_coating_excess"
SCALARS = ("approach", "peak_pressure", "contact_radius")


def _fault(
    name: str,
    sentence: str,
    target: str,
    old: str,
    new: str,
    expected: tuple[str, ...],
    cases: tuple[str, ...] = SOLID,
) -> Fault:
    return Fault(name, GROUP, sentence, "semianalytic", (Edit(target, old, new),), expected, cases)


FAULTS = (
    _fault(
        "kap_x2_dropped",
        "the term 4 kap x^2 is dropped from the denominator of the surface response",
        ONE,
        "(lam + kap + 4 * kap * x**2)",
        "(lam + kap)",
        SCALARS,
    ),
    _fault(
        "kap_sign",
        "kap has the wrong sign",
        ONE,
        "kap = (m - 1) /",
        "kap = (1 - m) /",
        SCALARS,
    ),
    _fault(
        "kap_numerator",
        "the term 4 kap x (1 + x) in the numerator of the surface response reads 4 kap x",
        ONE,
        "4 * kap * x * (1 + x)",
        "4 * kap * x",
        SCALARS,
    ),
    _fault(
        "thickness_off",
        "the coating is 1 % thicker for the surface response than for the stresses",
        ONE,
        "x = np.minimum(k * h, 400.0)",
        "x = np.minimum(1.01 * k * h, 400.0)",
        SCALARS,
    ),
    _fault(
        "z_from_surface",
        "z counts from the surface where it counts from the top of the layer",
        "semianalytic.frf:_fields",
        "ks = k * (z[:, None] - top)",
        "ks = k * z[:, None]",
        ("sigma_xx", "sigma_zz", "sigma_xz"),
    ),
    _fault(
        "z_from_wrong_interface",
        "the upgoing wave counts from the lowest interface in place of the bottom of its own layer",
        "semianalytic.frf:_fields",
        "kt = k * (top + coatings[layer][2] - z[:, None])",
        "kt = k * (sum(h for _, _, h in coatings) - z[:, None])",
        ("sigma_xx", "sigma_zz", "sigma_xz"),
        FILMS,
    ),
    _fault(
        "thickness_of_the_first",
        "every layer is taken as thick as the first in carrying the reflection up",
        "semianalytic.frf:_amplitudes",
        "x = k * layers[j][2]",
        "x = k * layers[0][2]",
        (*SCALARS, "sigma_xx"),
        FILMS,
    ),
    _fault(
        "prefactor_surface",
        "the part of the surface response that the coating adds is 1 % too large",
        ONE,
        "return th * (",
        "return 1.01 * th * (",
        SCALARS,
    ),
    _fault(
        "prefactor_stress",
        "the response of every stress is 1 % too large below the surface",
        "semianalytic.frf:stress_frf",
        "return _fields(",
        "return 1.01 * _fields(",
        ("sigma_xx", "sigma_zz", "surface tractions", "Hooke's law"),
    ),
    _fault(
        "anti_plane_dropped",
        "friction leaves the anti-plane part out",
        "semianalytic.point_force:stress_below",
        'A, B = response("anti-plane")',
        "A, B = 0 * Lz, 0 * Lz",
        ("sigma_xz", "sigma_yy", "sigma_xx"),
    ),
    _fault(
        "upward_shift_sign",
        "the linear factor of the upgoing wave has the sign of the downgoing one",
        "semianalytic.frf:_propagate",
        "shift = sign * (distance * decay)",
        "shift = distance * decay",
        ("sigma_xx", "sigma_zz", "bonded tractions"),
    ),
    _fault(
        "shear_row",
        "the shear of the upgoing wave takes 2 nu for 1 - 2 nu",
        "semianalytic.frf:_rows_stress",
        "[1, -(1 - 2 * nu)]",
        "[1, -2 * nu]",
        ("sigma_xz", "sigma_xx", "bonded tractions"),
    ),
)
