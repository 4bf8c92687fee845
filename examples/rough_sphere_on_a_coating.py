"""A rough sphere on a coated body: pressure of patches alone, real area of contact, uncertainty."""

import matplotlib.pyplot as plt
import numpy as np
from scipy.interpolate import RegularGridInterpolator

import semianalytic

R, W, half, n = 5e-3, 5.0, 90e-6, 257
random = np.random.default_rng(1)
k = np.hypot(*np.meshgrid(np.fft.fftfreq(256), np.fft.rfftfreq(256), indexing="ij"))
spectrum = np.where(
    (k > 0.02) & (k < 0.12), np.maximum(k, 1e-9) ** -1.8, 0
)  # self-affine, Hurst exponent 0.8
heights = np.fft.irfft2(spectrum * np.exp(2j * np.pi * random.random(k.shape)), (256, 256))
heights *= 60e-9 / heights.std()
edges = np.linspace(-half, half, 256)
rough = RegularGridInterpolator((edges, edges), heights, method="cubic")


def profile(x, y):
    """Height of the rough sphere above its lowest point [m]."""
    x, y = np.broadcast_arrays(x, y)
    return (x**2 + y**2) / (2 * R) + rough(np.stack([x, y], axis=-1).clip(-half, half))


found = semianalytic.indent(
    profile=profile,
    half_width=half,
    load=W,
    coatings=((300e9, 0.25, 3e-6),),
    substrate=(210e9, 0.3),
    patches=n,
)
x = np.linspace(-half, half, 181)
p = found.pressure(x[:, None], x[None, :])
area = np.mean(p > 0) * (2 * half) ** 2
print(f"p0 = {found.peak_pressure / 1e9:.2f} ± {found.uncertainty.peak_pressure / 1e9:.2f} GPa")
print(f"real area {area * 1e12:.0f} µm², {100 * area / (np.pi * 60e-6**2):.0f} % of a disc of 60 µm")

figure, axes = plt.subplots(figsize=(5.2, 4), layout="constrained")
shown = axes.pcolormesh(x * 1e6, x * 1e6, np.where(p > 0, p, np.nan).T / 1e9)
axes.set(xlabel="x [µm]", ylabel="y [µm]", aspect="equal")
figure.colorbar(shown, label="pressure [GPa]")
figure.savefig("rough_sphere_on_a_coating.png", dpi=120)
