"""Two methods that share no code beside the exact solution: how far apart, and what each states."""

import matplotlib.pyplot as plt
import numpy as np

import fem_reference
import semianalytic
from verification.sources.references import integral_equation

problem = dict(radius=10e-3, load=20.0, coatings=((420e9, 0.25, 70e-6),), substrate=(210e9, 0.3))
exact = integral_equation.solve(**problem)
methods = {
    "semi-analytical": semianalytic.solve(**problem),
    "finite elements": fem_reference.solve(**problem),
}

for quantity in ("peak_pressure", "contact_radius", "approach"):
    true = getattr(exact, quantity)
    for name, found in methods.items():
        error = getattr(found, quantity) / true - 1
        stated = getattr(found.uncertainty, quantity) / true
        print(f"{quantity:15} {name:16} error {error:+.1e}, stated uncertainty {stated:.1e}")

# Next to the edge the pressure rises like a square root: compared at the same share of each radius.
share = np.linspace(0, 0.999, 200)
p = exact.pressure(share * exact.contact_radius)
figure, axes = plt.subplots(figsize=(6, 3.6), layout="constrained")
for name, found in methods.items():
    difference = np.abs(found.pressure(share * found.contact_radius) - p) / exact.peak_pressure
    axes.semilogy(share, np.maximum(difference, 1e-9), label=name)
axes.set(xlabel="r / a", ylabel="|difference from exact| / p0", title="Pressure on 70 µm of 420 GPa on steel")
axes.legend(frameon=False)
figure.savefig("two_methods_and_the_exact_solution.png", dpi=120)
