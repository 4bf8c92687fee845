"""The report page as text: whole, self-contained, safe with strangers' words, true to its results."""

import base64
import gzip
import hashlib
import html
import json
import re
from dataclasses import replace

import numpy as np
import pytest
from html_document import Document
from synthetic_results import INFO, STEEL, contact, crashed, result_of, showcase

from verification.cases.case_file import shipped_cases
from verification.judging.verdict import Outcome
from verification.page.symbol_text import typeset
from verification.report import report_page as module
from verification.report.report_material import ReportMaterial
from verification.report.report_page import render
from verification.report.sections import first_page
from verification.report.tables.case_tables import MOST_FAILING
from verification.running.case_result import CaseResult, RunInfo


@pytest.fixture(scope="module")
def results() -> list[CaseResult]:
    return showcase(points=101)


@pytest.fixture(scope="module")
def page(results) -> str:
    return render(ReportMaterial(results, INFO))


@pytest.fixture(scope="module")
def document(page) -> Document:
    return Document(page)


def numbers_of(text: str) -> list[int]:
    return [int(word) for word in re.findall(r"\b\d+\b", text)]


def rendered(*results: CaseResult) -> Document:
    return Document(render(ReportMaterial(results, INFO)))


def test_the_page_needs_nothing_but_itself(page, document):
    for tag, attributes in document.elements:
        for name in ("src", "href", "xlink:href", "action", "srcset", "data", "poster"):
            value = attributes.get(name, "#")
            assert value.startswith(("#", "data:")), f"<{tag} {name}={value[:60]!r}>"
    assert "@import" not in page
    assert not re.search(r"url\([^#]", page)


def test_the_content_security_policy_admits_the_one_script(page, document):
    policy = next(a["content"] for a in document.all("meta") if a.get("http-equiv"))
    assert policy.startswith("default-src 'none'")
    (script,) = re.findall(r"<script>(.*?)</script>", page, re.DOTALL)
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert f"script-src 'sha256-{digest}'" in policy


def test_every_link_leads_somewhere_and_no_identifier_is_taken_twice(results):
    # Among them cases of one name, or with the same anchor.
    alike = [result_of(contact(), name=name, points=5) for name in ("a b", "a-b", "%%")]
    found = rendered(*results, *alike)
    identifiers = [a["id"] for _, a in found.elements if "id" in a]
    assert len(identifiers) == len(set(identifiers))
    targets = {a["href"][1:] for _, a in found.elements if a.get("href", "").startswith("#")}
    assert len(targets) > 20
    assert targets <= set(identifiers)


def test_the_first_page_is_short_and_tells_what_matters(document, page, results):
    shown = Document(page[page.index('<section class="page here"') : page.index('<nav class="contents"')])
    assert len(shown.whole("section")[-1].split()) <= 600
    bad = sum(v.outcome is not Outcome.AGREES for r in results for _, v in r.verdicts)
    total = sum(len(r.verdicts) for r in results)
    assert numbers_of(shown.whole("h1")[0]) == [6, 12, bad, total]
    # One row a case: its title, its strip, the comparison to look at, its count.
    strips = [a for a in shown.all("svg") if a.get("class") == "strip"]
    assert len(strips) == len(results)
    assert all(a["aria-label"] and a["data-of"].startswith("case-") for a in strips)


def test_many_cases_are_grouped_behind_the_worst():
    one = result_of(contact((2 * STEEL[0], 0.3, 1.0)), points=5)
    several = [replace(one, name=f"case {n}", title=f"Case {n}") for n in range(40)]
    several[33] = crashed(contact(), "dead", "killed after 300 s")
    chart = first_page.chart(ReportMaterial(several, INFO))
    assert len(chart["rows"]) == first_page.OWN_ROWS + 1
    assert chart["rows"][0]["title"] == "Dead"
    assert chart["rows"][-1]["title"].startswith(f"{40 - first_page.OWN_ROWS} more")
    assert first_page.chart(ReportMaterial(several[:3], INFO))["grouped"] == 0
    shipped = first_page.chart(ReportMaterial(several[: len(shipped_cases())], INFO))
    assert len(shipped["rows"]) < first_page.MOST_ROWS


def test_words_from_strangers_stay_words():
    evil = "<script>alert(1)</script>\"'><img src=x onerror=alert(2)>${7*7}{{7*7}}$x^2$"
    text = f"{evil}\n</pre></article>"
    failed = {"fem_reference": evil}
    result = result_of(contact(), name=evil, title=evil, failures=failed, text=text, points=5)
    info = RunInfo(evil, evil, 1.0, 1, evil, evil, {evil: evil})
    document = Document(render(ReportMaterial([result], info)))
    assert len(document.all("script")) == 1
    assert all(image["src"].startswith("data:image/") for image in document.all("img"))  # figures alone
    assert not any(name.startswith("on") for _, attributes in document.elements for name in attributes)
    said = " ".join(text for _, text in document.texts)
    assert said.count(evil) >= 6


