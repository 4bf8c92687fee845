"""Faults in the references and in the reading of printed tables."""

from verification.credibility.faults.planting import Edit, Fault

__all__ = ["FAULTS"]

GROUP = "references"
SOLID = ("01_uncoated_steel", "14_ratio_4_sliding")
BARE = ("01_uncoated_steel",)
SLIDING = ("13_uncoated_sliding", "14_ratio_4_sliding")
KENPAVE = ("kenpave_three_layer_axis",)
SCALARS = ("approach", "peak_pressure", "contact_radius", "pressure")


def _fault(
    name: str,
    where: str,
    sentence: str,
    expected: tuple[str, ...],
    change: Edit,
    cases: tuple[str, ...] = BARE,
) -> Fault:
    return Fault(name, GROUP, sentence, where, (change,), expected, cases)


FAULTS = (
    _fault(
        "hertz_exponent",
        "hertz",
        "Hertz's contact radius takes the square root where it takes the cube root",
        SCALARS,
        Edit("verification.sources.references.hertz:HertzContact.contact_radius", "** (1 / 3)", "** (1 / 2)"),
    ),
    _fault(
        "mean_for_peak",
        "hertz",
        "Hertz's peak pressure is the mean pressure",
        ("peak_pressure", "pressure", "sigma_zz"),
        Edit(
            "verification.sources.references.hertz:HertzContact.peak_pressure",
            "3 * self.load / (2 *",
            "self.load / (1 *",
        ),
    ),
    _fault(
        "huber_sign",
        "hertz",
        "the term (1 - 2 nu)/3 of Huber's hoop stress has the wrong sign",
        ("sigma_xx", "sigma_yy"),
        Edit(
            "verification.sources.references.hertz:Hertz.stress",
            "hoop = -(1 - 2 * nu) / 3 * ring",
            "hoop = (1 - 2 * nu) / 3 * ring",
        ),
    ),
    _fault(
        "hamilton_third_harmonic",
        "hamilton",
        "the third harmonic of the sliding field takes nu for nu/2",
        ("sigma_xx", "sigma_yy"),
        Edit(
            "verification.sources.references.hamilton:Hamilton.stress_of_traction",
            "third = nu / 2 * A3",
            "third = nu * A3",
        ),
        SLIDING[:1],
    ),
    _fault(
        "hamilton_branch",
        "hamilton",
        "the root of the sliding field is taken on the other sheet outside the contact",
        ("sigma_xx", "sigma_xz", "sigma_zz"),
        Edit(
            "verification.sources.references.hamilton:_root",
            "larger - 1j * smaller, smaller",
            "larger + 1j * smaller, smaller",
        ),
        SLIDING[:1],
    ),
    _fault(
        "kernel_halved",
        "integral_equation",
        "the kernel of the integral equation lacks a factor of two",
        SCALARS,
        Edit(
            "verification.sources.references.integral_equation:_solve",
            "K = (2 / np.pi) *",
            "K = (1 / np.pi) *",
        ),
        SOLID,
    ),
    _fault(
        "hertz_approach_for_all",
        "integral_equation",
        "the approach of the integral equation is Hertz's a^2/R whatever the coating",
        ("approach", "pressure", "peak_pressure"),
        Edit(
            "verification.sources.references.integral_equation:_solve",
            "return phi @ np.array([delta, -1.0]), float(delta)",
            "return phi @ np.array([delta, -1.0]), float(a**2 / radius)",
        ),
        SOLID,
    ),
    _fault(
        "state_matrix_poisson",
        "integral_equation",
        "the state matrix of a layer takes 1 - nu for 1 - 2 nu",
        (*SCALARS, "sigma_xx"),
        Edit("verification.sources.references.layered:_in_plane", "(1 - 2 * nu) * c / g", "(1 - nu) * c / g"),
        SOLID,
    ),
    _fault(
        "anti_plane_sign",
        "integral_equation",
        "the anti-plane part of friction enters the exact field with the wrong sign",
        ("sigma_xz",),
        Edit(
            "verification.sources.references.hankel:_sliding",
            "difference = (weighted * (A.T - B.t))",
            "difference = (weighted * (A.T + B.t))",
        ),
        SLIDING,
    ),
    _fault(
        "cerruti_surface",
        "integral_equation",
        "the exact sliding stress on the surface takes 4 - nu for 4 + nu",
        ("sigma_xx",),
        Edit(
            "verification.sources.references.hankel:HankelField._homogeneous_surface",
            "(4 + nu) / 2 * q1",
            "(4 - nu) / 2 * q1",
        ),
        SLIDING,
    ),
    Fault(
        "table_column_swapped",
        GROUP,
        "two columns of a printed table are read for each other",
        "published",
        (
            Edit(
                "verification.cases.table:PublishedTable.text",
                "number = self.columns.index(column)",
                "swapped = {'Vertical_Stress': 'Radial_stress', 'Radial_stress': 'Vertical_Stress'}; "
                "number = self.columns.index(swapped.get(column, column))",
            ),
        ),
        ("sigma_zz", "sigma_xx", "printed table"),
        published=KENPAVE,
    ),
    Fault(
        "compressive_sign_kept",
        GROUP,
        "a printed compression keeps the positive sign of its source",
        "published",
        (
            Edit(
                "verification.cases.columns:columns_of",
                "to_si = column.factor *",
                "to_si = abs(column.factor) *",
            ),
        ),
        ("sigma_zz", "sigma_xx", "printed table"),
        published=KENPAVE,
    ),
    Fault(
        "misprints_counted",
        GROUP,
        "cells known to be misprints are counted",
        "published",
        (
            Edit(
                "verification.cases.columns:PublishedColumn.counted",
                "np.array([not why for why in self.why_not])",
                "np.ones(len(self.why_not), dtype=bool)",
            ),
        ),
        ("sigma_kk",),
        published=("ahlvin_ulery_1962",),
    ),
)
