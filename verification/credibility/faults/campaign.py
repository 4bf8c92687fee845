"""All the trials of a run of ``coatcheck faults``: what has to be solved clean first, then fault by fault."""

from collections.abc import Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

from verification.cases.contact import Case, read_case, shipped_cases
from verification.credibility.faults.catalogue import BLANKS, FAULTS
from verification.credibility.faults.planting import Fault
from verification.credibility.faults.record import SCHEMA, Record, from_json, row_of, to_json
from verification.credibility.faults.trial import Trial, trial_from_json
from verification.running.pool import Task
from verification.running.provenance import fingerprint
from verification.running.records import plain
from verification.running.result import CaseResult
from verification.running.store import StoreError, read_checked, write_checked

__all__ = [
    "RECORD",
    "clean_cases",
    "clean_folder",
    "cost",
    "kept_trial",
    "read_record",
    "record_of",
    "trial_task",
    "unfit",
    "write_record",
]

RECORD = "faults.json"  # its name in a folder of records


def clean_folder(output: Path) -> Path:
    """Where the clean runs of the cases lie."""
    return output / "clean"


def clean_cases(faults: Sequence[Fault]) -> list[Case]:
    """Every case that the faults are tried on; all of them have to be solved without a fault first."""
    shipped = shipped_cases()
    return [read_case(shipped[name]) for name in sorted({name for fault in faults for name in fault.cases})]


def cost(fault: Fault) -> float:
    """About what a trial takes, in units of a semi-analytical solution."""
    share = {"semianalytic": 1.0, "fem_reference": 3.0}
    return len(fault.cases) * sum(share.get(name, 0.2) for name in fault.solve or (fault.where,))


def unfit(clean: Sequence[CaseResult]) -> str:
    """Why no fault can be tried: a source of a clean run that failed; empty where none did."""
    for result in clean:
        for source in result.sources:
            if source.failure is not None:
                return f"{result.name} cannot be solved without any fault: {source.source}: {source.failure}"
    return ""


def trial_task(fault: Fault, output: Path) -> Task[Trial]:
    """The trial of ``fault`` in a process of its own."""
    path = _path(fault, output)
    words = ("verification.credibility.faults.worker:main", fault.name, str(clean_folder(output)), str(path))
    return Task(fault.name, words, path, _trial, partial(_failed, fault))


def kept_trial(fault: Fault, output: Path) -> Trial | None:
    """The trial of an earlier run that still stands: the same fault, by the same code; None without one."""
    try:
        data = read_checked(_path(fault, output))
    except StoreError:
        return None
    same = data.get("fault") == plain(asdict(fault)) and data.get("made_by") == fingerprint()
    return _trial(data) if same else None


def record_of(
    trials: Sequence[Trial],
    *,
    started: str,
    seconds: float,
    commit: str | None,
    machine: str,
    versions: dict[str, str],
) -> Record:
    """The record of all ``trials``, blanks apart."""
    rows = [(trial.fault, row_of((FAULTS | BLANKS)[trial.fault], trial)) for trial in trials]
    return Record(
        rows=tuple(row for name, row in rows if name in FAULTS),
        blanks=tuple(row for name, row in rows if name in BLANKS),
        started=started,
        seconds=seconds,
        core_seconds=sum(trial.seconds for trial in trials),
        commit=commit,
        machine=machine,
        versions=versions,
        already=tuple(sorted({said for trial in trials for said in trial.already})),
    )


def write_record(path: Path, record: Record) -> None:
    """Store ``record`` as a checked file. Raises StoreError where it cannot be written."""
    write_checked(path, to_json(record))


def read_record(path: Path) -> Record | None:
    """The record stored at ``path``; None where there is none. Raises StoreError where it is damaged."""
    if not path.exists():
        return None
    data = read_checked(path)
    try:
        return from_json(data)
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise StoreError(f"{path}: not a record of {SCHEMA} ({error}); run coatcheck faults again") from None


def _path(fault: Fault, output: Path) -> Path:
    return output / "trials" / f"{fault.name}.json"


def _trial(data: dict[str, Any]) -> Trial:
    return trial_from_json(data["trial"])


def _failed(fault: Fault, reason: str, seconds: float) -> Trial:
    return Trial(fault.name, seconds=seconds, failure=reason)
