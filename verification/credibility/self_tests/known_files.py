"""Files with known content: a case file, a published table, a stored result that is changed or damaged."""

import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from verification.cases.case_file import parse_case
from verification.cases.published_file import PublishedCase, read_published
from verification.cases.published_table import FOLDER
from verification.cases.unit_numbers import InSI, of_file
from verification.credibility.self_tests.stand_ins import Answers
from verification.judging.standard_claims import standard_claims
from verification.judging.verdict import Outcome, Verdict
from verification.problem.coated_contact import PrescribedLoad
from verification.problem.line_profile import Profile
from verification.running.case_result import CaseResult, describe, from_json, to_json
from verification.running.case_tasks import kept_result, result_path
from verification.running.checked_files import StoreError, read_checked, write_checked
from verification.running.json_records import plain
from verification.running.provenance import fingerprint


def of_case_file() -> Answers:
    text = (
        b'title = "known"\n[problem]\nradius = 10e-3\nload = 40.0\nfriction = 0.25\n'
        b"substrate = { E = 300e9, nu = 0.0 }\n"
        b"[[problem.coatings]]\nE = 600e9\nnu = 0.25\nthickness_over_a_h = 0.5\n"
        b"[[problem.coatings]]\nE = 150e9\nnu = 0.4\nthickness = 20e-6\n"
    )
    problem = parse_case(text, Path("known.toml")).problem
    # nu = 0: a_h^3 = 3 W R / 4 E = 1e-12 m^3
    yield "a_h", problem.a_h, 1e-4
    yield "p_h", problem.p_h, 6e9 / np.pi
    yield "delta_h", problem.delta_h, 1e-6
    yield "coatings", problem.coatings[1], (150e9, 0.4, 20e-6)
    yield "first coating", problem.coatings[0][:2], (600e9, 0.25)
    yield "thickness of half an a_h", problem.coatings[0][2], 5e-5
    yield "lower interface", problem.interfaces[1], 7e-5
    yield "friction", problem.friction, 0.25
    yield "3 with the unit of its file", of_file(3.0, 1e-6), 3e-6
    yield "3 um in a file of inches", of_file(InSI(3e-6), 0.0254), 3e-6
    pairs = [claim.between for claim in standard_claims(problem) if claim.line == "interface 2, lower side"]
    yield "pairs of sources on the lowest line", len(set(pairs)), 3


def of_published_table() -> Answers:
    case = read_published(FOLDER / "kenpave_three_layer_axis.toml")
    inch, psi = 0.0254, 4.4482216152605 / 0.0254**2
    column = {(p.profile.quantity, p.column): p for p in case.columns}
    stress = column["sigma_zz", "Vertical_Stress"]
    assert stress.profile.uncertainty is not None
    yield "a compression of 84.247 psi", float(stress.profile.value[2]), -84.247 * psi
    yield "at 2 in", float(stress.profile.position[2]), 2 * inch
    yield "half of its last digit", float(stress.profile.uncertainty[2]), 0.0005 * psi
    yield "corrected by its departure", float(stress.reference.value[2]), -(84.247 - 0.01184) * psi
    yield "values that count beside 8 departures", int(stress.counted.sum()), 22
    radial = column["sigma_xx", "Radial_stress"].profile
    yield "radial compression of 88.377 psi", float(radial.value[2]), -88.377 * psi
    yield "sinking by 0.02246 in", float(column["u_z", "Displacement"].profile.value[2]), 0.02246 * inch
    strain = column["eps_xx", "Radial_strain"].profile
    assert strain.uncertainty is not None
    yield "radial strain", float(strain.value[2]), -5.592e-5
    yield "half of its fourth digit", float(strain.uncertainty[2]), 0.5e-8
    yield "coatings", case.problem.coatings[0][2], 6 * inch


def of_store() -> Answers:
    case = read_published(FOLDER / "kenpave_three_layer_axis.toml")
    assert isinstance(case.problem, PrescribedLoad)
    profile = Profile("q", "l", np.array([0.1]), np.array([np.pi]), "s", np.array([np.nan]))
    verdicts = ((case.claims[0], Verdict(Outcome.AGREES, "known")),)
    said = plain(describe(case.problem))
    result = CaseResult(case.name, "known", "", said, (), (profile,), verdicts, 1.0, text=case.text)
    with tempfile.TemporaryDirectory(prefix="coatcheck-") as name:
        folder = Path(name)
        path = result_path(folder, case)

        def kept(of: PublishedCase) -> str:
            try:
                return "used again" if kept_result(folder, of) else "computed again"
            except StoreError:
                return "refused"

        yield "a result that is not there", kept(case), "computed again"
        write_checked(path, to_json(result) | {"made_by": fingerprint()})
        back = from_json(read_checked(path))
        spread = back.profiles[0].uncertainty
        yield "a number after storing", float(back.profiles[0].value[0]), float(np.pi)
        yield "a missing number after storing", spread is not None and bool(np.isnan(spread[0])), True
        yield "a result of this input", kept(case), "used again"
        yield "a result of another input", kept(replace(case, text="another input")), "refused"
        other = replace(case.problem, friction=0.1)
        yield "a result of another problem", kept(replace(case, problem=other)), "refused"
        failed = replace(result, verdicts=((case.claims[0], Verdict(Outcome.NO_RESULT, "known")),))
        write_checked(path, to_json(failed) | {"made_by": fingerprint()})
        yield "a result without an answer", kept(case), "computed again"
        write_checked(path, to_json(result) | {"made_by": fingerprint()})
        raw = path.read_bytes()
        path.write_bytes(raw.replace(b"3.14159", b"3.14158"))
        yield "a result with a changed digit", kept(case), "refused"
        path.write_bytes(raw[: len(raw) // 2])
        yield "half a result", kept(case), "refused"
        write_checked(path, to_json(result) | {"made_by": "another version"})
        yield "a result of another version", kept(case), "refused"
