"""Largest tension at the surface and at the base of a hard coating against its thickness."""

import matplotlib.pyplot as plt
import numpy as np

import semianalytic

thickness = np.geomspace(1e-6, 100e-6, 13)
surface, base = [], []
for h in thickness:
    found = semianalytic.solve(
        radius=10e-3,
        load=20.0,
        coatings=((420e9, 0.25, h),),
        substrate=(210e9, 0.3),
        friction=0.1,
        accuracy=None,
    )
    x = np.linspace(-1.3, 1.3, 81) * found.contact_radius
    surface.append(found.stress(x, 0.0, 0.0, layer=0)[0, 0].max())
    base.append(found.stress(x, 0.0, h, layer=0)[0, 0].max())  # layer 0: the coating's side of the interface

worst = np.maximum(surface, base)
best = int(np.argmin(worst))
print(f"least tension of those tried: {worst[best] / 1e6:.0f} MPa at h = {thickness[best] * 1e6:.2g} µm")

figure, axes = plt.subplots(figsize=(6, 3.6), layout="constrained")
axes.semilogx(thickness * 1e6, np.array(surface) / 1e6, "o-", label="surface, cracks behind the contact")
axes.semilogx(thickness * 1e6, np.array(base) / 1e6, "s--", label="base, cracks below the contact")
axes.axvline(thickness[best] * 1e6, color="0.6", lw=0.8, label="least tension of those tried")
axes.set(xlabel="thickness [µm]", ylabel=r"largest $\sigma_{xx}$ in the coating [MPa]", ylim=(-150, 950))
axes.legend(frameon=False, loc="upper left")
figure.savefig("which_thickness_to_prefer.png", dpi=120)
