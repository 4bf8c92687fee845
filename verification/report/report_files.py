"""The files of a report: the page and everything it is made from as JSON."""

import json
from pathlib import Path

from verification.credibility import accuracy_study
from verification.regression.baseline_change import regression_json
from verification.report.report_material import Material
from verification.report.report_page import render
from verification.running.case_result import SCHEMA, to_json
from verification.running.checked_files import write_together
from verification.running.json_records import encode


def write_report(material: Material, folder: Path, junit: str) -> Path:
    """Write report.html and report.json into ``folder``, with ``junit`` beside them; the path of the page."""
    texts = {"report.html": render(material), "report.json": report_json(material), "junit.xml": junit}
    write_together(folder, texts)
    return folder / "report.html"


def report_json(material: Material) -> str:
    """Everything the report is made from as strict JSON of schema ``coatcheck-report/1``.

    ``evidence`` is all that ``coatcheck report`` needs beside the results; ``accuracy`` and ``baseline``
    are for other readers.
    """
    study, baseline = material.evidence.accuracy, material.evidence.baseline
    data = {
        "schema": SCHEMA,
        "run": {**vars(material.info)},
        "cases": [to_json(result) for result in material.results],
        "accuracy": None if study is None else accuracy_study.to_json(study),
        "baseline": None if baseline is None else regression_json(baseline),
        "evidence": encode(material.evidence),
    }
    return json.dumps(data, allow_nan=False, ensure_ascii=True, separators=(",", ":")) + "\n"
