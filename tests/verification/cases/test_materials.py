"""The library of materials: each name is a solid on the command line, with its source beside the answer."""

import json

import pytest
from quick_case import coatcheck

from verification.cases.case_file import parse_case
from verification.cases.materials import SHIPPED, plain_name, read_materials
from verification.cases.toml_file import CaseError
from verification.desk.case_wording import case_text


def case(tmp_path, *words, **more):
    return parse_case(case_text(*words, **more).encode(), tmp_path / "options")


def test_each_name_stands_for_its_typical_values_and_its_source_is_told(tmp_path):
    for name, one in read_materials().items():
        for said in {name, one.name}:
            found = case(tmp_path, f"{said} d = 6 mm", "1 N", said, [f"{said} 2 um, strength 1 GPa"])
            assert found.problem.substrate == (one.E, one.nu)
            assert found.problem.ball == (one.E, one.nu, ())
            assert found.problem.coatings == ((one.E, one.nu, 2e-6),)
            assert one.source in found.source
            assert ("not compared with it" in found.source) == (one.checked == "no")
            assert found.limits == {"coatings.0.strength": 1e9}


def hill(C11, C12, C44):
    """Isotropic E and nu of a cubic crystal, the mean of Voigt's and Reuss's. R. Hill (1952)."""
    K = (C11 + 2 * C12) / 3
    voigt, reuss = (C11 - C12 + 3 * C44) / 5, 5 * (C11 - C12) * C44 / (4 * C44 + 3 * (C11 - C12))
    G = (voigt + reuss) / 2
    return 9 * K * G / (3 * K + G), (3 * K - 2 * G) / (2 * (3 * K + G))


@pytest.mark.parametrize(("name", "constants"), [("TiN", (625, 165, 163)), ("Si", (165.6, 63.9, 79.5))])
def test_averages_follow_from_the_elastic_constants_of_their_sources(name, constants):
    E, nu = hill(*constants)
    found = read_materials()[plain_name(name)]
    assert pytest.approx(E, rel=2e-3) == found.E / 1e9
    assert found.nu == pytest.approx(nu, abs=2e-3)


def test_a_file_of_ones_own_replaces_the_library(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(
        SHIPPED.read_text() + '[[material]]\nname = "my DLC"\nE = "180 GPa"\nnu = 0.2\nsource = "me"\n'
    )
    assert (
        case(tmp_path, "5 mm", "1 N", "Si", ["my DLC 1 um"], materials=path).problem.coatings[0][0] == 180e9
    )
    with pytest.raises(ValueError, match=r"'my DLC' is not among those of coatcheck materials"):
        case(tmp_path, "5 mm", "1 N", "Si", ["my DLC 1 um"])
    path.write_text(path.read_text().replace('"my DLC"', '"DLC"'))
    with pytest.raises(CaseError, match="DLC names two materials"):
        read_materials.__wrapped__(path)


def test_the_list_names_what_was_meant(tmp_path):
    (found,) = json.loads(coatcheck("materials", "100cr6", "--json", cwd=tmp_path).stdout)
    assert (found["name"], found["E"]) == ("100Cr6", 210e9)
    done = coatcheck("materials", "diamon", cwd=tmp_path)
    assert (done.returncode, "did you mean diamond" in done.stderr) == (2, True)
    assert coatcheck("materials", cwd=tmp_path).stdout.count("Kaye and Laby") == 24
