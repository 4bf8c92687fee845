"""Faults in the frequency response functions of the layered half-space."""

from verification.credibility.faults.planting import Edit, faults_of

__all__ = ["FAULTS"]

SOLID = ("01_uncoated_steel", "14_ratio_4_sliding")
FILMS = ("01_uncoated_steel", "15_dlc_chromium_sliding")
ONE = "semianalytic.frf:_one_coating_excess"
SCALARS = ("approach", "peak_pressure", "contact_radius")
fault = faults_of("frf", "semianalytic", SOLID)

FAULTS = (
    fault(
        "kap_x2_dropped",
        "the term 4 kap x^2 is dropped from the denominator of the surface response",
        SCALARS,
        Edit(ONE, "(lam + kap + 4 * kap * x**2)", "(lam + kap)"),
    ),
    fault("kap_sign", "kap has the wrong sign", SCALARS, Edit(ONE, "kap = (m - 1) /", "kap = (1 - m) /")),
    fault(
        "kap_numerator",
        "the term 4 kap x (1 + x) in the numerator of the surface response reads 4 kap x",
        SCALARS,
        Edit(ONE, "4 * kap * x * (1 + x)", "4 * kap * x"),
    ),
    fault(
        "thickness_off",
        "the coating is 1 % thicker for the surface response than for the stresses",
        SCALARS,
        Edit(ONE, "x = np.minimum(k * h, 400.0)", "x = np.minimum(1.01 * k * h, 400.0)"),
    ),
    fault(
        "z_from_surface",
        "z counts from the surface where it counts from the top of the layer",
        ("sigma_xx", "sigma_zz", "sigma_xz"),
        Edit("semianalytic.frf:_fields", "ks = k * (z[:, None] - top)", "ks = k * z[:, None]"),
    ),
    fault(
        "z_from_wrong_interface",
        "the upgoing wave counts from the lowest interface in place of the bottom of its own layer",
        ("sigma_xx", "sigma_zz", "sigma_xz"),
        Edit(
            "semianalytic.frf:_fields",
            "kt = k * (top + coatings[layer][2] - z[:, None])",
            "kt = k * (sum(h for _, _, h in coatings) - z[:, None])",
        ),
        cases=FILMS,
    ),
    fault(
        "thickness_of_the_first",
        "every layer is taken as thick as the first in carrying the reflection up",
        (*SCALARS, "sigma_xx"),
        Edit("semianalytic.frf:_amplitudes", "x = k * layers[j][2]", "x = k * layers[0][2]"),
        cases=FILMS,
    ),
    fault(
        "prefactor_surface",
        "the part of the surface response that the coating adds is 1 % too large",
        SCALARS,
        Edit(ONE, "return th * (", "return 1.01 * th * ("),
    ),
    fault(
        "prefactor_stress",
        "the response of every stress is 1 % too large below the surface",
        ("sigma_xx", "sigma_zz", "surface tractions", "Hooke's law"),
        Edit("semianalytic.frf:stress_frf", "return _fields(", "return 1.01 * _fields("),
    ),
    fault(
        "anti_plane_dropped",
        "the anti-plane part of friction is left out",
        ("sigma_xz", "sigma_yy", "sigma_xx"),
        Edit(
            "semianalytic.point_force:stress_below", 'A, B = response("anti-plane")', "A, B = 0 * Lz, 0 * Lz"
        ),
    ),
    fault(
        "upward_shift_sign",
        "the linear factor of the upgoing wave has the sign of the downgoing one",
        ("sigma_xx", "sigma_zz", "bonded tractions"),
        Edit("semianalytic.frf:_propagate", "shift = sign * (distance * decay)", "shift = distance * decay"),
    ),
    fault(
        "shear_row",
        "the shear of the upgoing wave takes 2 nu for 1 - 2 nu",
        ("sigma_xz", "sigma_xx", "bonded tractions"),
        Edit("semianalytic.frf:_rows_stress", "[1, -(1 - 2 * nu)]", "[1, -2 * nu]"),
    ),
)
