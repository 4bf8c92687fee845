"""A formula of one's own beside exact values: Gao's weight for the modulus of a coated body."""

import matplotlib.pyplot as plt
import numpy as np

from verification.sources.references.flat_punch import pressed

nu = 0.3
ratios, share = (0.1, 0.5, 2.0, 10.0), np.geomspace(0.05, 5, 25)  # E1/E2; contact radius over thickness


def gao(x, nu):
    """Weight of the coating at thickness over contact radius x (Gao, Chiu and Lee, 1992)."""
    tail = (1 - 2 * nu) * x * np.log((1 + x**2) / x**2) - x / (1 + x**2)
    return 2 / np.pi * np.arctan(x) + tail / (2 * np.pi * (1 - nu))


figure, axes = plt.subplots(figsize=(6, 3.6), layout="constrained")
for ratio in ratios:
    # stiffness of a flat punch over that on a body of the coating's material, exact
    kappa = np.array([pressed(a, ((ratio, nu, 1.0),), (1.0, nu)).kappa for a in share])
    weight = gao(1 / share, nu)
    formula = (weight * ratio + 1 - weight) / ratio
    error = formula / kappa - 1
    print(
        f"E1/E2 = {ratio:4g}: Gao's weight is off by {100 * error.min():+6.1f} to {100 * error.max():+5.1f} %"
    )
    axes.semilogx(share, 100 * error, label=f"$E_1/E_2$ = {ratio:g}")
axes.axhline(0, color="0.6", lw=0.8)
axes.set(xlabel="a / t", ylabel="error of the stiffness [%]", ylim=(-10, 190))
axes.legend(frameon=False)
figure.savefig("own_formula_on_trial.png", dpi=120)
