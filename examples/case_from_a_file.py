"""A case file solved by every source, judged claim by claim, from Python."""

import matplotlib.pyplot as plt
import numpy as np

import verification

case = verification.read_case("05_ratio_4")
result = verification.compare(case)
print(f"{case.title}: {result.outcome}")
for source in result.sources:
    print(f"  {source.source:18} {source.seconds:5.1f} s {source.failure or ''}")
agree = sum(verdict.outcome == "AGREES" for _, verdict in result.verdicts)
print(f"  {agree} of {len(result.verdicts)} comparisons agree")

figure, axes = plt.subplots(figsize=(6, 3.6), layout="constrained")
styles = iter(("-", "--", ":"))
for profile in result.profiles:
    if profile.quantity == "sigma_xx" and profile.line == "surface":
        order = np.argsort(profile.position)
        style = next(styles)
        axes.plot(profile.position[order] * 1e6, profile.value[order] / 1e6, style, label=profile.source)
axes.set(xlabel="x [µm]", ylabel=r"$\sigma_{xx}$ on the surface [MPa]", title=case.title)
axes.legend(frameon=False)
figure.savefig("case_from_a_file.png", dpi=120)
