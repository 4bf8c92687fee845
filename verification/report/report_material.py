"""Material of a report: results, provenance, other evidence, of a run or read back from one."""

import json
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from datetime import UTC, datetime
from functools import cached_property, partial
from pathlib import Path
from typing import Any, TypeVar

from verification.cases.case_file import Case
from verification.credibility import accuracy_study
from verification.credibility.accuracy_study import AccuracyStudy
from verification.credibility.model_error import ModelError, judged_quantities, model_error
from verification.credibility.self_tests import SelfTest
from verification.desk.layer_limits import Designed
from verification.evidence import alarm_record, code_record, enclosure_record, fault_record
from verification.evidence.alarm_record import AlarmRecord
from verification.evidence.assumption_maps import AssumptionMaps, read_maps
from verification.evidence.code_record import CodeRecord, DesignOrder, Imports
from verification.evidence.enclosure_record import EnclosureRecord
from verification.evidence.fault_record import Record
from verification.evidence.judged_source import is_older
from verification.problem.coated_contact import CoatedContact
from verification.regression.baseline_change import Regression
from verification.report.tables.case_lookup import slug
from verification.running.case_result import CaseResult, RunInfo, from_json, to_json
from verification.running.checked_files import MAX_BYTES, StoreError, read_bounded, read_checked
from verification.running.json_records import decode
from verification.running.provenance import machine
from verification.running.stored_fields import read_planes
from verification.sampling.stress_plane import StressPlane
from verification.validation import validation_page
from verification.validation.validation_metric import ValidationRecord

T = TypeVar("T")


@dataclass(frozen=True)
class Evidence:
    """Evidence that a report shows beside the results; None or () for what is missing, see ``failures``.

    code, faults, alarms, enclosures, validation : read from records.
    accuracy : errors of the methods over resolution.
    baseline : the change of each number since the baseline.
    maps : what the assumptions of the model cost.   models : the same of each case, by its name.
    older : names of the records that judge another source than the present one.
    beyond : by case, a line for each assumption that costs too much of what the case judges.
    designed : by case, the largest stresses with the residual stresses and limits that it states.
    """

    code: CodeRecord | None = None
    faults: Record | None = None
    alarms: AlarmRecord | None = None
    failures: tuple[str, ...] = ()
    accuracy: AccuracyStudy | None = None
    baseline: Regression | None = None
    self_tests: tuple[SelfTest, ...] = ()
    enclosures: EnclosureRecord | None = None
    maps: AssumptionMaps | None = None
    older: tuple[str, ...] = ()
    validation: ValidationRecord | None = None
    models: Mapping[str, ModelError] = field(default_factory=dict)
    beyond: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    designed: Mapping[str, Designed] = field(default_factory=dict)

    @property
    def orders(self) -> tuple[DesignOrder, ...]:
        """Orders of the finite element operator."""
        return self.code.orders if self.code else ()

    @property
    def parts(self) -> tuple[Imports, ...]:
        """Imports of both methods, then of the references."""
        return self.code.parts if self.code else ()


@dataclass(frozen=True)
class Modelled:
    """A contact of the run: its problem, the quantities that are judged, the warnings about its file."""

    problem: CoatedContact
    quantities: frozenset[str]
    warnings: tuple[str, ...] = ()

    @classmethod
    def of(cls, case: Case) -> "Modelled":
        """The contact of a case file."""
        return cls(case.problem, frozenset(claim.quantity for claim in case.claims), case.warnings)


def gather(
    records: Path, contacts: Mapping[str, Modelled] | None = None, self_tests: Sequence[SelfTest] = ()
) -> Evidence:
    """Evidence that no result changes: read from the directory ``records``, or modelled.

    contacts : the contacts of the run by the name of their case, of which the error of the model is found.
    """
    known, failures = contacts or {}, list[str]()

    def attempt(what: str, measure: Callable[[], T], otherwise: T) -> T:
        try:
            return measure()
        except Exception as error:  # one row of the page, never the report
            message = str(error) if isinstance(error, StoreError) else f"{what}: {error}"
            failures.append(" ".join(message.split())[:300])
            return otherwise

    readers: dict[str, Callable[[Path], Any]] = {
        "code": code_record.read_record,
        "faults": fault_record.read_record,
        "alarms": alarm_record.read_record,
        "enclosures": enclosure_record.read_record,
        "maps": read_maps,
        "validation": lambda _: validation_page.shipped(),
    }
    found = {name: attempt(name, partial(read, records), None) for name, read in readers.items()}
    models = {
        name: attempt(
            f"error of the model, {name}", partial(model_error, one.problem, found["maps"]), ModelError(())
        )
        for name, one in known.items()
    }
    return Evidence(
        **found,
        failures=tuple(failures),
        self_tests=tuple(self_tests),
        older=tuple(name for name, made in found.items() if made is not None and is_older(name, made)),
        models=models,
        beyond={
            name: models[name].warnings(judged_quantities(one.quantities), one.warnings)
            for name, one in known.items()
        },
    )


