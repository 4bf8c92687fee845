"""The script of FreeFEM filled in: borders of the layers, moduli by depth."""

from itertools import pairwise
from pathlib import Path

MODEL = Path(__file__).with_name("model.edp").read_text()


def script(depths, layers, size):
    """The model with its borders: 1 the disc, 2 the far ends, 3 the axis, 0 the rest."""
    far = depths[-1]
    lines = [(0, -a, 0, -b, 3) for a, b in pairwise(depths)]
    lines += [(0, -far, far, -far, 2)]
    lines += [(far, -b, far, -a, 2) for a, b in zip(depths[-2::-1], depths[:0:-1], strict=True)]
    lines += [(far, 0, 1, 0, 0), (1, 0, 0, 0, 1), *((0, -z, far, -z, 0) for z in depths[1:-1])]
    given = {
        "size": size,
        "sum": " + ".join(f"b{k}({4 if line[4] == 1 else 20})" for k, line in enumerate(lines)),
    }
    form = "border b{}(t = 0, 1) {{x = {} + t * ({}); y = {} + t * ({}); label = {};}}"
    given["borders"] = "\n".join(
        form.format(k, x, u - x, y, v - y, label) for k, (x, y, u, v, label) in enumerate(lines)
    )
    for i, name in enumerate(("E", "nu")):
        given[name] = repr(layers[-1][i])
        for depth, layer in zip(depths[-2:0:-1], layers[-2::-1], strict=True):
            given[name] = f"(-y < {depth!r} ? {layer[i]!r} : {given[name]})"
    return MODEL % given
