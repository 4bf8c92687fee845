"""Tension at the trailing edge of a sliding sphere, bare and coated, for several coefficients of friction."""

import matplotlib.pyplot as plt
import numpy as np

import semianalytic

substrate, film = (210e9, 0.3), (420e9, 0.25, 5e-6)
contact = dict(radius=10e-3, load=20.0, substrate=substrate)
solutions = {
    "bare": semianalytic.solve(coatings=(), **contact),
    "coated": semianalytic.solve(coatings=(film,), **contact),
}

figure, panels = plt.subplots(1, 2, figsize=(8, 3.4), sharey=True, layout="constrained")
for axes, (name, pressed) in zip(panels, solutions.items(), strict=True):
    a, p0 = pressed.contact_radius, pressed.peak_pressure
    x = np.linspace(-2, 2, 161) * a
    for friction in (0.0, 0.1, 0.25):
        sliding = pressed.with_friction(friction)  # friction leaves the pressure as it is
        axes.plot(x / a, sliding.stress(x, 0.0, 0.0, layer=0)[0, 0] / 1e6, label=f"f = {friction:g}")
        tension = sliding.stress(-a, 0.0, 0.0, layer=0)[0, 0]
        if name == "bare":  # closed form of the homogeneous solid
            closed = p0 * ((1 - 2 * 0.3) / 3 + (4 + 0.3) * np.pi * friction / 8)
            print(f"f = {friction:4g}: {tension / 1e6:8.2f} MPa, closed form {closed / 1e6:8.2f} MPa")
        else:
            print(f"f = {friction:4g}: {tension / 1e6:8.2f} MPa in the coating")
    axes.set(xlabel="x / a", title=f"{name} steel")
panels[0].set_ylabel(r"$\sigma_{xx}$ on the surface [MPa]")
panels[1].legend(frameon=False)
figure.savefig("tension_behind_a_sliding_ball.png", dpi=120)
