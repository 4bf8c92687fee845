"""Ball of a bearing in its race, bare beside Hertz's closed form, and with DLC on both bodies."""

from pathlib import Path

import matplotlib.pyplot as plt

from verification.cases.case_file import parse_case
from verification.desk.case_wording import case_text
from verification.desk.contact_answer import answer
from verification.sources.exact_sources import hertz

RACE = {"radii": "4.7625 mm, 4.7625 mm", "against": "18.2 mm, -5.2 mm"}
figure, axes = plt.subplots(figsize=(6, 3.6), layout="constrained")
for name, coatings in {"bare": [], "DLC on both": ["DLC 4 um"]}.items():
    text = case_text("100Cr6", "200 N", "100Cr6", coatings, on_ball=coatings, **RACE)
    problem = parse_case(text.encode(), Path("race")).problem
    found = answer(problem, "semianalytic", {"estimate_uncertainty": False})
    p0, *sizes = (found.numbers[key][0] for key in ("peak_pressure", "half_axis_x", "half_axis_y"))
    closed = "" if coatings else f", Hertz {hertz(problem).peak_pressure / 1e6:.3f} MPa"
    half_axes = " and ".join(f"{1e6 * size:.2f} µm" for size in sizes)
    print(f"{name}: half axes {half_axes}, p0 {p0 / 1e6:.3f} MPa{closed}")
    surface = found.courses[0]
    axes.plot(surface.x * 1e6, surface.stress[0] / 1e6, label=name)
axes.set(xlabel="x along the rolling direction [µm]", ylabel=r"$\sigma_{xx}$ on the race [MPa]")
axes.legend()
figure.savefig("ball_in_its_race.png", dpi=120)
