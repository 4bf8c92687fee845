"""Faults in the material: moduli and Poisson ratios."""

from verification.credibility.faults.planting import Edit, Fault

__all__ = ["FAULTS"]

GROUP = "material"
SOLID = ("01_uncoated_steel", "14_ratio_4_sliding")
FILMS = ("15_dlc_chromium_sliding",)

FAULTS = (
    Fault(
        "nu_off_substrate",
        GROUP,
        "the semi-analytical method takes nu of the substrate 0.01 too large",
        "semianalytic",
        (
            Edit(
                "semianalytic.solver:_body",
                "tuple(float(v) for v in substrate)",
                "(float(substrate[0]), float(substrate[1]) + 0.01)",
            ),
        ),
        ("approach", "contact_radius", "sigma_xx"),
        SOLID,
    ),
    Fault(
        "nu_off_coating",
        GROUP,
        "the finite element method takes nu of every coating 0.01 too large",
        "fem_reference",
        (
            Edit(
                "fem_reference.scaling:LayeredSolid.scaled",
                "[nu_k for _, nu_k, _ in coatings]",
                "[nu_k + 0.01 for _, nu_k, _ in coatings]",
            ),
        ),
        ("approach", "sigma_xx", "sigma_yy"),
        SOLID,
    ),
    Fault(
        "moduli_swapped",
        GROUP,
        "the semi-analytical method gives the coating the modulus of the substrate and the other way round",
        "semianalytic",
        (
            Edit(
                "semianalytic.solver:_body",
                "return Body(layers, tuple(float(v) for v in substrate), float(friction))",
                "E = [float(substrate[0]), *(c[0] for c in layers[1:]), layers[0][0] if layers else "
                "float(substrate[0])]; "
                "layers = tuple((e, *c[1:]) for e, c in zip(E, layers)); "
                "return Body(layers, (E[-1], float(substrate[1])), float(friction))",
            ),
        ),
        ("approach", "peak_pressure", "sigma_xx"),
        SOLID,
    ),
    Fault(
        "coatings_swapped",
        GROUP,
        "the finite element method stacks two coatings in the wrong order",
        "fem_reference",
        (
            Edit(
                "fem_reference.scaling:LayeredSolid.scaled",
                "(*zip(moduli, poisson, strict=True), (1.0, nu))",
                "(*list(zip(moduli, poisson, strict=True))[::-1], (1.0, nu))",
            ),
        ),
        ("sigma_xx", "sigma_yy"),
        ("01_uncoated_steel", *FILMS),
    ),
    Fault(
        "plane_stress_scale",
        GROUP,
        "the semi-analytical method takes E for E/(1 - nu^2)",
        "semianalytic",
        (
            Edit(
                "semianalytic.inputs:Body.moduli",
                "material[0] / (1 - material[1] ** 2)",
                "material[0]",
            ),
        ),
        ("approach", "contact_radius", "peak_pressure"),
        SOLID,
    ),
    Fault(
        "plane_stress_hooke",
        GROUP,
        "the finite element method takes Lame's constant of plane stress",
        "fem_reference",
        (
            Edit(
                "fem_reference.axisymmetric:elasticity",
                "2 * G * nu / (1 - 2 * nu)",
                "2 * G * nu / (1 - nu)",
            ),
        ),
        ("approach", "contact_radius", "peak_pressure"),
        SOLID,
    ),
    Fault(
        "young_for_shear_ratio",
        GROUP,
        "the ratio of Young's moduli stands where that of the shear moduli belongs, at every interface",
        "semianalytic",
        (
            Edit(
                "semianalytic.frf:_interface",
                "upper[0] * (1 + lower[1]) / (lower[0] * (1 + upper[1]))",
                "upper[0] / lower[0]",
            ),
        ),
        ("sigma_xx", "sigma_yy", "approach"),
        ("01_uncoated_steel", *FILMS),
    ),
    Fault(
        "nu_of_the_other_layer",
        GROUP,
        "the closed form of the surface response takes nu of the coating for that of the substrate",
        "semianalytic",
        (
            Edit(
                "semianalytic.frf:_one_coating_excess",
                "(1 + m * (3 - 4 * nu2))",
                "(1 + m * (3 - 4 * nu1))",
            ),
        ),
        ("approach", "peak_pressure", "contact_radius"),
        ("01_uncoated_steel", "10_silver_steel"),
    ),
)
