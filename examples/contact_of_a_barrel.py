"""Elliptical contact of a barrel on a flat, bare beside Hertz's closed form, and coated."""

import matplotlib.pyplot as plt
import numpy as np

import semianalytic
from verification.sources.references.hertz_ellipse import pressed_ellipsoid

radii, load, steel = (5e-3, 15e-3), 50.0, (210e9, 0.3)
common = dict(
    radius=float(np.sqrt(np.prod(radii))), load=load, substrate=steel, indenter=("ellipsoid", radii)
)
bare = semianalytic.solve(coatings=(), **common)
coated = semianalytic.solve(coatings=((420e9, 0.25, 20e-6),), **common)
closed = pressed_ellipsoid(*radii, load, *steel)
print(f"p0 of the bare barrel {bare.peak_pressure / 1e6:.3f} MPa, Hertz {closed.peak_pressure / 1e6:.3f} MPa")
print(f"p0 on 20 µm of 420 GPa {coated.peak_pressure / 1e6:.1f} MPa")

y = np.linspace(-1.2, 1.2, 121) * 1.9 * bare.contact_radius
x = 0.6 * y
figure, panels = plt.subplots(1, 2, figsize=(7.5, 3.6), sharey=True, layout="constrained")
for axes, (name, found) in zip(panels, {"bare": bare, "coated": coated}.items(), strict=True):
    p = found.pressure(x[:, None], y[None, :]) / 1e6
    shown = axes.contourf(x * 1e6, y * 1e6, p.T, levels=np.linspace(0, coated.peak_pressure / 1e6, 13))
    axes.set(title=name, xlabel="x [µm]", aspect="equal")
panels[0].set_ylabel("y [µm]")
figure.colorbar(shown, ax=panels, label="pressure [MPa]")
figure.savefig("contact_of_a_barrel.png", dpi=120)
