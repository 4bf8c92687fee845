"""Numbers, tables and figures of the report show what the results hold."""

import csv
import io
import itertools
import re
from dataclasses import replace

import numpy as np
import pytest
from markupsafe import Markup
from synthetic_results import STEEL, contact, result_of

from verification.judging.verdict import Outcome
from verification.page.figures import Sheet, line
from verification.page.number_text import aligned, engineering, plain
from verification.page.plots import Plot, Trail, panels
from verification.page.source_labels import OUTCOMES, pair_style, source_style
from verification.page.symbol_text import drawn, typeset, unicode
from verification.report.figures import line_panels
from verification.report.figures.line_panels import case_figures
from verification.report.figures.problem_sketch import sketch
from verification.report.sections.accuracy_section import accuracies, coverage_table, judged
from verification.report.tables.case_lookup import contact_radius, difference, reference_source
from verification.report.tables.case_tables import MOST_FAILING, comparison_table, facts, failing_table
from verification.report.tables.line_csv import line_csv
from verification.running.case_result import describe
from verification.sources.source_record import Style

COATED = contact((2 * STEEL[0], 0.3, 1.0))


def test_numbers_of_a_column_share_their_unit_and_their_decimal_point():
    unit, texts = aligned([(1.2726114e9, 4.8e5), None, (12.5e9, 1e8)], "Pa")
    assert unit == "GPa"
    assert texts[1] == "–"
    # What follows the point has one width, so that right-aligned cells have their points in one line.
    assert [re.findall('min-width:(.*?)"', text) for text in (texts[0], texts[2])] == [["10ch"]] * 2
    assert [re.sub("<[^>]*>", "", text) for text in (texts[0], texts[2])] == ["1.27261(48)", "12.50(10)"]


def test_numbers_of_more_digits_than_asked_for_have_no_power_of_ten():
    assert engineering(2.647e-10, "m", 2) == "265 pm"
    assert [plain(value, 2) for value in (154.0, -0.0, 0.0123456)] == ["154", "0", "0.012"]


def test_symbols_are_typeset_and_strangers_words_escaped():
    assert typeset("sigma_xx") == "<i>σ</i><sub><i>xx</i></sub>"
    assert typeset("3.1e-5 of a_h") == "3.1·10<sup>−5</sup> of <i>a</i><sub>H</sub>"
    assert typeset("residual 0.0e+00, u_val") == "residual 0.0, <i>u</i><sub>val</sub>"
    assert typeset("<b> my_sigma_xx") == "&lt;b&gt; my_sigma_xx"
    assert unicode("E1/E2 = 2, dW/d delta, 1e-3") == "E_1/E_2 = 2, dW/dδ, 10⁻³"
    assert "<i>a</i>, then" in typeset("stress over a, then")
    assert "over a part" in typeset("the mean over a part")
    shifts = [float(shift) for shift in re.findall(r'dy="([^"]*)em"', drawn("p_h + 1"))]
    sizes = [0.78, 1.0]
    assert sum(shift * size for shift, size in zip(shifts, sizes, strict=True)) == pytest.approx(0, abs=0.01)


def test_the_best_reference_is_the_last_exact_one_that_gave_a_result():
    assert reference_source(result_of(contact(), points=11)) == "hertz"
    sources = ("integral_equation", "fem_reference", "semianalytic")
    for failing, best in ((), sources[0]), (sources[:1], sources[1]), (sources, None):
        result = result_of(COATED, failures=dict.fromkeys(failing, "no"), points=11)
        assert reference_source(result) == best


def test_every_outcome_differs_without_colour():
    assert len({style.mark for style in OUTCOMES.values()}) == len(Outcome)
    sources = ("semianalytic", "fem_reference", "integral_equation", "hertz", "another")
    assert len({(source_style(s).dash, source_style(s).width) for s in sources}) == len(sources)
    pairs = [("semianalytic", "fem_reference"), ("semianalytic", "hertz"), ("fem_reference", "hertz")]
    assert len({pair_style(pair).dash for pair in pairs}) == len(pairs)


@pytest.mark.parametrize(
    ("indenter", "shown"),
    [
        (("ellipsoid", (18e-3, 5.5e-3)), "ellipsoid, R_x = 18 mm, R_y = 5.5 mm"),
        (("lobes", (3, 3e-8, 8.6e-5)), "lobed sphere, lobes = 3, amplitude = 30 nm, at = 86 µm"),
    ],
)
def test_an_indenter_is_not_called_a_sphere(indenter, shown):
    result = result_of(contact(), points=5)
    assert "sphere radius R" in dict(facts(result.problem))
    problem = result.problem | {"indenter": indenter}
    assert dict(facts(problem))["indenter"] == shown
    assert "sphere radius R" not in dict(facts(problem))
    assert "rigid sphere" not in sketch(problem, None)