def test_pages_of_many_cases_are_compressed_and_come_out_whole(monkeypatch):
    several = [result_of(contact(), name=name, points=11) for name in ("one", "two")]
    plain = render(ReportMaterial(several, INFO))
    monkeypatch.setattr(module, "MOST_UNPACKED", 1)
    small = render(ReportMaterial(several, INFO))
    assert small.count('<div class="packed"') == 2
    assert len(small) < 0.85 * len(plain)
    packed = re.compile(
        r'<h2>[^\n]*</h2>\n<noscript>.*?</noscript>\n<div class="packed" data-html="[^",]*,([^"]*)"></div>'
    )
    whole = Document(packed.sub(lambda found: gzip.decompress(base64.b64decode(found[1])).decode(), small))
    assert whole.whole("article") == Document(plain).whole("article")


def test_every_verdict_that_fails_is_told_with_its_reason_and_all_are_in_the_data(document, results, page):
    reasons = document.whole("td")
    for result in results:
        bad = [v for _, v in result.verdicts if v.outcome is not Outcome.AGREES]
        shown = [" ".join(re.sub("<[^>]*>", "", typeset(v.reason)).split()) for v in bad]
        assert sum(html.unescape(text) in reasons for text in shown) >= min(len(bad), MOST_FAILING)
    (data,) = re.findall(r'<template id="data">(.*?)</template>', page, re.DOTALL)
    cases = json.loads(html.unescape(data))["cases"]
    assert sum(len(case["rows"]) for case in cases.values()) == sum(len(r.verdicts) for r in results)


def test_nan_never_looks_like_agreement():
    problem = contact((2 * STEEL[0], 0.3, 1.0))
    spoiled = {
        ("sigma_xx", "surface", "semianalytic"): np.nan,
        ("approach", "contact", "fem_reference"): np.inf,
    }
    document = rendered(result_of(problem, spoil=spoiled))
    assert any(text.startswith("∅") for text in document.whole("td"))
    assert numbers_of(document.whole("h1")[0])[:3] == [1, 1, 4]


def test_every_figure_says_what_it_shows_and_carries_its_numbers(document, results):
    drawn = [a for a in document.all("svg") if a.get("class", "").startswith(("figure", "strip"))]
    assert all((a.get("aria-label") or "aria-hidden" in a) and a.get("viewbox") for a in drawn)
    figures = [a for a in drawn if a["class"].startswith("figure")]
    # The script of the page reads the numbers of a figure from the CSV of its line.
    lines = {a["data-of"] for a in document.all("a") if "data-csv" in a and "data-of" in a}
    assert {a["data-line"] for a in figures if "data-line" in a} <= lines
    tables = [a for a in document.all("a") if "data-csv" in a]
    assert len(tables) == sum(len({p.line for p in r.profiles}) for r in results)
    for link in tables:
        kind, _, packed = link["href"].partition(",")
        assert kind == "data:application/gzip;base64"
        assert link["download"] == link["data-csv"] + ".gz"
        assert gzip.decompress(base64.b64decode(packed)).count(b"\n") > 1


def test_no_number_whatever_keeps_a_report_from_being_written(results):
    random = np.random.default_rng(7)
    odd = np.array([1e308, -1e308, 5e-324, np.nan, np.inf, -np.inf, 0.0, -0.0, 1e30, 1e-30, -1.0])
    base = result_of(contact((2 * STEEL[0], 0.3, 1.0)), points=7)

    def spoiled(array, share):
        return np.where(random.random(array.shape) < share, random.choice(odd, array.shape), array)

    for share in (0.05, 0.3, 1.0):
        profiles = tuple(
            replace(
                p,
                position=spoiled(p.position, 0.2 * share),
                value=spoiled(p.value, share),
                uncertainty=spoiled(p.uncertainty, share),
            )
            for p in base.profiles
        )
        verdicts = tuple(
            (claim, replace(verdict, **dict.fromkeys(("difference", "margin", "worst"), random.choice(odd))))
            for claim, verdict in base.verdicts
        )
        problem = base.problem | {"a_h": random.choice(odd), "coatings": [["nan", 0.3, random.choice(odd)]]}
        wrong = {0.05: base.problem, 0.3: problem, 1.0: {}}[share]
        document = rendered(replace(base, profiles=profiles, verdicts=verdicts, problem=wrong))
        assert len(document.all("article")) == 1


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("coatings", [(), ((420e9, 0.3, 1.0),), ((420e9, 0.3, 0.01), (100e9, 0.2, 8.0))])
def test_any_problem_gets_a_page(coatings, friction):
    document = rendered(result_of(contact(*coatings, friction=friction), points=31))
    lines = 1 + 2 + 2 * len(coatings) + 3
    assert len([a for a in document.all("a") if "data-of" in a]) == lines
    assert len([a for a in document.all("tr") if "data-line" in a]) == lines
