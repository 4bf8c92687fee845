"""Pressure under a sphere on a stiff coating, beside Hertz's pressure of the bare substrate."""

import matplotlib.pyplot as plt
import numpy as np

import semianalytic

steel = (210e9, 0.3)  # E [Pa], nu
contact = dict(radius=10e-3, load=20.0, substrate=steel)  # a rigid sphere of 10 mm under 20 N
bare = semianalytic.solve(coatings=(), **contact)
coated = semianalytic.solve(coatings=((420e9, 0.25, 70e-6),), **contact)  # E, nu, thickness

print("                    bare       coated")
for name, unit, per in (
    ("peak_pressure", "MPa", 1e-6),
    ("contact_radius", "um", 1e6),
    ("approach", "um", 1e6),
):
    print(f"{name:15}{getattr(bare, name) * per:10.3f}{getattr(coated, name) * per:12.3f} {unit}")

x = np.linspace(-1.1, 1.1, 201) * bare.contact_radius
hertz = bare.peak_pressure * np.sqrt(np.maximum(1 - (x / bare.contact_radius) ** 2, 0))

figure, axes = plt.subplots(figsize=(6, 3.6), layout="constrained")
axes.plot(x * 1e6, hertz / 1e6, "k:", zorder=3, label="Hertz, bare steel")
axes.plot(x * 1e6, bare.pressure(x) / 1e6, label="bare steel")
axes.plot(x * 1e6, coated.pressure(x) / 1e6, label="70 µm of 420 GPa on steel")
axes.set(xlabel="x [µm]", ylabel="pressure [MPa]")
axes.legend(frameon=False)
figure.savefig("pressure_of_a_coated_sphere.png", dpi=120)