@pytest.mark.parametrize("count", [1, 5])
def test_the_sketch_holds_the_label_of_every_layer(count):
    drawn = sketch(describe(contact(*[(2 * STEEL[0], 0.3, 0.1)] * count)), None)
    lowest = max(float(y) for y in re.findall(r'<text x="[^"]*" y="([^"]*)"', drawn)) + 13
    assert lowest < float(re.search(r'viewBox="0 0 400 ([^"]*)"', drawn)[1])


def test_failing_verdicts_lead_their_table_and_every_quantity_has_a_row():
    result = result_of(COATED, errors={"semianalytic": 2e-3}, stated={"semianalytic": 0.7}, points=31)
    bad = [v for _, v in result.verdicts if v.outcome is not Outcome.AGREES]
    table = failing_table(result.verdicts, COATED.a_h)
    ranks = [row.head.sort for row in table.rows]
    assert ranks == sorted(ranks)
    assert len(ranks) == MOST_FAILING < len(bad)
    assert str(len(bad)) in table.caption
    assert not failing_table(result_of(COATED, points=11).verdicts, COATED.a_h)
    table = comparison_table(result.verdicts)
    assert len(table.rows) == len({(c.quantity, c.line) for c, _ in result.verdicts})
    shown = sum(cell.css == "verdict disagrees" for row in table.rows for cell in row.cells)
    assert shown == sum(v.outcome is Outcome.DISAGREES for v in bad)


def test_accuracy_tells_an_honest_estimate_from_a_vain_one():
    honest = result_of(COATED, points=31)
    # A method that states a fifth of its error cannot be honest about the largest one.
    vain = result_of(COATED, stated={"fem_reference": 0.2}, points=31)
    silent = result_of(COATED, stated={"fem_reference": None}, points=31)
    assert all(item.covered for item in accuracies(honest))
    fem = [item for item in accuracies(vain) if item.source == "fem_reference" and item.line != "contact"]
    assert {(item.covered, item.css) for item in fem} == {(False, "disagrees")}
    for result, column, text in ((honest, 2, "100.0 %"), (silent, 3, "not stated")):
        rows = [row for row in coverage_table([result]).rows if row.head.text == "finite elements"]
        assert [row.cells[column].text for row in rows] == [text, text]


def test_accuracy_is_the_largest_error_of_all_points_that_a_claim_judges():
    a = COATED.a_h
    result = result_of(COATED, points=201)
    found = next(c for c, _ in result.verdicts if c.line == "surface")
    claim = replace(found, edge=0.05)
    x = np.array([-1.051, -1.049, -0.951, -0.949, 0, 0.949, 0.951, 1.049, 1.051]) * a
    here = judged(result, claim, x)
    assert contact_radius(result) == pytest.approx(a, rel=1e-9, abs=0)
    assert here.tolist() == [True, False, False, True, True, True, False, False, True]
    assert judged(result, found, x).all()
    item = next(i for i in accuracies(result) if (i.source, i.quantity) == ("semianalytic", "pressure"))
    mine, exact = (result.profile_of["pressure", "surface", s] for s in ("semianalytic", "integral_equation"))
    error = np.abs(mine.value - exact.value) / COATED.p_h
    assert item.error == pytest.approx(error.max(), rel=1e-9, abs=0)


def test_nothing_is_subtracted_at_different_positions():
    few, many = result_of(COATED, points=11), result_of(COATED, points=21)
    first = few.profile_of["pressure", "surface", "semianalytic"]
    assert difference(few, first, many.profile_of.get(("pressure", "surface", "hertz"))) is None
    assert difference(few, first, many.profile_of["pressure", "surface", "semianalytic"]) is None
    gap, spread = difference(few, first, first)
    assert gap.max() == 0 < spread.min()


def test_csv_holds_every_number_behind_a_figure():
    result, line = result_of(COATED, points=31), "interface 1, upper side"
    head, *rows = csv.reader(io.StringIO(line_csv(result.profiles, line)))
    columns = dict(zip(head, np.array(rows, dtype=float).T, strict=True))
    profiles = [profile for profile in result.profiles if profile.line == line]
    assert len(head) == len(columns) == 1 + 2 * len(profiles)
    np.testing.assert_allclose(columns["x [m]"], profiles[0].position, rtol=1e-8)
    for profile in profiles:
        name = f"{profile.quantity} [Pa] {profile.source}"
        # Each value to a tenth of its uncertainty, ten digits at most.
        allowed = np.maximum(0.1 * profile.uncertainty, 5e-10 * np.abs(profile.value))
        assert (np.abs(columns[name] - profile.value) <= allowed).all()
        assert columns[f"uncertainty of {name}"] == pytest.approx(profile.uncertainty, rel=6e-2)


