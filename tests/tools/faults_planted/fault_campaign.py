"""All trials of planted faults: the clean cases, one process for each fault, their record."""

import time
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from faults_planted.fault_catalogue import CONTROLS, FAULTS
from faults_planted.fault_planting import Fault
from faults_planted.fault_trial import Check, Trial, try_fault
from verification.cases.case_file import Case, default_cases, read_case
from verification.evidence.fault_record import (
    CAUGHT,
    COLUMNS,
    EQUIVALENT_CHANGE,
    Catch,
    FaultRow,
    Record,
    Tally,
)
from verification.evidence.judged_source import source_hash
from verification.judging.verdict import Outcome
from verification.running.case_result import CaseResult, RunInfo
from verification.running.checked_files import StoreError, read_checked, write_checked
from verification.running.json_records import decode, encode
from verification.running.pool.pool_task import Task
from verification.running.provenance import CODE, fingerprint

TRIED = (*CODE, "tests.tools.faults_planted")  # the code that a trial depends on
WORST_FIRST = (Outcome.DISAGREES, Outcome.INCONCLUSIVE, Outcome.NO_RESULT)  # of those that do not pass


def clean_folder(output: Path) -> Path:
    """Folder of the clean runs of the cases."""
    return output / "clean"


def clean_cases(faults: Sequence[Fault]) -> list[Case]:
    """The cases of all trials, which have to be solved without a fault first."""
    shipped = default_cases()
    return [read_case(shipped[name]) for name in sorted({name for fault in faults for name in fault.cases})]


def cost(fault: Fault) -> float:
    """Approximate cost of a trial in semi-analytical solutions."""
    share = {"semianalytic": 1.0, "fem_reference": 3.0}
    return len(fault.cases) * sum(share.get(name, 0.2) for name in fault.solve or (fault.where,))


def failed_source(clean: Sequence[CaseResult]) -> str:
    """Message on a source that fails without any fault, so that no trial is possible; empty without one."""
    for result in clean:
        for source in result.sources:
            if source.failure is not None:
                return f"{result.name} cannot be solved without any fault: {source.source}: {source.failure}"
    return ""


def trial_task(fault: Fault, output: Path) -> Task[Trial]:
    """The trial of ``fault`` in a process of its own."""
    path, clean = _path(fault, output), clean_folder(output)

    def failed(reason: str, seconds: float) -> Trial:
        return Trial(fault.name, seconds=seconds, failure=reason)

    return Task(fault.name, partial(main, fault, clean, path), path, _trial, failed)


def kept_trial(fault: Fault, output: Path) -> Trial | None:
    """The trial of an earlier run of the same fault by the same code; None without one."""
    try:
        data = read_checked(_path(fault, output))
    except StoreError:
        return None
    same = data.get("fault") == encode(fault) and data.get("made_by") == fingerprint(TRIED)
    return _trial(data) if same else None


def record_of(trials: Sequence[Trial], info: RunInfo) -> Record:
    """The record of all ``trials``, controls apart, with the provenance ``info`` of their run."""
    rows = [(trial.fault, row_of((FAULTS | CONTROLS)[trial.fault], trial)) for trial in trials]
    return Record(
        rows=tuple(row for name, row in rows if name in FAULTS),
        controls=tuple(row for name, row in rows if name in CONTROLS),
        started=info.started,
        seconds=info.seconds,
        core_seconds=sum(trial.seconds for trial in trials),
        commit=info.commit,
        machine=f"{info.machine}, {info.jobs} jobs",
        versions=dict(info.versions),
        failing_clean=tuple(sorted({message for trial in trials for message in trial.failing_clean})),
        source=source_hash("faults"),
    )


def row_of(fault: Fault, trial: Trial) -> FaultRow:
    """The row of one trial: its checks counted column by column."""
    by_column = {column: [c for c in trial.checks if c.column == column] for column in COLUMNS}
    bad = [check for check in trial.checks if not check.passed]
    decided = [c for c in bad if c.outcome is not Outcome.NO_RESULT]
    predicted = [c for c in decided if c.name in fault.predicted]
    catch = _catch(bad, fault, trial)
    return FaultRow(
        fault.name,
        fault.group,
        fault.description,
        fault.where,
        catch,
        bool(predicted),
        _worst_message(predicted or decided or bad),
        {column: _tally(checks) for column, checks in by_column.items() if checks},
        trial.change,
        trial.changed,
        trial.seconds,
        (*fault.cases, *fault.published),
        trial.failure or "",
        "" if catch in CAUGHT else fault.reason,
        "" if catch in CAUGHT else fault.remedy,
        fault.equivalent and catch is Catch.SURVIVED and trial.change <= EQUIVALENT_CHANGE,
    )


def _catch(bad: Sequence[Check], fault: Fault, trial: Trial) -> Catch:
    if trial.failure is not None:
        return Catch.NOT_TRIED
    # A changed number is not in itself an error; it counts where no other check can detect the fault.
    own = [check for check in bad if check.column != "baseline"]
    outcomes = {check.outcome for check in own}
    if Outcome.DISAGREES in outcomes:
        return Catch.DISAGREES
    if Outcome.INCONCLUSIVE in outcomes:
        return Catch.INCONCLUSIVE
    if "baseline" in fault.predicted and len(own) < len(bad):
        return Catch.DRIFTED
    return Catch.NO_RESULT if own else Catch.SURVIVED


def _tally(checks: Sequence[Check]) -> Tally:
    disagree, inconclusive, no_result = (sum(c.outcome is one for c in checks) for one in WORST_FIRST)
    message = _worst_message([check for check in checks if not check.passed])
    return Tally(len(checks), disagree, inconclusive, no_result, message)


def _worst_message(bad: Sequence[Check]) -> str:
    """Message of the worst check: the first disagreement, then the first inconclusive, then no result."""
    ranked = sorted(bad, key=lambda check: WORST_FIRST.index(check.outcome))
    return ranked[0].message if ranked else ""


def _path(fault: Fault, output: Path) -> Path:
    return output / "trials" / f"{fault.name}.json"


def _trial(data: dict[str, Any]) -> Trial:
    return decode(Trial, data["trial"])


def main(fault: Fault, clean: Path, path: Path) -> None:
    """Try ``fault`` against the clean run in ``clean`` and store its trial at ``path``."""
    made_by = fingerprint(TRIED)  # before anything is planted
    trial = try_fault(fault, clean)
    trial = replace(trial, seconds=time.process_time())  # of this process
    write_checked(path, {"made_by": made_by, "fault": encode(fault), "trial": encode(trial)})
