"""The report in a real browser: quiet, offline, page by page within its limits, usable by keyboard."""

import re

import pytest
from headless import Page, browser, page
from synthetic_results import INFO, showcase
from synthetic_study import study

from verification.report.report_material import Evidence, ReportMaterial
from verification.report.report_page import write_report
from verification.sampling.stress_plane import sample_plane
from verification.sources.references.hertz import Hertz

pytestmark = pytest.mark.skipif(browser() is None, reason="no Chromium on this machine")

# Whatever sticks out of the page makes all of it scroll sideways.
STICKING_OUT = "document.documentElement.scrollWidth - document.documentElement.clientWidth"


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    results = showcase(points=65)[4:]
    problem = results[0].problem
    hertz = Hertz(problem["radius"], problem["load"], *problem["substrate"])
    plane = sample_plane(tuple(problem["interfaces"]), {"semianalytic": hertz, "fem_reference": hertz})
    evidence = Evidence(accuracy=study("order 3: the mesh has no triangles"))
    return write_report(ReportMaterial(results, INFO, evidence, {results[0].name: plane}), folder, "")


@pytest.fixture(scope="module")
def chromium(tmp_path_factory):
    with page(tmp_path_factory.mktemp("profile")) as opened:
        yield opened


HEIGHT = "document.querySelector('.page.here').getBoundingClientRect().height"
GO = "(where) => { location.hash = where; return new Promise((done) => setTimeout(done, 300)); }"


def go(chromium: Page, where: str) -> None:
    chromium.evaluate(f"({GO})({where!r})")


def wait(chromium: Page, milliseconds: int) -> None:
    chromium.evaluate(f"new Promise((done) => setTimeout(done, {milliseconds}))")


@pytest.mark.parametrize("dark", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["light", "dark"])
def test_every_page_fits_and_is_silent(chromium: Page, report, dark):
    chromium.open(report, width=390, dark=dark)
    for where in chromium.evaluate("[...document.querySelectorAll('.page')].map((page) => page.id)"):
        go(chromium, where)
        for width in (390, 820, 1280):
            chromium.resize(width)
            assert chromium.evaluate(STICKING_OUT) == 0, (where, width)
            if where == "first" or width == 1280:
                assert chromium.evaluate(HEIGHT) <= (1600 if where == "first" else 8000), (where, width)
    assert chromium.evaluate("document.querySelectorAll('.page.here').length") == 1
    loud = {"Runtime.consoleAPICalled", "Log.entryAdded", "Runtime.exceptionThrown"}
    assert [event for event in chromium.events if event["method"] in loud] == []
    asked = [e for e in chromium.events if e["method"] == "Network.requestWillBeSent"]
    addresses = {e["params"]["request"]["url"].partition("#")[0] for e in asked}
    assert {a for a in addresses if not a.startswith("data:")} == {report.as_uri()}


def test_text_stands_out_in_both_colour_schemes(chromium: Page, report):
    # WCAG asks for a contrast of 4.5 for text; measured on each kind of verdict and on the body.
    for dark in (False, True):
        chromium.open(report, width=1360, dark=dark)
        found = chromium.evaluate(
            """(() => {
              const light = (c) => { const f = c.map(v => { v /= 255;
                return v <= .03928 ? v / 12.92 : ((v + .055) / 1.055) ** 2.4; });
                return .2126 * f[0] + .7152 * f[1] + .0722 * f[2]; };
              const numbers = (text) => text.match(/[\\d.]+/g).slice(0, 3).map(Number);
              const ground = (node) => { for (; node; node = node.parentElement) {
                const colour = getComputedStyle(node).backgroundColor;
                if (!/, 0\\)$/.test(colour)) return numbers(colour); } return [255, 255, 255]; };
              const worst = {};
              for (const node of document.querySelectorAll(
                  'h1, h2, p, a, th, td, dt, summary, figcaption span, .agrees, .disagrees, .inconclusive, '
                  + '.agrees-ink, .disagrees-ink, .inconclusive-ink, .no-result-ink')) {
                if (!node.textContent.trim() || node.closest('.skip')) continue;
                const a = light(numbers(getComputedStyle(node).color)), b = light(ground(node));
                const ratio = (Math.max(a, b) + .05) / (Math.min(a, b) + .05);
                const name = node.tagName + '.' + node.className;
                worst[name] = Math.min(worst[name] ?? 99, ratio);
              }
              return worst;
            })()"""
        )
        assert {name: ratio for name, ratio in found.items() if ratio < 4.5} == {}
        assert len(found) > 10


def test_a_pressed_column_head_sorts_the_table(chromium: Page, report):
    chromium.open(report, width=1360)
    go(chromium, "cases")
    heads = "[...document.querySelectorAll('.all-cases tbody th')].map(c => c.textContent)"
    before = chromium.evaluate(heads)
    chromium.evaluate("document.querySelector('.all-cases thead button').focus()")
    chromium.press("Enter", 13)
    after = chromium.evaluate(heads)
    assert sorted(before) == sorted(after)
    assert after != before
    assert chromium.evaluate("document.querySelector('.all-cases th[aria-sort]').ariaSort") == "ascending"


