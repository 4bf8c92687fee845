"""Values that follow from a report.json, by formulas of their own and the standard library alone."""

from collections import Counter
from fractions import Fraction
from itertools import pairwise
from math import atan, hypot, inf, log, pi, sqrt
from statistics import fmean, median

METHODS = ("semianalytic", "fem_reference")
PLACES = (*METHODS, "harness", "references")
SCALARS = ("peak_pressure", "contact_radius", "approach", "stiffness")
ERRORS = ("p0", "a", "approach", "pressure", "stress")
KINDS = {
    "comparison": ("bare", "coated"),
    "invariant": ("inv",),
    "study": ("stu",),
    "other": ("pub", "self", "man"),
}
CAUGHT = ("caught", "inconclusive", "baseline")


class Record(dict):
    """An object of the JSON, with its names as attributes too; None where it has no such name."""

    __getattr__ = dict.get

    def of(self, *names):
        """The items of these names."""
        return [self.get(name) for name in names]


def group(items, key):
    """Lists of the items of each key, in their order."""
    found = {}
    for one in items:
        found.setdefault(key(one), []).append(one)
    return found


def agree(items):
    """How many items agree, and how many there are."""
    return [sum(one.outcome == "AGREES" for one in items), len(items)]


def largest(items, name):
    """The largest of their numbers of that name."""
    return max(one[name] for one in items)


def shares(laws):
    """Residuals of invariants over their bounds."""
    return [law.value / law.bound for law in laws]


def compared(case):
    """Claim and verdict of each comparison of a case, in one record."""
    return [Record(one.claim | one.verdict | {"case": case}) for one in case.verdicts]


def costs_of(model):
    """Sizes of the costs of assumptions, their uncertainties included."""
    return [abs(cost.change) + cost.uncertainty for cost in model.costs]


def pictures(data, case):
    """Ranges of stresses of the semi-analytical method below a contact, differences of both, over p_h."""
    drawn = []
    for layers in data.shown.planes[case.name].stress.of(*METHODS):
        xx, yy, zz, xz = ([v for layer in layers for row in layer[k] for v in row] for k in range(4))
        parts = zip(xx, yy, zz, xz, strict=True)
        mises = [sqrt(((a - b) ** 2 + (b - c) ** 2 + (c - a) ** 2) / 2 + 3 * d**2) for a, b, c, d in parts]
        drawn.append((mises, xx, xz, yy, zz))
    gaps = [max(abs(a - b) for a, b in zip(*both, strict=True)) for both in zip(*drawn, strict=True)]
    return [value / case.problem.p_h for value in (*map(min, drawn[0]), *map(max, drawn[0]), *gaps)]


def accuracies(case):
    """Error of each method, U there, smallest U over error, of each quantity with an exact counterpart."""
    by = {(p.source, p.quantity, p.line): p for p in case.profiles}
    exact = next((one.source for one in reversed(case.sources) if one.source not in METHODS), None)
    claims = {(one.quantity, one.line): one for one in compared(case)}
    for method, ((quantity, line), claim) in ((name, claim) for name in METHODS for claim in claims.items()):
        parts = by.get((method, quantity, line)), by.get((exact, quantity, line))
        if all(parts) and parts[0].position == parts[1].position:
            scale = claim.judged.scale
            errors = [abs(a - b) / scale for a, b in zip(*(p.value for p in parts), strict=True)]
            U = [sum(both) / scale for both in zip(*(p.uncertainty for p in parts), strict=True)]
            ratio = min((u / error for u, error in zip(U, errors, strict=True) if error), default=inf)
            names = {"method": method, "quantity": quantity, "line": line, "title": case.title}
            yield Record(names, worst=max(zip(errors, U, strict=True)), ratio=ratio)


def width(bound):
    """Width of an enclosure over its middle."""
    low, high = Fraction(bound.lower), Fraction(bound.upper)
    return float(2 * (high - low) / abs(low + high))


def covered(known):
    """Row of errors beside U: how many within it, the worst with its place, the median, the largest error."""
    worst, within = min(known, key=lambda one: one.ratio), sum(one.ratio >= 1 for one in known)
    middle = median(one.ratio for one in known if one.ratio < inf)
    place = worst.of("quantity", "line", "title")
    return [
        within,
        len(known),
        within / len(known),
        1 / worst.ratio,
        place,
        middle,
        largest(known, "worst")[0],
    ]


def noticed(row):
    """The first kind of check that notices a planted fault."""
    seen = [name for name, one in row.columns.items() if one.disagree or one.inconclusive]
    found = [kind for kind, starts in KINDS.items() if any(name.startswith(starts) for name in seen)]
    found += ["stopped"] * any(one.no_result for one in row.columns.values()) + ["harmless"] * row.equivalent
    return [*found, *seen, "nothing"][0]


def coated_alone(row):
    """Whether comparisons of coated cases alone notice a planted fault."""
    bare = [one for name, one in row.columns.items() if name.startswith("bare")]
    passed = not any(one.disagree or one.inconclusive or one.no_result for one in bare)
    return bool(bare) and passed and noticed(row) == "comparison"


def tally(rows):
    """Row of planted faults: all, what notices them first, those detected of all, those as predicted."""
    kinds = Counter(map(noticed, rows))
    first = [kinds[kind] for kind in (*KINDS, "stopped", "harmless", "baseline", "nothing")]
    caught = sum(row.catch in CAUGHT for row in rows)
    return [len(rows), first, caught, len(rows), sum(row.as_predicted for row in rows)]


