"""Numbers that each page of a report may display, by its own name and those of its tables.

Rows of a table are in their order, or by their heads. A row is a list of its numbers as they are displayed,
or anything that holds them.
"""

import re
from math import comb, inf
from statistics import median

from recomputed_values import (
    CAUGHT,
    METHODS,
    PLACES,
    SCALARS,
    Record,
    accuracies,
    agree,
    coated_alone,
    compared,
    costs_of,
    covered,
    fault,
    group,
    largest,
    levels,
    measured,
    peaks,
    pictures,
    reach,
    scores,
    shares,
    tally,
    width,
)

CLOSED, TWICE = {"hertz", "hamilton"}, {"semianalytic", "integral_equation"}
COLUMNS = (*SCALARS, "largest_tension", "tension_place", "surface", "axis", "interface", "off plane")
FACTS = ("indenter", "pressure", "load_radius", "radius", "load", "friction")
HERTZ = ("a_h", "p_h", "delta_h", "dundurs_beta", "S_h")
GUEST = ("peak_pressure", "contact_radius", "approach", "pressure", "displacement", "stress")
STATES = ("same", "drifted", "gone", "new")
# Definitions and names in texts, which no run changes: standards, years, angles, levels, limits of ranges.
FIXED = "V&V 10-2019, 7009B (2024), 20-2009, (1992), 2006, 0 1 2 3 4 5, 27, 30, 256, 0.6, 10 mm, 20 N, 1.12"
FIXED += ", SiO2, 1 %, 10 %, 95 %, 100 %, 1e-8, 1e-6, 1e-9, 5e-11, 1e-10"
DRAWN = ([0.02, 50], [0.02, 10], [0, 0.49], [0, 0.8], [1, 5])  # ranges of the random problems


def case_page(data, case):
    """Tables and text of the page of a case."""
    problem, verdicts, model = case.problem, compared(case), data.evidence.models[case.name]
    scalars = {(p.source, p.quantity): p for p in case.profiles if p.line == "contact"}
    yield from (("fact", [[problem[name]]]) for name in (*FACTS, *HERTZ) if problem.get(name) is not None)
    yield "file", [[case.case_file]]
    E_ball, nu_ball, on_ball = problem.ball or (1, 1, [])
    for coatings, E_s, nu_s in ((problem.coatings, *problem.substrate), (on_ball, E_ball, nu_ball)):
        length = problem.load_radius or problem.a_h
        rows = [[k, E, E / E_s, nu, h, h / length] for k, (E, nu, h) in enumerate(coatings, 1)]
        yield "layer|E", [*rows, [E_s, 1, nu_s]]
    of_source = group(scalars.values(), lambda p: p.source)
    numbers = [[(p.value, p.uncertainty) for p in of_source.get(one.source, ())] for one in case.sources]
    pairs = group([one for one in verdicts if one.line == "contact"], lambda one: tuple(one.between)).values()
    gaps = [[one[key] for one in of] for of in pairs for key in ("difference", "uncertainty")]
    yield "numbers", numbers + gaps
    figures = group(verdicts, lambda one: f'data-quantity="{one.quantity}" data-line="{one.line}"')
    yield "figure", {at: [of[0].line, of[0].line, largest(of, "difference")] for at, of in figures.items()}
    yield "line|comparisons", [[line, len(of)] for line, of in group(verdicts, lambda one: one.line).items()]
    laws = group(case.invariants, lambda law: law.name)
    nearest = {name: max(of, key=lambda law: law.value / law.bound) for name, of in laws.items()}
    yield "invariant|condition", {name: [name, nearest[name].message, shares(laws[name])] for name in laws}

    def budget(source, quantity, U):
        size = scalars.get((source, quantity))
        return [U, U / abs(size.value[0] if size else problem.p_h)]

    yield "source|quantity", [budget(one.source, q, U) for one in case.sources for q, _, U in one.budget]
    found = [value for one in case.sources for value in one.diagnostics.values()]
    yield "source|diagnostic", [[len(one), one] if isinstance(one, list) else one for one in found]
    counts = [data.cases.index(case) + 1, len(data.cases), len(verdicts), len(case.invariants)]
    yield case.name, [counts, largest(verdicts, "difference"), "0, 100 %", [one.line for one in verdicts]]
    yield case.name, case.of("title", "source", "seconds", "name", "warnings", "remarks")
    yield case.name, [costs_of(model), model.missing, data.evidence.beyond[case.name], pictures(data, case)]


