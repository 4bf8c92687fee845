"""Figures of a report computed again from report.json, by the standard library alone: python FILE FOLDER."""

import json
import re
import sys
from html import unescape
from pathlib import Path

DECIDING = ("bare", "coated", "invariants", "studies")  # columns of the checks that count for a method


def differing(folder):
    """Messages on figures of report.html that are not those of report.json."""
    page, data = ((folder / f"report.{kind}").read_text(encoding="utf-8") for kind in ("html", "json"))
    found, data = dict(shown(page)), json.loads(data)
    for name, text in expected(data, data["evidence"]):
        if text not in found.get(name, "nothing"):
            yield f"{name}: {found.get(name, 'nothing')!r}, where report.json gives {text!r}"


def shown(page):
    """Name and text of every row of the first page, and its headline, formulas in plain text."""
    first = page.partition('id="first"')[2].partition('class="contents"')[0]
    cells = r'<th scope="row">(.*?)</th><td[^>]*>(.*?)</td>'
    for name, text in [("", re.search(r"<h1>(.*?)</h1>", first)[1]), *re.findall(cells, first, re.DOTALL)]:
        yield tuple(unescape(re.sub("<[^>]*>", "", part)).replace("·10−", "e-") for part in (name, text))


def expected(data, evidence):
    """Name of a row with a text that it has to hold."""
    cases = data["cases"]
    verdicts = [(case, one["claim"], one["verdict"]) for case in cases for one in case["verdicts"]]
    yield "", f"{len(verdicts)} comparisons"
    gaps = [gap(case, claim, verdict) for case, claim, verdict in verdicts]
    for name, alike in (("without a common equation", False), ("with a common equation, coded twice", True)):
        coded = {"semianalytic", "integral_equation"}
        of = [g for g, (_, c, _) in zip(gaps, verdicts, strict=True) if (set(c["between"]) == coded) is alike]
        yield name, f"{max(of):.1e}".replace("e-0", "e-")
    laws = [one["outcome"] == "AGREES" for case in cases for one in case["invariants"]]
    yield "laws that every solution obeys", share(laws)
    yield "self-tests passed", share([test["passed"] for test in evidence["self_tests"]])
    alarms = evidence["alarms"]
    wrong = len({one["case"] for one in alarms["alarms"] if one["outcome"] != "INCONCLUSIVE"})
    yield "random problems with a false alarm", f"{wrong} of {alarms['problems']}"
    for place, name in (("semianalytic", "semi-analytical method"), ("fem_reference", "finite elements")):
        rows = [row for row in evidence["faults"]["rows"] if row["where"] == place and not row["failure"]]
        seen = sum(map(noticed, rows))
        real = len(rows) - sum(row["equivalent"] and not noticed(row) for row in rows)
        yield f"faults planted in the {name} noticed", f"{seen} of {real}"
    harness = [row["catch"] for row in evidence["faults"]["rows"] if row["where"] == "harness"]
    caught = sum(catch in ("caught", "inconclusive", "baseline") for catch in harness)
    yield "faults planted in the harness noticed", f"{caught} of {len(harness)}"
    costs = [cost for model in evidence["models"].values() for cost in model["costs"]]
    for name in {cost["assumption"] for cost in costs}:
        size = max(abs(c["change"]) + c["uncertainty"] for c in costs if c["assumption"] == name)
        yield name, f"{100 * size:.2g} %" if size >= 1e-6 else "less than 0.0001 %"


def gap(case, claim, verdict):
    """The largest difference of two profiles of a comparison without an edge zone, over its scale."""
    by = {
        p["source"]: p
        for p in case["profiles"]
        if (p["quantity"], p["line"]) == (claim["quantity"], claim["line"])
    }
    one, other = (by[source]["value"] for source in claim["between"])
    return max(abs(a - b) for a, b in zip(one, other, strict=True)) / verdict["judged"]["scale"]


def noticed(row):
    tallies = [tally for name, tally in row["columns"].items() if name.startswith(DECIDING)]
    return any(tally["disagree"] or tally["inconclusive"] for tally in tallies)


def share(held):
    return f"all {len(held)}" if all(held) else f"{sum(held)} of {len(held)}"


if __name__ == "__main__":
    sys.exit("\n".join(differing(Path(sys.argv[1]))) or 0)
