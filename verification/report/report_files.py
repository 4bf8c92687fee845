"""Write the report of a run: page, JSON, JUnit XML, each of them whole or not at all."""

import json
import os
import tempfile
from pathlib import Path

from verification.credibility import accuracy_study
from verification.regression.baseline_change import regression_json
from verification.regression.junit_xml import junit_xml
from verification.report.report_material import Material
from verification.report.report_page import render
from verification.running.case_result import SCHEMA, to_json
from verification.running.checked_files import PART, StoreError
from verification.running.json_records import encode


def write_report(material: Material, folder: Path) -> Path:
    """Write report.html, report.json and junit.xml into ``folder`` and return the path of the page.

    All three are made before the first is written, and each replaces its predecessor in one step, so
    that an error leaves the earlier report as it was. Raises StoreError where the folder cannot be written.
    """
    tests = {test.name: "" if test.passed else test.found for test in material.evidence.self_tests}
    texts = {
        "junit.xml": junit_xml(material.results, material.info, material.evidence.baseline, tests),
        "report.html": render(material),
        "report.json": report_json(material),
    }
    ready: dict[Path, Path] = {}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            handle, path = tempfile.mkstemp(prefix=f".{name}.", suffix=PART, dir=folder)
            ready[Path(path)] = folder / name
            with os.fdopen(handle, "wb") as file:
                # A lone surrogate in an untrusted title must not cost the whole report.
                file.write(text.encode("utf-8", errors="replace"))
                file.flush()
                os.fsync(file.fileno())
            os.chmod(path, 0o644)
        for temporary, final in ready.items():
            os.replace(temporary, final)
    except OSError as error:
        raise StoreError(
            f"{folder}: the report cannot be written ({error.strerror or error}); free space, then continue "
            "with --resume"
        ) from None
    finally:
        for temporary in ready:
            temporary.unlink(missing_ok=True)
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