def first_page(data):
    """Figures of the first page: what agrees, what that is worth, what is left out."""
    e, cases = data.evidence, data.cases
    every = [one for case in cases for one in compared(case)]
    new = group(every, repeated)
    counted = [one for key, of in new.items() for one in (of if key is None else of[:1])]
    yield "first", [FIXED, len(every), len(cases), len(every) - len(counted)]
    drawn = e.alarms.campaigns
    yield (
        "first",
        [data.run, *map(dated, drawn), dated(e.faults), [case.of("title", "name") for case in cases]],
    )
    kinds = group(counted, lambda one: (bool(CLOSED & {*one.between}), {*one.between} == TWICE))
    at_edge = group(every, lambda one: one.line == "surface near the edge")
    yield "first", [[agree(of), largest(of, "difference")] for of in (*kinds.values(), *at_edge.values())]
    lines = ("off", "obl", "int")  # of which a share is left out under an indenter that is not round
    shaped = [one for one in every if one.case.problem.indenter and one.line.startswith(lines)]
    zones = [one for one in every if one.edge and one not in shaped]
    yield "first", [[one.cap for one in at_edge.get(True, [])], len(zones) + len(shaped)]
    ratios = [one.ratio for case in cases for one in accuracies(case)]
    yield "first", [sum(ratio >= 1 for ratio in ratios), median(ratio for ratio in ratios if ratio < inf)]
    yield "first", [alarms_of(of) for of in group(drawn, lambda one: one.kind).values()]
    yield "first", [scores(e.faults.rows), measured(data, e.validation.sets[0]).summary, len(e.self_tests)]
    yield "first", [agree([law for case in cases for law in case.invariants]), agree(data.shown.studies)]
    yield "first", [sum(one.same for one in data.baseline.cases), sum(one.statements for one in e.code.parts)]
    costs = group([cost for one in e.models.values() for cost in one.costs], lambda cost: cost.assumption)
    yield "first", [max(costs_of(Record(costs=of))) for of in costs.values()]
    scales = [next(one.judged.scale for one in compared(c) if one.quantity == "sigma_xx") for c in cases]
    apart = [max(pictures(data, c)[11:]) * c.problem.p_h / of for c, of in zip(cases, scales, strict=True)]
    yield "first", [max(apart), max(len(case.problem.coatings) for case in cases)]
    strips = sorted(map(compared, cases), key=lambda of: -largest(of, "difference"))
    yield "first", [[len(of), largest(of, "difference")] for of in strips[:7]]
    yield "first", [len(cases) - 6, sum(map(len, strips[6:]))]


def alarms_of(campaigns):
    """Random problems of one kind: seeds, problems, those with a wrong and with a vague verdict, bound."""
    every, total = (
        [alarm for one in campaigns for alarm in one.alarms],
        sum(one.problems for one in campaigns),
    )
    wrong = {one.case for one in every if one.outcome != "INCONCLUSIVE"}
    vague = {one.case for one in every if one.outcome == "INCONCLUSIVE"} - wrong
    return [[one.seed for one in campaigns], len(wrong), len(vague), total, bound_at_95(len(wrong), total)]


def bound_at_95(failed, total):
    """The p at which no more than ``failed`` of ``total`` have a probability of 5 %, by halving."""
    low, high = 0.0, 1.0
    for _ in range(60):
        p = (low + high) / 2
        as_few = sum(comb(total, k) * p**k * (1 - p) ** (total - k) for k in range(failed + 1))
        low, high = (p, high) if as_few > 0.05 else (low, p)
    return low


