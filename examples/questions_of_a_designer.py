"""Questions of a coating designer in the words of the command line; run cell by cell it is a notebook."""

# %% What each question is: ball, load, friction, coatings from the surface down, substrate
import matplotlib.pyplot as plt

import verification

STEEL, HSS = "100Cr6, yield 2 GPa", "220 GPa, 0.3, yield 3 GPa"
DLC, TIN = "strength 1 GPa", "strength 3 GPa"
QUESTIONS = {
    "DLC on bearing steel": ("100Cr6 d = 6 mm", "20 N", 0.1, [f"DLC 2 um, {DLC}", "Cr 200 nm"], STEEL),
    "scratch of TiN": ("diamond 200 um", "5 N", 0.1, [f"TiN 2 um, {TIN}"], HSS),
    "mismatch of TiN": ("Si3N4 d = 6 mm", "10 N", 0.2, [f"TiN 2 um, {TIN}, residual -2.2 GPa"], HSS),
    "PTFE": ("100Cr6 d = 6 mm", "5 N", 0.05, ["PTFE 20 um, 0.5 GPa, 0.4, yield 20 MPa"], STEEL),
}

# %% Each answer: in a notebook the last line of a cell shows sentence, table and figure
answers = {}
for name, (ball, load, friction, coatings, substrate) in QUESTIONS.items():
    words = dict(ball=ball, load=load, friction=friction, substrate=substrate, coatings=coatings)
    answers[name] = verification.answer(**words)
    print(f"{name}: {answers[name].verdict}\n")
answers["DLC on bearing steel"]

# %% What governs each of them
figure, axes = plt.subplots(figsize=(8, 2.6), layout="constrained")
for row, found in enumerate(answers.values()):
    worst = max(found.modes, key=lambda mode: mode.utilisation)
    fails = worst.utilisation > 1
    axes.barh(row, worst.utilisation, color="#D55E00" if fails else "#0072B2", hatch="//" if fails else "")
    place = f"{worst.where}: {worst.quantity}".replace("_", " ")
    axes.text(max(worst.utilisation, 1) + 0.03, row, place, va="center", fontsize=8)
axes.axvline(1.0, color="black", linewidth=1)
axes.set_yticks(range(len(answers)), answers)
axes.invert_yaxis()
axes.margins(x=0.25)
axes.set(xlabel="stress over strength, of the mode nearest to its limit")
figure.savefig("questions_of_a_designer.png", dpi=120)
