"""coatcheck report: write the report of a stored run again, or print it."""

import json
import sys
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from verification.commands.common import (
    BASELINE,
    EXIT,
    RECORDS,
    BaselineFolder,
    RecordsFolder,
    exit_code,
    nearest_run,
    print_error,
    within_package,
)
from verification.judging.verdict import Outcome
from verification.regression.baseline import regression
from verification.regression.record import read_baseline
from verification.running.provenance import machine
from verification.running.result import CaseResult, RunInfo, from_json, to_json
from verification.running.self_tests import self_tests
from verification.running.store import StoreError, locked, read_checked
from verification.running.stored import read_run

__all__ = ["report"]


def report(
    folder: Path = Path("reports"),
    /,
    *,
    pdf: Annotated[bool, Parameter(negative="")] = False,
    baseline: BaselineFolder = BASELINE,
    records: RecordsFolder = RECORDS,
    time_limit: float = 300.0,
    quiet: Annotated[bool, Parameter(name=["--quiet", "-q"], negative="")] = False,
    as_json: Annotated[bool, Parameter(name="--json", negative="")] = False,
) -> int:
    """Write the report of a stored run again from its cases, nothing solved; a run that was stopped too.

    Parameters
    ----------
    folder
        Directory of the run.
    pdf
        Also print the page to report.pdf there, through an installed Chromium or Chrome.
    baseline
        Directory of the baseline that every number is held against; that of the package unless given.
    records
        Directory of the records of credibility; that of the package unless given.
    time_limit
        Seconds that printing may take.
    quiet
        Print nothing but errors.
    as_json
        Print one JSON object that names the files.
    """
    from verification.credibility.accuracy import from_json as study_from_json
    from verification.credibility.accuracy import path_in
    from verification.report.assemble import write
    from verification.report.pdf import NoBrowser, printed

    if not (folder / "cases").is_dir():
        return print_error(
            f"{folder}: holds no run; write one with: coatcheck run --output {folder}{nearest_run(folder)}"
        )
    try:
        known = read_baseline(baseline)
        with locked(folder):
            results = _results(folder)
            info = _info(folder, results)
            study = None
            if path_in(folder).exists():
                study = study_from_json(read_checked(path_in(folder)))
            beside = regression(results, known, within_package(baseline), info, whole=False)
            page = write(results, folder, info, study, beside, records, self_tests())
            files = [page]
            if pdf:
                files.append(printed(page, folder / "report.pdf", time_limit))
    except NoBrowser as error:
        print_error(str(error))
        return EXIT[Outcome.NO_RESULT]
    except (StoreError, ValueError) as error:
        return print_error(str(error))
    if as_json:
        sys.stdout.write(json.dumps({"files": [str(file) for file in files]}, indent=2) + "\n")
    elif not quiet:
        sys.stdout.write("".join(f"{file}\n" for file in files))
    return 0 if results else exit_code(results)


def _results(folder: Path) -> list[CaseResult]:
    """Every stored result, in the order of the last report, then by name. Raises StoreError."""
    found = {}
    for path in sorted((folder / "cases").glob("*.json")):
        try:
            result = from_json(read_checked(path))
        except (KeyError, TypeError, ValueError) as error:
            raise StoreError(
                f"{path}: of another version ({' '.join(str(error).split())[:100]}); run the case again"
            ) from None
        found[result.name] = result
    try:
        order = [result.name for result in read_run(folder).results]
    except StoreError:
        order = []
    names = [name for name in order if name in found]
    return [found[name] for name in [*names, *(name for name in found if name not in names)]]


def _info(folder: Path, results: list[CaseResult]) -> RunInfo:
    """What the run stood on: from its report where that tells of these very results, else as far as known."""
    try:
        run = read_run(folder)
        if [to_json(r) for r in run.results] == [to_json(r) for r in results]:
            return run.info
    except StoreError:
        pass
    times = [path.stat().st_mtime for path in (folder / "cases").glob("*.json")]
    return RunInfo(
        command="coatcheck run, stopped before its report or of several runs",
        started=datetime.fromtimestamp(min(times, default=0.0), UTC).isoformat(timespec="seconds"),
        seconds=sum(result.seconds for result in results),
        jobs=1,
        commit="not recorded",
        machine=machine(),
        versions={},
    )
