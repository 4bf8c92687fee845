"""Stress along the depth of a stack of eight layers, TiN and CrN in turn, on a chromium interlayer."""

import matplotlib.pyplot as plt
import numpy as np

import semianalytic

TiN, CrN = (450e9, 0.25, 0.4e-6), (300e9, 0.24, 0.4e-6)
stack = (TiN, CrN) * 4 + ((279e9, 0.21, 0.2e-6),)
found = semianalytic.solve(
    radius=3e-3, load=30.0, coatings=stack, substrate=(210e9, 0.3), friction=0.15, accuracy=None
)
print(f"p0 = {found.peak_pressure / 1e6:.1f} MPa, a = {found.contact_radius * 1e6:.2f} µm")

figure, axes = plt.subplots(figsize=(6, 3.8), layout="constrained")
depth = np.cumsum([0.0, *(layer[2] for layer in stack)])
for layer in range(len(stack) + 1):
    top = depth[layer]
    bottom = depth[layer + 1] if layer < len(stack) else 1.5 * depth[-1]
    z = np.linspace(top, bottom, 12)
    trailing = found.stress(-found.contact_radius, 0.0, z, layer=layer)
    colour = (
        "#0072B2"
        if layer == len(stack) - 1
        else "0.4"
        if layer == len(stack)
        else ("#D55E00", "#009E73")[layer % 2]
    )
    axes.plot(z * 1e6, trailing[0, 0] / 1e6, color=colour)
    axes.axvline(top * 1e6, color="0.85", lw=0.5, zorder=0)
jump = [found.stress(-found.contact_radius, 0.0, depth[1], layer=side)[0, 0] / 1e6 for side in (0, 1)]
print(f"sigma_xx at the first interface: {jump[0]:.0f} MPa in TiN, {jump[1]:.0f} MPa in CrN")
axes.set(xlabel="depth [µm]", ylabel=r"$\sigma_{xx}$ at the trailing edge [MPa]")
axes.set_title("TiN (orange), CrN (green), chromium (blue), steel (grey)", fontsize=9)
figure.savefig("stack_of_many_layers.png", dpi=120)