def test_everything_can_be_reached_by_keyboard(chromium: Page, report):
    chromium.open(report, width=1360)
    go(chromium, "cases")
    focused = "document.activeElement.tagName + '.' + document.activeElement.className"
    reached = set()
    for _ in range(60):
        chromium.press("Tab", 9)
        reached.add(chromium.evaluate(focused))
    assert {"A.brand", "DIV.scroll", "BUTTON.", "A.", "INPUT."} <= reached
    assert chromium.evaluate("getComputedStyle(document.activeElement).outlineStyle") != "none"
    # What scrolls inside its own box must take the focus too, or a keyboard cannot scroll it.
    assert chromium.evaluate("document.querySelectorAll('.scroll:not([tabindex])').length") == 0


def test_the_numbers_come_out_of_the_page_as_csv(chromium: Page, report, tmp_path):
    chromium.open(report, width=1360)
    chromium.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path))
    link = "document.querySelector('a[data-csv$=\"surface.csv\"]')"
    name = chromium.evaluate(f"{link}.dataset.csv")
    chromium.evaluate(f"{link}.click()")
    for _ in range(50):
        if not (tmp_path / name).exists():
            wait(chromium, 100)
    text = (tmp_path / name).read_text()
    assert text.startswith("x [m],pressure [Pa] semianalytic,")
    assert len(text.splitlines()) == 66


def test_a_pointer_on_a_comparison_names_it_and_a_click_draws_it(chromium: Page, report):
    chromium.open(report, width=1360)
    place = """(() => { const ring = document.querySelector('.here svg.strip .ring');
        ring.scrollIntoView({block: 'center'});
        const box = ring.getBoundingClientRect();
        return [box.x + box.width / 2, box.y + box.height / 2]; })()"""
    x, y = chromium.evaluate(place)
    chromium.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
    told = chromium.evaluate("document.querySelector('.tip').textContent")
    assert re.search(r"\|A − B\| .*U .*cap .*(agrees|disagrees|inconclusive)", told)
    for kind in ("mousePressed", "mouseReleased"):
        chromium.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)
    wait(chromium, 400)
    opened = chromium.evaluate("[location.hash, document.querySelector('.page.here').id]")
    assert opened[0].startswith(f"#{opened[1]}")
    go(chromium, f"{opened[1]}~axis~sigma_xx")
    assert chromium.evaluate("document.querySelectorAll('.here .plot path').length") > 20
    assert chromium.evaluate("document.querySelector('.here .explorer select.line').value") == "axis"
    # The arrow keys read the values.
    chromium.evaluate("document.querySelector('.here .plot').focus()")
    chromium.press("ArrowRight", 39)
    assert "semi-analytical" in chromium.evaluate("document.querySelector('.tip').textContent")
    chromium.evaluate("document.querySelector('.here .numbers-of').open = true")
    wait(chromium, 100)
    assert chromium.evaluate("document.querySelectorAll('.here .comparisons tbody tr').length") > 20


def test_the_search_finds_a_case(chromium: Page, report):
    chromium.open(report, width=1360)
    go(chromium, "cases")
    chromium.evaluate("document.querySelector('.menu input').focus()")
    chromium.call("Input.insertText", text="silver nan")
    shown = "[...document.querySelectorAll('.menu li')].filter((item) => !item.hidden).length"
    assert chromium.evaluate(shown) == 1
    chromium.press("Enter", 13)
    wait(chromium, 200)
    assert chromium.evaluate("document.querySelector('.page.here').id") == "case-silver"


def test_dark_and_light_can_be_chosen_by_keyboard(chromium: Page, report):
    ground = "getComputedStyle(document.body).backgroundColor"
    for dark in (False, True):
        chromium.open(report, width=1360, dark=dark)
        first = chromium.evaluate(ground)
        chromium.evaluate("document.querySelector('button.theme').focus()")
        chromium.press("Enter", 13)
        assert chromium.evaluate(ground) != first
        chromium.press("Enter", 13)
        assert chromium.evaluate(ground) == first


def test_without_the_script_and_on_paper_every_page_shows(chromium: Page, report):
    shown = "[...document.querySelectorAll('.page')].filter((page) => page.offsetHeight).length"
    chromium.open(report, width=1360)
    count = chromium.evaluate("document.querySelectorAll('.page').length")
    assert chromium.evaluate(shown) == 1
    chromium.call("Emulation.setEmulatedMedia", media="print")
    assert chromium.evaluate(shown) == count
    chromium.call("Emulation.setEmulatedMedia", media="")
    chromium.evaluate("document.documentElement.classList.remove('js')")
    assert chromium.evaluate(shown) == count