def drawn_row(one):
    """A campaign of random problems as its row shows it."""
    (seed, wrong, vague, total, _), ratios = alarms_of([one]), [of for of in one.ratios if of["values"]]
    within = [[of.within, of["values"], of.largest] for of in ratios]
    return [seed, total, one.agreeing, vague, one.comparisons, wrong, one.largest, within, dated(one)]


def repeated(one):
    """What comparisons share that differ by the friction of their cases alone; None where friction counts."""
    if one.quantity not in (*SCALARS, "pressure"):
        return None
    of = [p for p in one.case.profiles if p.quantity == "contact_radius" and p.source in one.between]
    solved = one.case.problem | {"friction": 0}
    return str((solved, one.quantity, one.line, one.between, [f"{p.value[0]:.10g}" for p in of]))


def dated(record):
    """Date, time, machine and commit of a record, the commit as the pages cut it."""
    return [*record.of("started", "machine", "seconds", "commit"), record.commit[:8], record.commit[:7]]


def run_pages(data):
    """Tables and texts of the pages about the whole run."""
    e, cases, shown, drifts = data.evidence, data.cases, data.shown, data.baseline.cases
    maps, parts = e.maps.maps, shown.measurements.of("set", "excluded", "seen")
    dates = [FIXED, *map(dated, (e.code, e.faults, *e.alarms.campaigns, e.enclosures, data.run, *maps))]
    yield "reading", [*dates, data.run, len(cases)]
    yield "case|verdict", [overview(case) for case in cases]
    yield from credibility(data, dates)
    beyond = [one.name for one in shown.studies if one.outcome == "DISAGREES"]
    yield "accuracy", [FIXED, agree(shown.studies), len(beyond), beyond]
    for name in METHODS:
        yield "case|p0", [errors(case, name) for case in cases if any(accuracies(case))]
    yield "part|error", {one.name: one.of("name", "message") for one in shown.studies}
    yield "solid and setting|patches per side", [*levels(data, METHODS[0])]
    yield "solid and setting|mesh", [*levels(data, METHODS[1])]
    levels_of = [(one, level) for one in maps for level in (0.001, 0.01, 0.05)]
    reached = [[level, *(reach(one, q, level) for q in range(5))] for one, level in levels_of]
    yield "model", [*dates, [axis["values"] for one in maps for axis in one.axes], reached]
    yield "assumption|level", reached
    yield from (("quantity|largest", [*peaks(one)]) for one in maps)
    yield "baseline", [FIXED, e.baseline["update"], largest(drifts, "change")]
    yield "baseline", [sum(one[key] for one in drifts) for key in STATES]
    both = zip(cases, drifts, strict=True)
    yield "case|state", [[case.title, *one.of(*STATES, "change")] for case, one in both]
    yield "code|agree", [guest(one) for one in shown.guests]
    sets = [measured(data, one) for one in e.validation.sets]
    yield "data|rows", [one.summary for one in sets]
    for one in (one for one in sets if not one.stated.reason):
        yield "validation", [FIXED, one.of("summary", "stated", "formulas", "interval")]
        yield "a [nm]|a/t", one.rows
        inputs = [[max(map(abs, of)), "SiO2"] for of in one.inputs.values()]
        yield "input|change of S", [*inputs, [one.u_common]]
    yield "measurement|reason", [one for of in parts for one in of if one.reason]


def overview(case):
    """Row of a case in the table of all."""
    first = max(compared(case), key=lambda one: one.difference)
    return [case.title, agree(compared(case)), agree(case.invariants), first.difference, first.line]


def guest(one):
    """Row of a code of others."""
    found = [one.differences.of(*GUEST), one.seconds[1], one.memory]
    return [*one.of("guest", "version", "date", "agree", "answered", "cases", "levels"), *found]


def errors(case, method):
    """Title of a case, then the largest error of each kind with U there."""
    found = {}
    for one in (one for one in accuracies(case) if one.method == method):
        line = re.sub("^ball, | [0-9], .*", "", one.line)
        place = one.quantity if line == "contact" else "off plane" if line[:3] == "obl" else line
        found[place] = max(found.get(place, (-1, 0)), one.worst)
    return [case.title, [found.get(place) for place in COLUMNS]]


