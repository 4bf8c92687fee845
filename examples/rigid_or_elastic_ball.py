"""What it costs to replace an elastic ball by a rigid one with a combined modulus, under a coating."""

import matplotlib.pyplot as plt
import numpy as np

import semianalytic

E, nu, R, W = 210e9, 0.3, 10e-3, 20.0
combined = 1 / (2 * (1 - nu**2) / E)  # E* of steel on steel
ratios = np.array([0.25, 0.5, 1.0, 2.0, 4.0])
error = []
for ratio in ratios:
    film = (ratio * E, nu, 50e-6)
    right = semianalytic.solve(
        radius=R, load=W, coatings=(film,), substrate=(E, nu), ball=(E, nu, ()), patches=129
    )
    # the usual shortcut: a rigid ball, all moduli of the flat scaled so that the substrate has E* of the pair
    scale = combined * (1 - nu**2) / E
    usual = semianalytic.solve(
        radius=R, load=W, coatings=((ratio * E * scale, nu, 50e-6),), substrate=(E * scale, nu), patches=129
    )
    error.append(usual.peak_pressure / right.peak_pressure - 1)
    print(f"E1/E2 = {ratio:4g}: p0 {right.peak_pressure / 1e6:7.1f} MPa, shortcut {100 * error[-1]:+5.1f} %")

figure, axes = plt.subplots(figsize=(6, 3.4), layout="constrained")
axes.semilogx(ratios, 100 * np.array(error), "o-", base=2)
axes.axhline(0, color="0.6", lw=0.8)
axes.set(xlabel="$E_1 / E_2$ of a coating of 50 µm", ylabel="error of p0 by the shortcut [%]")
figure.savefig("rigid_or_elastic_ball.png", dpi=120)
