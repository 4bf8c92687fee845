"""Faults in the stresses below the surface of the semi-analytical method."""

from verification.credibility.faults.planting import Edit, faults_of

__all__ = ["FAULTS"]

SOLID = ("01_uncoated_steel", "14_ratio_4_sliding")
SLIDING = ("13_uncoated_sliding", "14_ratio_4_sliding")
FILMS = ("01_uncoated_steel", "15_dlc_chromium_sliding")
COMBINE = "semianalytic.point_force:_combine_stress"
BELOW = "semianalytic.point_force:stress_below"
fault = faults_of("stress", "semianalytic", SOLID)

FAULTS = (
    fault(
        "shear_sign",
        "sigma_xz of friction has the wrong sign",
        ("sigma_xz",),
        Edit(COMBINE, "xz - (A0 - cos2 * B2) / 2", "xz + (A0 - cos2 * B2) / 2"),
        cases=SLIDING,
    ),
    fault(
        "shear_sign_normal",
        "sigma_xz of the pressure has the wrong sign",
        ("sigma_xz", "equilibrium"),
        Edit(COMBINE, "xz, yz = -c * T, -s * T", "xz, yz = c * T, s * T"),
    ),
    fault(
        "radial_for_hoop",
        "sigma_rr and sigma_theta are exchanged",
        ("sigma_xx", "sigma_yy"),
        Edit(COMBINE, "np.stack([mean + half, mean - half,", "np.stack([mean - half, mean + half,"),
    ),
    fault(
        "bessel_order",
        "the difference of the in-plane stresses is transformed with J1 in place of J2",
        ("sigma_xx", "sigma_yy"),
        Edit(BELOW, "((LL - TT) / 2, 2)", "((LL - TT) / 2, 1)"),
    ),
    fault(
        "bessel_order_friction",
        "the shear of friction is transformed with J1 in place of J2",
        ("sigma_xz",),
        Edit(BELOW, "(Lz - A, 2)", "(Lz - A, 1)"),
        cases=SLIDING,
    ),
    fault(
        "depth_off_by_a_patch",
        "stresses are those of a depth one patch too large",
        ("sigma_xx", "sigma_zz", "bonded tractions", "equilibrium"),
        Edit(
            "semianalytic.fields:stress",
            "np.broadcast_arrays(x, y, z, body.layer_of(z, layer))",
            "np.broadcast_arrays(x, y, np.asarray(z) + grid.d, body.layer_of(z, layer))",
        ),
    ),
    fault(
        "friction_backwards",
        "friction drags the solid in -x",
        ("sigma_xx", "sigma_xz"),
        Edit("semianalytic.solver:_body", "float(friction)", "-float(friction)"),
        Edit("semianalytic.solution:Solution.with_friction", "float(friction)", "-float(friction)"),
        cases=SLIDING,
    ),
    fault(
        "third_harmonic_dropped",
        "friction leaves the third harmonic of the in-plane stresses out",
        ("sigma_xx", "sigma_yy"),
        Edit(COMBINE, "half = half - (c * E1 - cos3 * G3) / 2", "half = half - c * E1 / 2"),
        cases=SLIDING,
    ),
    fault(
        "nu_of_the_substrate",
        "stresses near the surface take nu of the substrate for that of the coating",
        ("sigma_xx", "sigma_yy"),
        Edit("semianalytic.subsurface:_stress_response", "body.materials[0][1:2]", "body.materials[-1][-1:]"),
        cases=FILMS,
    ),
)
