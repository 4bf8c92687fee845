"""The report page in a real browser: quiet, offline, within the screen, usable by keyboard."""

import pytest
from headless import Page, browser, page
from synthetic_results import INFO, showcase
from synthetic_study import study

from verification.report.material import Evidence, Material
from verification.report.write import write_report
from verification.sampling.plane import sample_plane
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
    failed = "order 3: the mesh has no triangles"
    return write_report(
        Material(results, INFO, Evidence(accuracy=study(failed)), {results[0].name: plane}), folder
    )


@pytest.fixture(scope="module")
def chromium(tmp_path_factory):
    with page(tmp_path_factory.mktemp("profile")) as opened:
        yield opened


@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
def test_the_page_fits_and_is_silent(chromium: Page, report, dark):
    chromium.open(report, width=390, dark=dark)
    # content-visibility lays out what is far off only when it is near: bring everything near.
    chromium.evaluate(
        "document.querySelectorAll('.case').forEach(c => c.style.contentVisibility = 'visible')"
    )
    chromium.evaluate("document.querySelectorAll('details').forEach(d => d.open = true)")
    for width in (390, 820, 1360):
        chromium.resize(width)
        assert chromium.evaluate(STICKING_OUT) == 0, width
    loud = [e for e in chromium.events if e["method"] in ("Runtime.consoleAPICalled", "Log.entryAdded")]
    loud += [e for e in chromium.events if e["method"] == "Runtime.exceptionThrown"]
    assert loud == []
    asked = [e for e in chromium.events if e["method"] == "Network.requestWillBeSent"]
    addresses = {e["params"]["request"]["url"] for e in asked}
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
                  'h1, p, a, td, dt, figcaption span, .agrees, .disagrees, .inconclusive')) {
                if (!node.textContent.trim()) continue;
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
    column = "[...document.querySelectorAll('#times tbody tr')].map(r => r.cells[1].textContent)"
    before = chromium.evaluate("[...document.querySelectorAll('.matrix tbody th')].map(c => c.textContent)")
    chromium.evaluate("document.querySelector('.matrix thead tr:last-child button').focus()")
    chromium.press("Enter", 13)
    after = chromium.evaluate("[...document.querySelectorAll('.matrix tbody th')].map(c => c.textContent)")
    assert sorted(before) == sorted(after)
    assert after != before
    assert chromium.evaluate("document.querySelector('.matrix th[aria-sort]').ariaSort") == "ascending"
    assert chromium.evaluate(column)


def test_everything_can_be_reached_by_keyboard(chromium: Page, report):
    chromium.open(report, width=1360)
    reached = set()
    for _ in range(60):
        chromium.press("Tab", 9)
        reached.add(
            chromium.evaluate("document.activeElement.tagName + '.' + document.activeElement.className")
        )
    assert {"A.skip", "DIV.scroll", "BUTTON.", "A."} <= reached
    outline = chromium.evaluate("getComputedStyle(document.activeElement).outlineStyle")
    assert outline != "none"
    # What scrolls inside its own box must take the focus too, or a keyboard cannot scroll it.
    assert chromium.evaluate("document.querySelectorAll('.scroll:not([tabindex])').length") == 0


def test_the_numbers_come_out_of_the_page_as_csv(chromium: Page, report, tmp_path):
    chromium.open(report, width=1360)
    chromium.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path))
    link = "document.querySelector('a[data-csv$=\"surface.csv\"]')"
    name = chromium.evaluate(f"{link}.dataset.csv")
    chromium.evaluate(f"{link}.click()")
    deadline = 50
    while not (tmp_path / name).exists() and deadline:
        chromium.evaluate("new Promise(done => setTimeout(done, 100))")
        deadline -= 1
    text = (tmp_path / name).read_text()
    assert text.startswith("x [m],pressure [Pa] semianalytic,")
    assert len(text.splitlines()) == 66


def test_a_title_from_a_stranger_runs_nothing(chromium: Page, report):
    chromium.open(report, width=1360)
    assert not [e for e in chromium.events if e["method"] == "Page.javascriptDialogOpening"]
    assert chromium.evaluate("document.scripts.length") == 1
    assert "<script>alert('no')</script>" in chromium.evaluate("document.body.textContent")


def test_the_pictures_below_the_contact_are_there(chromium: Page, report):
    chromium.open(report, width=1360)
    chromium.evaluate(
        "document.querySelectorAll('.case').forEach(c => c.style.contentVisibility = 'visible')"
    )
    assert chromium.evaluate("document.querySelectorAll('svg.field').length") == 9
    loaded = """Promise.all([...document.querySelectorAll('svg.field image')].map(async (image) => {
        const copy = new Image(); copy.src = image.getAttribute('href'); await copy.decode();
        return copy.naturalWidth * copy.naturalHeight; })).then((sizes) => Math.min(...sizes))"""
    assert chromium.evaluate(loaded) > 50
    # Three panels in a row on a wide screen, one below the other on a phone.
    places = """new Set([...document.querySelectorAll('.fields .panel')].map(
        (panel) => Math.round(panel.getBoundingClientRect().x))).size"""
    assert chromium.evaluate(places) == 3
    chromium.open(report, width=390)
    assert chromium.evaluate(places) == 1


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


def test_every_gallery_offers_its_numbers(chromium: Page, report):
    chromium.open(report, width=1360)
    bare = """[...document.querySelectorAll('.panels')].filter(
        (panels) => !panels.nextElementSibling?.querySelector('a[data-csv]')).length"""
    assert chromium.evaluate("document.querySelectorAll('.panels').length") > 10
    assert chromium.evaluate(bare) == 0


def test_the_matrix_comes_before_the_particulars_of_the_run(chromium: Page, report):
    chromium.open(report, width=1360)
    order = "document.querySelector('.matrix').compareDocumentPosition(document.querySelector('dl.facts'))"
    assert chromium.evaluate(order) & 4
    assert chromium.evaluate("document.querySelector('.matrix').getBoundingClientRect().top") < 800
