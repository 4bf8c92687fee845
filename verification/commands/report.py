"""coatcheck report: write the report of a stored run again."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from verification.commands.common.command_error import CommandError
from verification.commands.common.known_folders import BASELINE, RECORDS, nearest_run, within_package
from verification.commands.common.shared_options import AsJson, Quiet
from verification.commands.common.terminal import print_files, with_exit_code
from verification.credibility.self_tests import self_tests
from verification.regression.baseline_change import regression
from verification.regression.baseline_file import read_baseline
from verification.regression.junit_xml import junit_xml
from verification.regression.run_exit_codes import exit_code
from verification.running.checked_files import locked


@with_exit_code
def report(
    folder: Path = Path("reports"),
    /,
    *,
    baseline: Annotated[Path | None, Parameter(name=["--baseline", "-b"])] = None,
    records: Path | None = None,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> int:
    """Write the report of a stored run again from its cases, nothing solved; a run that was stopped too.

    Args:
        folder: Directory of the run.
        baseline: Directory of a baseline to compare with instead of the run's own comparison.
        records: Directory of credibility records to show instead of those stored with the run.
    """
    from verification.report.report_material import gather, stored_material
    from verification.report.report_page import write_report

    if not (folder / "cases").is_dir():
        raise CommandError(
            f"{folder}: holds no run; write one with: coatcheck run --output {folder}{nearest_run(folder)}"
        )
    try:
        with locked(folder):
            material, whole = stored_material(folder)
            evidence = material.evidence
            if records is not None or not whole:
                place, tests = RECORDS if records is None else records, evidence.self_tests or self_tests()
                kept = {name: getattr(evidence, name) for name in ("accuracy", "baseline", "designed")}
                evidence = replace(gather(place, material.modelled, tests), **kept)
            if baseline is not None or not whole:
                place = BASELINE if baseline is None else baseline
                known, name = read_baseline(place), within_package(place)
                compared = regression(material.results, known, name, material.info)
                evidence = replace(evidence, baseline=compared)
            messages = {test.name: "" if test.passed else test.found for test in evidence.self_tests}
            junit = junit_xml(material.results, material.info, evidence.baseline, messages)
            files = [write_report(replace(material, evidence=evidence), folder, junit)]
    except ValueError as error:
        raise CommandError(str(error)) from None
    print_files(files, as_json=as_json, quiet=quiet)
    return 0 if material.results else exit_code(material.results)
