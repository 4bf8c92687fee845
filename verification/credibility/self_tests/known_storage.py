"""A stored result that is read back, changed or damaged."""

import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from verification.cases.published_file import PublishedCase, read_published
from verification.cases.published_table import FOLDER
from verification.credibility.self_tests.known_answers import Answers
from verification.judging.verdict import Outcome, Verdict
from verification.problem.coated_contact import PrescribedLoad
from verification.problem.line_profile import Profile
from verification.running.case_result import CaseResult, describe, from_json, to_json
from verification.running.case_tasks import kept_result, result_path
from verification.running.checked_files import StoreError, read_checked, write_checked
from verification.running.json_records import plain
from verification.running.provenance import fingerprint


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
