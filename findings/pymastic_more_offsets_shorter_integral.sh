#!/usr/bin/env bash
# PyMastic be301be, numpy 2.4.6, scipy 1.17.1: the response at one offset depends on the other offsets of the call.
# Guess: each offset has its own integral, so that a call with many offsets gives what calls with one give.
# Seen: below the axis of three layers, sigma_z at z = 3 is 83.98 asked alone and 81.74 among 21 offsets, sigma_r
# 55.15 and 52.84: the argument iteration (default 25) counts the zeros of Bessel functions of all offsets
# together, so more of them end the integral at a smaller wavenumber.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet numpy==2.4.6 scipy==1.17.1
git clone --quiet https://github.com/Mostafa-Nakhaei/PyMastic "$folder/code"
git -C "$folder/code" checkout --quiet be301be2fa996495b753966b86fd440a0c618cd2
cd "$folder/code"
"$folder/venv/bin/python" - <<'PYTHON'
from Main.MLE import PyMastic


def at_the_axis(offsets):
    found = PyMastic(100.0, 6.0, offsets, [3.0], [10, 6], [500, 40, 10], [0.35, 0.4, 0.45])
    return found["Stress_Z"][0, 0], found["Stress_R"][0, 0]


alone, among = at_the_axis([0.0]), at_the_axis([float(r) for r in range(21)])
print("alone", alone, "among 21 offsets", among)
raise SystemExit(not (abs(among[0] / alone[0] - 1) > 0.02 and abs(among[1] / alone[1] - 1) > 0.03))
PYTHON
