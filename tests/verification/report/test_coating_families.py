"""The plots of one coating at several moduli: which cases make a family, and what is drawn of it."""

import pytest
from synthetic_results import contact, result_of

from verification.report.sections.family_section import section as family_section


def member(ratio, thickness=1.0, friction=0.0, name=None):
    coatings = ((210e9 * ratio, 0.3, thickness),) if ratio != 1 else ()
    return result_of(contact(*coatings, friction=friction), name=name or f"ratio_{ratio:g}", points=31)


@pytest.fixture(scope="module")
def frictionless():
    return [member(ratio) for ratio in (4, 0.25, 1, 2)]


def test_coatings_of_one_thickness_and_the_bare_solid_are_a_family(frictionless):
    (part,) = family_section(frictionless).parts
    panels = part.gallery.panels
    assert [panel.title for panel in panels].count("sigma_xx / p_h") == 4
    assert [label for _, label in part.gallery.legend] == [f"E1/E2 = {r}" for r in ("0.25", "1", "2", "4")]
    assert all(str(panel.figure).count("stroke: var(--ink)") == len(frictionless) for panel in panels[:3])
    (table,) = part.tables
    assert [row.head.text for row in table.rows] == ["0.25", "1", "2", "4"]
    stiff = frictionless[0]
    radius = stiff.profile_of["contact_radius", "contact", "semianalytic"].value[0] / stiff.problem["a_h"]
    column = next(n for n, name in enumerate(table.columns[1:]) if name == "a / a_h")
    assert float(table.rows[3].cells[column].text) == pytest.approx(radius, abs=5e-7)


def test_other_thickness_friction_or_too_few_are_no_family(frictionless):
    two = frictionless[:2]
    for more in ((), (member(3, thickness=0.5),), (member(3, friction=0.25),), (two[0],)):
        assert family_section([*two, *more]) is None


def test_each_friction_has_a_family_of_its_own(frictionless):
    sliding = [member(ratio, friction=0.25, name=f"sliding_{ratio:g}") for ratio in (0.5, 1, 2)]
    section = family_section([*sliding, *frictionless])
    assert len(section.parts) == 2