def scores(rows):
    """Faults that a comparison, an invariant or a study notices, the harmless ones apart; all, by place."""
    for of in group(rows, lambda row: row.where if row.where in PLACES else "references").values():
        kinds = Counter(map(noticed, of))
        yield [sum(kinds[kind] for kind in [*KINDS][:3]), len(of) - kinds["harmless"], len(of)]


def fault(row):
    """Row of a planted fault: its texts, the checks that do not pass of those made, its change."""
    counts = [
        [n for n in one.of("disagree", "inconclusive", "no_result") if n] for one in row.columns.values()
    ]
    seen = [[of, one.made] for of, one in zip(counts, row.columns.values(), strict=True) if of]
    return [row.name, row.description, seen, row.change]


def levels(data, method):
    """Rows of the refinement studies of a method: each level, then the observed orders."""
    for one in (one for one in data.accuracy.refinements if one.method == method):
        for level in one.levels:
            yield [one.solid, one.setting, level.name, *level.errors.of(*ERRORS), level.seconds]
        N = [level.resolution for level in one.levels]
        yield [one.solid, one.setting, [order(N, [level.errors[q] for level in one.levels]) for q in ERRORS]]


def order(N, error):
    """Slope of the error over N on logarithmic scales, as far as it falls; None where it hardly does."""
    used = [k for k in range(len(N)) if 3 * error[k] >= max(error[k:])]
    last = next(k for k in used if error[k] <= 3 * error[-1])
    x, y = ([log(of[k]) for k in used if k <= last] for of in (N, error))
    if len(x) < 2 or x[-1] - x[0] < log(1.9):
        return None
    x = [one - fmean(x) for one in x]
    return -sum(a * b for a, b in zip(x, y, strict=True)) / sum(a * a for a in x)


def cells(item, at=()):
    """Place and value of each number of a nested list."""
    if isinstance(item, list):
        for k, one in enumerate(item):
            yield from cells(one, (*at, k))
    elif item is not None:
        yield at, item


def reach(one, q, level):
    """Value of its driving axis up to which an assumption costs a quantity at most ``level``."""
    k, axis = next((k, axis) for k, axis in enumerate(one.axes) if any(axis.rates))
    U, size = dict(cells(one.uncertainty[q])), {}
    for at, change in cells(one.change[q]):
        size[at[k]] = max(size.get(at[k], 0.0), abs(change) + U[at])
    x = axis["values"]
    if size[0] > level:
        return x[0] * (level / size[0]) ** (1 / axis.rates[q])
    i, j = next(((i, j) for i, j in pairwise(size) if size[j] > level), (0, 0))
    return x[i] * (x[j] / x[i]) ** (log(level / size[i]) / log(size[j] / size[i])) if j else None


def peaks(one):
    """Rows of the largest change of each quantity by an assumption, its uncertainty and its place."""
    for change, uncertainty in zip(one.change, one.uncertainty, strict=True):
        at, value = max(cells(change), key=lambda cell: abs(cell[1]))
        yield [
            value,
            dict(cells(uncertainty))[at],
            [axis["values"][k] for axis, k in zip(one.axes, at, strict=True)],
        ]


def measured(data, one):
    """A comparison with a measurement, with its row of the summary and the rows of its own table."""
    stated = next(some for some in data.shown.measurements.set if some.name == one.name)
    u_input = [hypot(*of) for of in zip(*one.inputs.values(), strict=True)]
    u_D = [hypot(random, one.u_common) for random in one.u_random]
    u = [hypot(*of) for of in zip(one.u_num, u_input, u_D, strict=True)]
    E, U, film = fmean(one.E), fmean(u), stated.layers[0]
    of = [
        [abs(e) / v for e, v in zip(of, u, strict=True)] for of in one.of("E", "bare_film", "bare_substrate")
    ]
    summary = [
        stated.title,
        len(u),
        E,
        rms(one.E),
        max(one.u_num),
        fmean(u_input),
        fmean(u_D),
        U,
        *map(max, of),
    ]
    a, elements = data.shown.measurements.radii[one.name], dict(one.elements)
    rows, formulas = [], []
    for k, (r, S, e) in enumerate(zip(a, one.S, one.E, strict=True)):
        D = S / (1 + e)
        moduli = [D / 1e9, S / 1e9, elements.get(k, 0.0) / 1e9]
        rows.append([r, r / film.thickness, *moduli, e, one.u_random[k], u[k], e / u[k]])
        formulas.append([M / D - 1 for M in common(r, film, data.shown.measurements.substrate.modulus)])
    known = {"stated": stated, "summary": summary, "rows": rows, "interval": [E - 2 * U, E + 2 * U]}
    return Record(one, formulas=[*map(rms, zip(*formulas, strict=True))], **known)


def rms(values):
    """Root of the mean square."""
    return hypot(*values) / sqrt(len(values))


def common(a, film, M_s):
    """Moduli at the contact radius a by Gao, Chiu and Lee (1992) and by Bec et al. (2006)."""
    t, nu = film.thickness, film.nu
    M_f, x = film.E / (1 - nu**2), t / a
    weight = ((1 - 2 * nu) * x * log(1 + 1 / x**2) - x / (1 + x**2)) / (2 * pi * (1 - nu)) + 2 / pi * atan(x)
    return M_s + (M_f - M_s) * weight, (1 + 2 * x / pi) / (
        2 * a * (t / (pi * a**2 * M_f) + 1 / (2 * a * M_s))
    )
