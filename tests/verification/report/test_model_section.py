"""Where the model ends: the section of the report, the sentence and the warning on the pages of cases."""

from dataclasses import replace

import numpy as np
import pytest
from assumption_maps_made.measuring import with_map
from synthetic_results import INFO, contact, result_of

from verification.commands.common.known_folders import RECORDS
from verification.credibility.model_error import LIMIT, Cost, ModelError, judged_quantities
from verification.evidence.assumption_maps import read_maps
from verification.report.credibility.model_section import section
from verification.report.report_material import Evidence, ReportMaterial
from verification.report.report_page import render

RESULT = result_of(contact(), points=5)


@pytest.fixture(scope="module")
def maps():
    return read_maps(RECORDS)


def test_section_has_every_assumption_of_the_record(maps):
    other = replace(maps.maps[0], assumption="other", title="yet another assumption")
    shown = section(with_map(maps, other))
    heads = [line.head.text for line in shown.parts[0].tables[0].rows]
    for one in (*maps.maps, other):
        assert sum(head.startswith(f"{one.title}, ") for head in heads) == 1
        assert [part.title.casefold() for part in shown.parts].count(one.title.casefold()) == 1
        assert one.title in shown.parts[0].text
    fewer = section(type(maps)(maps.maps[:1]))
    assert maps.maps[1].title in fewer.parts[0].text


def test_map_with_holes_is_told(maps):
    change = maps.maps[0].change.copy()
    change[:, 0, 0, ...] = np.nan
    change[1] = np.nan
    holed = section(type(maps)((replace(maps.maps[0], change=change),)))
    assert len(holed.parts[1].tables[0].rows) == 4


def model_of(size, assumption="Goodman's assumption"):
    return ModelError((Cost(assumption, "tension", size, 0.0),))


def warnings_of(model, told=()):
    return model.warnings(judged_quantities({claim.quantity for claim, _ in RESULT.verdicts}), told)


def test_warning_appears_exactly_beyond_the_limit():
    assert warnings_of(model_of(LIMIT)) == ()
    (warning,) = warnings_of(model_of(-1.02 * LIMIT))
    assert "5.1 %" in warning


def test_wide_contact_is_warned_of_once():
    told = ("contact radius a = 0.4 R is above 0.1 R: at the contact edge",)
    sphere = model_of(0.1, "parabola for the sphere")
    assert warnings_of(sphere, told) == ()
    assert warnings_of(model_of(0.1), told) != ()
    assert warnings_of(sphere) != ()


def test_only_judged_quantities_are_warned_of():
    assert judged_quantities({"pressure", "approach"}) == ("approach", "peak_pressure")
    assert judged_quantities({"sigma_xx", "sigma_xz"}) == ("tension", "shear")
    assert judged_quantities({"u_x", "dW_ddelta"}) == ()


def test_page_of_a_case_states_the_error_of_the_model(maps):
    model = model_of(0.1)
    beyond = {RESULT.name: warnings_of(model)}
    page = render(
        ReportMaterial([RESULT], INFO, Evidence(maps=maps, models={RESULT.name: model}, beyond=beyond))
    )
    assert "10 %" in page
    assert "<strong>Beyond" in page
    assert page.count('id="model"') == 1
    missing = Evidence(models={RESULT.name: ModelError((), (("small strains", "2 coatings"),))})
    page = render(ReportMaterial([RESULT], INFO, missing))
    assert "evaluated" in page
    assert "<strong>Beyond" not in page
