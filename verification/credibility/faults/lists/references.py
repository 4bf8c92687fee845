"""Faults in the references, with those of the reader of published tables."""

from verification.credibility.faults.planting import Edit, faults_of

__all__ = ["FAULTS"]

SOLID = ("01_uncoated_steel", "14_ratio_4_sliding")
BARE = ("01_uncoated_steel",)
SLIDING = ("13_uncoated_sliding", "14_ratio_4_sliding")
KENPAVE = ("kenpave_three_layer_axis",)
SCALARS = ("approach", "peak_pressure", "contact_radius", "pressure")
fault = faults_of("references", "integral_equation", BARE)

FAULTS = (
    fault(
        "hertz_exponent",
        "Hertz's contact radius takes the square root where it takes the cube root",
        SCALARS,
        Edit("verification.sources.references.hertz:HertzContact.contact_radius", "** (1 / 3)", "** (1 / 2)"),
        where="hertz",
    ),
    fault(
        "mean_for_peak",
        "Hertz's peak pressure is the mean pressure",
        ("peak_pressure", "pressure", "sigma_zz"),
        Edit(
            "verification.sources.references.hertz:HertzContact.peak_pressure",
            "3 * self.load / (2 *",
            "self.load / (1 *",
        ),
        where="hertz",
    ),
    fault(
        "huber_sign",
        "the term (1 - 2 nu)/3 of Huber's hoop stress has the wrong sign",
        ("sigma_xx", "sigma_yy"),
        Edit(
            "verification.sources.references.hertz:Hertz.stress",
            "hoop = -(1 - 2 * nu) / 3 * ring",
            "hoop = (1 - 2 * nu) / 3 * ring",
        ),
        where="hertz",
    ),
    fault(
        "hamilton_third_harmonic",
        "the third harmonic of the sliding field takes nu for nu/2",
        ("sigma_xx", "sigma_yy"),
        Edit(
            "verification.sources.references.hamilton:Hamilton.stress_of_traction",
            "third = nu / 2 * A3",
            "third = nu * A3",
        ),
        where="hamilton",
        cases=SLIDING[:1],
    ),
    fault(
        "hamilton_branch",
        "the root of the sliding field is taken on the other sheet outside the contact",
        ("sigma_xx", "sigma_xz", "sigma_zz"),
        Edit(
            "verification.sources.references.hamilton:_root",
            "larger - 1j * smaller, smaller",
            "larger + 1j * smaller, smaller",
        ),
        where="hamilton",
        cases=SLIDING[:1],
    ),
    fault(
        "kernel_halved",
        "the kernel of the integral equation lacks a factor of two",
        SCALARS,
        Edit(
            "verification.sources.references.integral_equation:_solve",
            "K = (2 / np.pi) *",
            "K = (1 / np.pi) *",
        ),
        cases=SOLID,
    ),
    fault(
        "hertz_approach_for_all",
        "the approach of the integral equation is Hertz's a^2/R whatever the coating",
        ("approach", "pressure", "peak_pressure"),
        Edit(
            "verification.sources.references.integral_equation:_solve",
            "return phi @ np.array([delta, -1.0]), float(delta)",
            "return phi @ np.array([delta, -1.0]), float(a**2 / radius)",
        ),
        cases=SOLID,
    ),
    fault(
        "state_matrix_poisson",
        "the state matrix of a layer takes 1 - nu for 1 - 2 nu",
        (*SCALARS, "sigma_xx"),
        Edit("verification.sources.references.layered:_in_plane", "(1 - 2 * nu) * c / g", "(1 - nu) * c / g"),
        cases=SOLID,
    ),
    fault(
        "anti_plane_sign",
        "the anti-plane part of friction enters the exact field with the wrong sign",
        ("sigma_xz",),
        Edit(
            "verification.sources.references.hankel:_sliding",
            "difference = (weighted * (A.T - B.t))",
            "difference = (weighted * (A.T + B.t))",
        ),
        cases=SLIDING,
    ),
    fault(
        "cerruti_surface",
        "the exact sliding stress on the surface takes 4 - nu for 4 + nu",
        ("sigma_xx",),
        Edit(
            "verification.sources.references.hankel:HankelField._homogeneous_surface",
            "(4 + nu) / 2 * q1",
            "(4 - nu) / 2 * q1",
        ),
        cases=SLIDING,
    ),
    fault(
        "table_column_swapped",
        "two columns of a published table are exchanged",
        ("sigma_zz", "sigma_xx", "printed table"),
        Edit(
            "verification.cases.table:PublishedTable.text",
            "number = self.columns.index(column)",
            "swapped = {'Vertical_Stress': 'Radial_stress', 'Radial_stress': 'Vertical_Stress'}; "
            "number = self.columns.index(swapped.get(column, column))",
        ),
        where="published",
        published=KENPAVE,
        cases=(),
    ),
    fault(
        "compressive_sign_kept",
        "a published compression keeps the positive sign of its source",
        ("sigma_zz", "sigma_xx", "printed table"),
        Edit(
            "verification.cases.columns:columns_of", "to_si = column.factor *", "to_si = abs(column.factor) *"
        ),
        where="published",
        published=KENPAVE,
        cases=(),
    ),
    fault(
        "misprints_counted",
        "cells known to be misprints are counted",
        ("sigma_kk",),
        Edit(
            "verification.cases.columns:PublishedColumn.counted",
            "np.array([not why for why in self.why_not])",
            "np.ones(len(self.why_not), dtype=bool)",
        ),
        where="published",
        published=("ahlvin_ulery_1962",),
        cases=(),
    ),
)