def credibility(data, dates):
    """Tables and text of the page on what an agreement is worth."""
    e, cases, rows, drawn = (
        data.evidence,
        data.cases,
        data.evidence.faults.rows,
        data.evidence.alarms.campaigns,
    )
    problems = [case.problem for case in cases]
    layers = [(E / one.substrate[0], h / one.a_h, nu) for one in problems for E, nu, h in one.coatings]
    ratios, depths, nus = zip(*layers, strict=True)
    nus += tuple(one.substrate[1] for one in problems)
    ranges = ratios, depths, nus, [one.friction for one in problems], [len(one.coatings) for one in problems]
    yield "quantity|this run", [[min(of), max(of), drawn] for of, drawn in zip(ranges, DRAWN, strict=True)]
    yield "elements|harmonic", [operator(one) for one in e.code.orders]
    known = [one for case in cases for one in accuracies(case)]
    kinds = group(known, lambda one: (-METHODS.index(one.method), one.quantity in SCALARS))
    yield "method|quantities", [covered(kinds[at]) for at in sorted(kinds, reverse=True)]
    pairs = group([one for case in cases for one in compared(case)], lambda one: tuple(one.between)).values()
    ends = ("difference", "uncertainty")
    yield "between|agree", [[agree(of), *(largest(of, end) for end in ends)] for of in pairs]
    yield "part|files", [one.of("files", "statements") for one in e.code.parts]
    listed = group(
        [alarm for one in drawn for alarm in one.alarms], lambda one: one.outcome == "INCONCLUSIVE"
    )
    yield "problem|verdict", [*listed.get(False, []), *listed.get(True, [])]
    yield "random|seed", [drawn_row(one) for one in drawn]
    every = [law for case in cases for law in case.invariants]
    laws = group(every, lambda law: re.sub(", (coating|interface|layer) [0-9]+$|, substrate$", "", law.name))
    sources = {name: group(of, lambda law: law.source).values() for name, of in laws.items()}
    row = {
        name: [[agree(of), largest(of, "value"), max(shares(of))] for of in sources[name]] for name in laws
    }
    yield "invariant|hold", row
    at = group(rows, lambda row: row.where if row.where in PLACES else "references")
    yield "in|faults", [*(tally(at.get(place, [])) for place in PLACES), tally(rows)]
    yield "fault|outcome", {row.name: row.of("name", "description", "reason", "remedy") for row in rows}
    made = [sum(one.made for one in row.columns.values()) for row in e.faults.controls]
    yield "control|solved again", [*zip((row.description for row in e.faults.controls), made, strict=True)]
    yield "fault|fault planted", {row.name: fault(row) for row in rows}
    yield "part|passed", e.self_tests
    yield "credibility", [*dates, *(sum(one[key] for one in e.code.parts) for key in ("statements", "files"))]
    bounds = [bound for one in e.enclosures.enclosures for bound in one.bounds]
    yield "credibility", [len(bounds), len(e.enclosures.enclosures), max(map(width, bounds))]
    yield "credibility", [e.enclosures.versions, e.self_tests]
    kinds = group(drawn, lambda one: one.kind).values()
    yield "credibility", [[alarms_of(of) for of in kinds], sum(len(one.alarms) for one in drawn)]
    methods = group([one for of in drawn for one in of.ratios], lambda one: one.source).values()
    yield "credibility", [sum(one["values"] for one in of) for of in methods]
    yield "credibility", [agree(every), len(cases), max(shares(every))]
    yield "credibility", [e.faults.core_seconds, len(e.faults.controls), tally(rows), scores(rows)]
    yield "credibility", [len(of) for of in group(rows, lambda row: row.group).values()]
    yield "credibility", [sum(row.catch in CAUGHT for row in rows) / len(rows), sum(map(coated_alone, rows))]


def operator(one):
    """Row of the orders of the finite element operator."""
    n = one.order
    return [n, one.harmonic, n + 1, one.displacement, n, one.gradient, one.errors[1]]
