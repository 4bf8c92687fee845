"""Implausible input on terminal, page and in JSON; an option refuses it."""

import json
from dataclasses import replace

from case_texts import case_text
from quick_case import coatcheck
from synthetic_results import INFO, contact, result_of

from verification.report.report_material import Material
from verification.report.report_page import render
from verification.running.case_result import from_json, to_json

LINE = "load = 3 <looks> like mN"


def test_result_and_page_have_them():
    result = replace(result_of(contact(), points=5), warnings=(LINE,))
    assert from_json(json.loads(json.dumps(to_json(result)))).warnings == (LINE,)
    page = render(Material([result], INFO))
    assert "load = 3" in page
    assert "Implausible:" in page
    assert "Implausible:" not in render(Material([result_of(contact(), points=5)], INFO))


def test_run_refuses_an_implausible_case_when_strict(tmp_path):
    path = tmp_path / "slip.toml"
    path.write_text(case_text(radius="10"))
    done = coatcheck("run", str(path), "--strict", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith("coatcheck: slip: ")
    assert done.stderr.count("\n") == 1
