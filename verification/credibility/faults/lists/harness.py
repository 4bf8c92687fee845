"""Faults in the harness itself: readers, sampling, verdicts, store."""

from verification.credibility.faults.planting import Constant, Edit, faults_of

__all__ = ["FAULTS"]

BARE = ("01_uncoated_steel",)
SOLID = ("01_uncoated_steel", "14_ratio_4_sliding")
KENPAVE = ("kenpave_three_layer_axis",)
METHODS = ("semianalytic", "fem_reference")
JUDGE = "verification.judging.verdict:judge"
fault = faults_of("harness", "harness", BARE)

FAULTS = (
    fault(
        "nan_agrees",
        "NaN counts as agreement",
        ("judging",),
        Edit(JUDGE, "bad = ~np.isfinite(side.value[judged])", "bad = np.zeros(judged.sum(), dtype=bool)"),
    ),
    fault(
        "absolute_for_relative",
        "an absolute uncertainty is read as one relative to the scale",
        ("peak_pressure", "pressure", "judging"),
        Edit(
            "verification.judging.verdict:Comparison.uncertainty",
            "return (self.a.uncertainty + self.b.uncertainty) / self.scale",
            "return self.a.uncertainty + self.b.uncertainty",
        ),
    ),
    fault(
        "relative_for_absolute",
        "the uncertainties of p0, a and approach are multiplied by the value once more",
        ("peak_pressure", "contact_radius", "approach", "sampling"),
        Edit(
            "verification.sampling.lines:sample_contact", "np.array([stated])", "np.array([stated]) * value"
        ),
        solve=("semianalytic", "integral_equation"),
    ),
    fault(
        "u_inflated_in_the_judge",
        "the judge inflates every uncertainty tenfold",
        ("judging",),
        Edit(
            "verification.judging.verdict:Comparison.uncertainty",
            "return (self.a.uncertainty + self.b.uncertainty) / self.scale",
            "return 10 * (self.a.uncertainty + self.b.uncertainty) / self.scale",
        ),
    ),
    fault(
        "u_inflated_semianalytic",
        "the semi-analytical method states ten times the uncertainty of p0, a and approach",
        ("baseline",),
        Edit("semianalytic.uncertainty:Uncertainty._of", "total = {name: sum(", "total = {name: 10 * sum("),
        cases=SOLID,
        solve=("semianalytic",),
    ),
    fault(
        "u_inflated_finite_elements",
        "the finite element method states ten times its uncertainty",
        ("baseline", "sigma_xx", "sigma_zz"),
        Constant("fem_reference.estimate:SAFETY", 30.0),
        cases=SOLID,
        solve=("fem_reference",),
    ),
    fault(
        "u_deflated",
        "the finite element method states a hundredth of its uncertainty",
        ("peak_pressure", "approach", "sigma_xx", "sigma_zz", "pressure"),
        Constant("fem_reference.estimate:SAFETY", 0.03),
        solve=("fem_reference",),
    ),
    fault(
        "cap_ignored",
        "an uncertainty beyond the cap passes",
        ("judging", "whole runs"),
        Edit(JUDGE, "if U.max() > cap:", "if False:"),
    ),
    fault(
        "sign_of_difference",
        "only differences upwards count",
        ("judging",),
        Edit(
            JUDGE,
            "difference = np.abs(comparison.difference[judged])",
            "difference = comparison.difference[judged]",
        ),
    ),
    fault(
        "unstated_for_exact",
        "an uncertainty that was not stated counts as zero",
        ("judging",),
        Edit(JUDGE, "uncertainty = comparison.uncertainty\n", "uncertainty = np.zeros(judged.size)\n"),
    ),
    fault(
        "mean_for_largest",
        "the mean over the points decides in place of the worst of them",
        ("judged points",),
        Edit(JUDGE, "margin = U - difference\n", "margin = U - difference.mean()\n"),
    ),
    fault(
        "source_against_itself",
        "a source is compared with itself",
        ("whole runs",),
        Edit(
            "verification.running.contact:decide",
            "sides.append(profiles[claim.quantity, claim.line, source])",
            "sides.append(profiles[claim.quantity, claim.line, claim.between[0]])",
        ),
    ),
    fault(
        "failure_passes",
        "a source that failed passes",
        ("whole runs",),
        Edit(
            "verification.running.contact:decide",
            "return Verdict(Outcome.NO_RESULT, f",
            "return Verdict(Outcome.AGREES, f",
        ),
    ),
    fault(
        "wide_edge_zone",
        "a quarter of the contact at its edge is excluded from the comparison",
        ("whole runs",),
        Edit(
            "verification.running.contact:decide",
            "np.abs(np.abs(a.position) - edge) < claim.edge * edge",
            "np.abs(np.abs(a.position) - edge) < 5 * claim.edge * edge",
        ),
    ),
    fault(
        "best_for_worst",
        "the outcome of a case is its best verdict",
        ("whole runs",),
        Edit(
            "verification.running.result:CaseResult.outcome",
            "for outcome in (Outcome.DISAGREES, Outcome.NO_RESULT, Outcome.INCONCLUSIVE):",
            "for outcome in (Outcome.AGREES,):",
        ),
    ),
    fault(
        "components_swapped",
        "sigma_xx and sigma_yy of every source are exchanged in sampling",
        ("sampling",),
        Constant(
            "verification.sampling.lines:IN_PLANE",
            {"sigma_xx": (1, 1), "sigma_yy": (0, 0), "sigma_zz": (2, 2), "sigma_xz": (0, 2)},
        ),
        cases=(),
    ),
    fault(
        "sides_swapped",
        "the upper side of an interface is sampled for the lower one, by every source",
        ("sampling",),
        Edit(
            "verification.problem.profile:line_of",
            'k - 1 if match[2] == "upper" else k',
            'k if match[2] == "upper" else k - 1',
        ),
        cases=(),
    ),
    fault(
        "units_slipped_case",
        "thicknesses of a case file in m are read as mm, for every source alike",
        ("case file",),
        Edit(
            "verification.cases.contact:_Coating.in_metres",
            "return self.thickness if",
            "return 1e-3 * self.thickness if",
        ),
        cases=(),
    ),
    fault(
        "units_slipped_load",
        "every method is given the load in kgf for N",
        ("load balance", "peak_pressure", "contact_radius", "approach"),
        Edit(
            "verification.problem.contact:keywords",
            "for f in fields(problem)}",
            "for f in fields(problem)} | {'load': problem.load * 9.80665}",
        ),
        cases=SOLID,
        solve=(*METHODS, "integral_equation"),
    ),
    fault(
        "units_slipped_table",
        "depths of a published table in inches are read as cm",
        ("sigma_zz", "u_z", "printed table"),
        Edit(
            "verification.cases.columns:_points",
            'unit = si_of(at.unit, units, "at")',
            'unit = si_of(at.unit, units, "at") * 0.01 / 0.0254',
        ),
        where="published",
        published=KENPAVE,
        cases=(),
    ),
    fault(
        "stale_cache",
        "a stored result is used again though its case file has changed",
        ("storing",),
        Edit(
            "verification.running.tasks:_of",
            "if (result.name, result.text, result.problem) != "
            "(case.name, case.text, plain(describe(case.problem))):",
            "if False:",
        ),
        cases=(),
    ),
    fault(
        "stale_code",
        "a stored result is used again though the code that made it has changed",
        ("storing",),
        Edit(
            "verification.running.tasks:kept_result", 'if data.get("made_by") != fingerprint():', "if False:"
        ),
        cases=(),
    ),
    fault(
        "checksum_ignored",
        "a stored result is read though its checksum does not hold",
        ("storing",),
        Edit("verification.running.store:read_checked", "if _digest(body) != head[1]:", "if False:"),
        cases=(),
    ),
)
