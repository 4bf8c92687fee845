"""Faults in the moduli of the material, with those of Poisson's ratio."""

from verification.credibility.faults.planting import Edit, faults_of

__all__ = ["FAULTS"]

SOLID = ("01_uncoated_steel", "14_ratio_4_sliding")
FILMS = ("15_dlc_chromium_sliding",)
fault = faults_of("material", "semianalytic", SOLID)
fault = faults_of("material", "semianalytic", SOLID)

FAULTS = (
    fault(
        "nu_off_substrate",
        "the semi-analytical method takes nu of the substrate 0.01 too large",
        ("approach", "contact_radius", "sigma_xx"),
        Edit(
            "semianalytic.solver:_body",
            "tuple(float(v) for v in substrate)",
            "(float(substrate[0]), float(substrate[1]) + 0.01)",
        ),
    ),
    fault(
        "nu_off_coating",
        "the finite element method takes nu of every coating 0.01 too large",
        ("approach", "sigma_xx", "sigma_yy"),
        Edit(
            "fem_reference.scaling:LayeredSolid.scaled",
            "[nu_k for _, nu_k, _ in coatings]",
            "[nu_k + 0.01 for _, nu_k, _ in coatings]",
        ),
        where="fem_reference",
    ),
    fault(
        "moduli_swapped",
        "the semi-analytical method gives the coating the modulus of the substrate and the other way round",
        ("approach", "peak_pressure", "sigma_xx"),
        Edit(
            "semianalytic.solver:_body",
            "return Body(layers, tuple(float(v) for v in substrate), float(friction))",
            "E = [float(substrate[0]), *(c[0] for c in layers[1:]), layers[0][0] if layers else "
            "float(substrate[0])]; "
            "layers = tuple((e, *c[1:]) for e, c in zip(E, layers)); "
            "return Body(layers, (E[-1], float(substrate[1])), float(friction))",
        ),
    ),
    fault(
        "coatings_swapped",
        "the finite element method stacks two coatings in the wrong order",
        ("sigma_xx", "sigma_yy"),
        Edit(
            "fem_reference.scaling:LayeredSolid.scaled",
            "(*zip(moduli, poisson, strict=True), (1.0, nu))",
            "(*list(zip(moduli, poisson, strict=True))[::-1], (1.0, nu))",
        ),
        where="fem_reference",
        cases=("01_uncoated_steel", *FILMS),
    ),
    fault(
        "plane_stress_scale",
        "the semi-analytical method takes E for E/(1 - nu^2)",
        ("approach", "contact_radius", "peak_pressure"),
        Edit("semianalytic.inputs:Body.moduli", "material[0] / (1 - material[1] ** 2)", "material[0]"),
    ),
    fault(
        "plane_stress_hooke",
        "the finite element method takes Lame's constant of plane stress",
        ("approach", "contact_radius", "peak_pressure"),
        Edit("fem_reference.axisymmetric:elasticity", "2 * G * nu / (1 - 2 * nu)", "2 * G * nu / (1 - nu)"),
        where="fem_reference",
    ),
    fault(
        "young_for_shear_ratio",
        "the ratio of Young's moduli replaces that of the shear moduli at every interface",
        ("sigma_xx", "sigma_yy", "approach"),
        Edit(
            "semianalytic.frf:_interface",
            "upper[0] * (1 + lower[1]) / (lower[0] * (1 + upper[1]))",
            "upper[0] / lower[0]",
        ),
        cases=("01_uncoated_steel", *FILMS),
    ),
    fault(
        "nu_of_the_other_layer",
        "the closed form of the surface response takes nu of the coating for that of the substrate",
        ("approach", "peak_pressure", "contact_radius"),
        Edit("semianalytic.frf:_one_coating_excess", "(1 + m * (3 - 4 * nu2))", "(1 + m * (3 - 4 * nu1))"),
        cases=("01_uncoated_steel", "10_silver_steel"),
    ),
)
