"""Write the report of a run: page, JSON, JUnit XML, each of them whole or not at all."""

import json
import os
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from verification.credibility import accuracy as accuracy_study
from verification.credibility.accuracy import AccuracyStudy
from verification.regression.baseline import Regression, regression_json
from verification.report.junit import junit_xml
from verification.report.page import render
from verification.report.tables.cells import Section
from verification.running.result import SCHEMA, CaseResult, RunInfo, to_json
from verification.running.store import PART
from verification.sampling.plane import Plane

__all__ = ["report_json", "write_report"]


def write_report(
    results: Sequence[CaseResult],
    folder: Path,
    info: RunInfo,
    study: AccuracyStudy | None = None,
    extra: Sequence[Section] = (),
    planes: Mapping[str, Plane] | None = None,
    baseline: Regression | None = None,
) -> Path:
    """Write report.html, report.json and junit.xml into ``folder`` and return the path of the page.

    study : how the errors of the methods fall with resolution, where that was measured.
    extra : sections of the page about more than these results.
    planes : stresses below the contact to be drawn, by name of the case.
    baseline : what became of each number since the baseline.

    All three are made before the first is written, and each replaces its predecessor in one step, so
    that whatever goes wrong leaves the earlier report as it was. Raises OSError where the folder cannot
    be written.
    """
    texts = {
        "report.json": report_json(results, info, study, baseline),
        "junit.xml": junit_xml(results, info),
        "report.html": render(results, info, study, extra, planes, baseline),
    }
    folder.mkdir(parents=True, exist_ok=True)
    ready: dict[Path, Path] = {}
    try:
        for name, text in texts.items():
            handle, path = tempfile.mkstemp(prefix=f".{name}.", suffix=PART, dir=folder)
            ready[Path(path)] = folder / name
            with os.fdopen(handle, "wb") as file:
                # A lone surrogate in a stranger's title must not cost the whole report.
                file.write(text.encode("utf-8", errors="replace"))
                file.flush()
                os.fsync(file.fileno())
            os.chmod(path, 0o644)
        for temporary, final in ready.items():
            os.replace(temporary, final)
    finally:
        for temporary in ready:
            temporary.unlink(missing_ok=True)
    return folder / "report.html"


def report_json(
    results: Sequence[CaseResult],
    info: RunInfo,
    study: AccuracyStudy | None = None,
    baseline: Regression | None = None,
) -> str:
    """Everything the report is drawn from as strict JSON of schema ``coatcheck-report/1``."""
    data = {
        "schema": SCHEMA,
        "run": {**vars(info)},
        "cases": [to_json(result) for result in results],
        "accuracy": None if study is None else accuracy_study.to_json(study),
        "baseline": None if baseline is None else regression_json(baseline),
    }
    return json.dumps(data, allow_nan=False, ensure_ascii=True, separators=(",", ":")) + "\n"
