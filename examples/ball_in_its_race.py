"""Ball of a bearing in its race, bare beside Hertz's closed form, and with DLC on both bodies."""

from pathlib import Path

from verification.cases.case_file import parse_case
from verification.desk.case_wording import case_text
from verification.desk.contact_answer import answer
from verification.sources.exact_sources import hertz

RACE = {"radii": "4.7625 mm, 4.7625 mm", "against": "18.2 mm, -4.9 mm"}
for coatings in ([], ["DLC 2 um"]):
    text = case_text("100Cr6", "500 N", "100Cr6", coatings, on_ball=coatings, **RACE)
    problem = parse_case(text.encode(), Path("race")).problem
    found = answer(problem, "semianalytic", {"estimate_uncertainty": False})
    print("with DLC on both" if coatings else "bare")
    for name in ("half_axis_x", "half_axis_y"):
        print(f"  {name} {1e6 * found.numbers[name][0]:.2f} um")
    print(f"  p0 {found.numbers['peak_pressure'][0] / 1e6:.3f} MPa")
    if not coatings:
        print(f"  Hertz {hertz(problem).peak_pressure / 1e6:.3f} MPa")
    tension = max((at for at in found.extremes if at.quantity == "sigma_1"), key=lambda at: at.value)
    print(f"  largest tension {tension.value / 1e6:.0f} MPa in the {tension.where} of the {tension.body}")
