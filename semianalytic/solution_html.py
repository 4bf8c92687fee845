"""A solution in a notebook: sentence, table of its numbers, pressure along x."""

from typing import Any

import numpy as np

ROWS = (("peak_pressure", "peak pressure [MPa]", 1e6), ("contact_radius", "contact radius [µm]", 1e-6))
PICTURE = (
    '<svg width="420" height="150" role="img" aria-label="pressure"><path d="M10 130H410M210 130V20" '
    'stroke="#999"/><polyline fill="none" stroke="#0072B2" stroke-width="2" points="{}"/><text x="214" y="16"'
    ' font-size="12">p = {:.4g} MPa</text><text x="330" y="146" font-size="12">a = {:.4g} µm</text></svg>'
)


def shown(found: Any) -> str:
    """Numbers of a solution with their uncertainty, and the pressure out to 1.3 contact radii, as HTML."""
    p0, a = found.peak_pressure, found.contact_radius
    cells = ""
    for name, label, unit in (*ROWS, ("approach", "approach [µm]", 1e-6)):
        U = f"{getattr(found.uncertainty, name) / unit:.0e}" if found.uncertainty else "-"
        cells += f"<tr><td>{label}</td><td>{getattr(found, name) / unit:.6g}</td><td>{U}</td></tr>"
    x = np.linspace(-1.3, 1.3, 131)
    p = found.pressure(a * x) / p0
    points = " ".join(f"{210 + 150 * s:.1f},{130 - 105 * q:.1f}" for s, q in zip(x, p, strict=True))
    return (
        f"<p>Semi-analytical contact: {found.diagnostics.load:.4g} N on {found.diagnostics.patches} patches, "
        f"solved in {found.diagnostics.seconds:.1f} s.</p><table><tr><th></th><th>value</th><th>±</th></tr>"
        f"{cells}</table>{PICTURE.format(points, p0 / 1e6, a / 1e-6)}"
    )