@dataclass(frozen=True, eq=False)
class ReportMaterial:
    """Everything a report is made from.   planes : stresses below the contact, by name of the case."""

    results: Sequence[CaseResult]
    info: RunInfo
    evidence: Evidence = field(default_factory=Evidence)
    planes: Mapping[str, StressPlane] = field(default_factory=dict)

    @cached_property
    def contacts(self) -> list[CaseResult]:
        """The results of cases that are not published sources."""
        return [result for result in self.results if not result.published]

    @property
    def modelled(self) -> dict[str, Modelled]:
        """The contacts by the names of their cases, as ``gather`` takes them."""
        names = {one.name for one in fields(CoatedContact)}
        return {
            result.name: Modelled(
                decode(CoatedContact, {k: v for k, v in result.problem.items() if k in names}),
                frozenset(claim.quantity for claim, _ in result.verdicts),
                result.warnings,
            )
            for result in self.contacts
        }

    @cached_property
    def published(self) -> list[CaseResult]:
        """The results of published sources."""
        return [result for result in self.results if result.published]

    @cached_property
    def anchors(self) -> Mapping[CaseResult, str]:
        """A readable anchor for each case; two cases with one name get different ones."""
        taken: Counter[str] = Counter()
        anchors = {}
        for result in self.results:
            name = f"case-{slug(result.name)}"
            taken[name] += 1
            anchors[result] = name if taken[name] == 1 else f"{name}--{taken[name]}"
        return anchors


def stored_material(folder: Path) -> tuple[ReportMaterial, bool]:
    """The material of the run in ``folder``, and whether its evidence is that of the run.

    Where report.json is missing or of other results, as after a run that was stopped, provenance and
    evidence are those that can be had without it. Raises StoreError.
    """
    found = {}
    for path in sorted((folder / "cases").glob("*.json")):
        try:
            result = from_json(read_checked(path))
        except (KeyError, TypeError, ValueError) as error:
            message = " ".join(str(error).split())[:100]
            raise StoreError(f"{path}: of another version ({message}); run the case again") from None
        found[result.name] = result
    last = _last_report(folder)
    order = [case.get("name") for case in last.get("cases", [])]
    results = [found[name] for name in dict.fromkeys([*(n for n in order if n in found), *found])]
    planes = read_planes(folder, results)
    try:
        if [to_json(result) for result in results] == last["cases"]:
            info, evidence = decode(RunInfo, last["run"]), decode(Evidence, last["evidence"])
            return ReportMaterial(results, info, evidence, planes), True
    except (KeyError, ValueError):
        pass
    times = [path.stat().st_mtime for path in (folder / "cases").glob("*.json")]
    info = RunInfo(
        command="coatcheck run, stopped before its report or of several runs",
        started=datetime.fromtimestamp(min(times, default=0.0), UTC).isoformat(timespec="seconds"),
        seconds=sum(result.seconds for result in results),
        jobs=1,
        commit="not recorded",
        machine=machine(),
        versions={},
    )
    path = accuracy_study.task(folder).path
    accuracy = accuracy_study.from_json(read_checked(path)) if path.exists() else None
    return ReportMaterial(results, info, Evidence(accuracy=accuracy), planes), False


def _last_report(folder: Path) -> dict[str, Any]:
    try:
        data = json.loads(read_bounded(folder / "report.json", MAX_BYTES))
        return data if isinstance(data, dict) and all(isinstance(c, dict) for c in data["cases"]) else {}
    except (StoreError, ValueError, KeyError, TypeError, RecursionError):
        return {}
