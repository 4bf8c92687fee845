"""The report of results, however they came about, with all that stands beside them."""

from collections.abc import Sequence
from pathlib import Path

from verification.credibility.accuracy import AccuracyStudy
from verification.regression.baseline import Regression
from verification.report import write_report
from verification.report.credibility.evidence import gather
from verification.report.credibility.faults import faults_section
from verification.report.credibility.section import credibility_section
from verification.report.credibility.self_tests import self_test_section
from verification.report.sections.effective import effective_sections
from verification.running.fields import read_planes
from verification.running.result import CaseResult, RunInfo
from verification.running.self_tests import SelfTest
from verification.running.store import StoreError
from verification.study.formulas import EffectiveStudy

__all__ = ["write"]


def write(
    results: Sequence[CaseResult],
    folder: Path,
    info: RunInfo,
    study: AccuracyStudy | None,
    beside: Regression,
    records: Path,
    tests: Sequence[SelfTest],
    formulas: EffectiveStudy | None = None,
) -> Path:
    """Write the report of ``results`` into ``folder``, where their planes lie; returns the path of the page.

    records : directory of what is known of the method's credibility.   formulas : what was measured of them.
    Raises StoreError.
    """
    evidence = gather(records)
    extra = [self_test_section(tests), credibility_section(results, info, study, evidence, beside)]
    if evidence.faults is not None:
        extra.append(faults_section(evidence.faults))
    if formulas is not None:
        extra += effective_sections(formulas)
    try:
        return write_report(results, folder, info, study, extra, read_planes(folder, results), beside)
    except OSError as error:
        said = error.strerror or error
        raise StoreError(
            f"{folder}: the report cannot be written ({said}); free space, then go on with --resume"
        ) from None