def test_a_curve_is_drawn_where_its_values_are_and_breaks_at_gaps():
    x = np.linspace(0, 3, 400)
    y = np.sin(3 * x)
    y[200] = np.nan
    sheet = Sheet(320, 240)
    chart = sheet.chart((40.0, 10.0, 270.0, 200.0), (0.0, 3.0), (-1.0, 1.0))
    line(chart.axes, x, y, Style("semi"))
    chart.note(1.5, 0.0, "p_h")
    found = str(sheet.drawing("a <curve>"))
    (path,) = re.findall(r'<path d="([^"]*)"[^>]*var\(--semi\)', found)
    first, second = path.strip("M").split("M")
    for part, known in ((first, slice(0, 200)), (second, slice(201, 400))):
        points = np.array([[float(n) for n in pair.split()] for pair in part.split("L")])
        expected = [chart.place(a, b)[1] for a, b in zip(x[known], y[known], strict=True)]
        np.testing.assert_allclose(np.interp(40 + 90 * x[known], *points.T), expected, atol=0.4)
    assert 'aria-label="a &lt;curve&gt;"' in found
    assert "<tspan" in found
    assert "#" not in re.sub(r"url\(#|id=|href=\"#", "", found)
    again = Sheet(320, 240)  # of the same size: nothing of the one before is left
    again.chart((40.0, 10.0, 270.0, 200.0), (0.0, 3.0), (-1.0, 1.0))
    assert "--semi" not in again.drawing("empty")


def test_texts_of_ticks_never_print_over_each_other():
    trail = Trail((33.0, 49.0, 65.0, 97.0, 129.0, 257.0), (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7), Style("semi"))
    ticks = tuple(float(n) for n in range(33, 258, 8))
    (panel,) = panels([Plot("t", "l", "n", "N", ticks, [trail])])
    shown = re.findall(
        r'<text x="([^"]*)" y="[^"]*" class="f-ink" text-anchor="middle">(\d+)<', str(panel.figure)
    )
    places = [(float(x), 6.2 * len(text)) for x, text in shown]
    assert len(places) > 5
    for (x, width), (other, wide) in itertools.pairwise(places):
        assert other - x > (width + wide) / 2


def test_figures_are_drawn_in_the_scales_of_the_bare_substrate(monkeypatch):
    drawn = []
    monkeypatch.setattr(
        line_panels, "draw_curves", lambda *of, **more: drawn.append((*of, more)) or Markup("")
    )
    result = result_of(COATED, errors={"semianalytic": 2e-3}, stated={"semianalytic": 0.7}, points=201)
    zoned = replace(result, verdicts=tuple((replace(c, edge=0.05), v) for c, v in result.verdicts))
    case_figures(zoned)
    curves, differences, more = next(one for one in drawn if 'data-quantity="pressure"' in one[2]["data"])
    assert len(curves) == len(differences) == 3
    for curve in curves:
        assert (curve.position.min(), curve.position.max()) == pytest.approx((-2, 2), rel=1e-12)
        assert curve.value.max() == pytest.approx(1, abs=5e-3)
    error = next(d for d in differences if d.style == pair_style(("semianalytic", "integral_equation")))
    assert error.uncertainty == pytest.approx(0.7 * 2e-3, rel=1e-3)
    verdict = next(
        v for c, v in result.verdicts if (c.quantity, c.between[1]) == ("pressure", "integral_equation")
    )
    assert error.value.max() == pytest.approx(verdict.difference, rel=1e-9)
    assert error.worst == verdict.worst / COATED.a_h
    assert (more["cap"], more["coordinate"]) == (1e-3, "x / a_h")
    assert np.array(more["unjudged"]) == pytest.approx(np.array([(-1.05, -0.95), (0.95, 1.05)]), rel=1e-6)


def test_what_fails_is_drawn_first_and_the_rest_is_what_one_looks_at():
    titles = [panel.title for panel in case_figures(result_of(COATED, points=31))["panels"]]
    assert titles[0] == "p / p_h, surface"
    spoiled = result_of(COATED, spoil={("sigma_yy", "off plane", "fem_reference"): 9 * COATED.p_h}, points=31)
    first = case_figures(spoiled)["panels"][0]
    assert (first.title, first.css) == ("sigma_yy / p_h, off plane", "fails")
    assert case_figures(replace(spoiled, profiles=())) is None
    assert len(case_figures(replace(spoiled, verdicts=()))["panels"]) >= 6
