"""History of the runs that a user keeps: verdicts, departure from the baseline, times."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from verification.judging.verdict import Outcome
from verification.regression.baseline_change import Baseline, case_drift
from verification.running.case_result import CaseResult, RunInfo
from verification.running.stored_run import StoredRun


@dataclass(frozen=True)
class PastCase:
    """One case of a run.

    difference : the largest |A - B| over its scale.
    departure : the largest change of a value since the baseline, over what is allowed on any machine; None
    where the baseline lacks the case or samples other points.
    """

    name: str
    title: str
    outcome: Outcome
    agreeing: int
    comparisons: int
    seconds: float
    difference: float | None
    departure: float | None


@dataclass(frozen=True)
class PastRun:
    """One run: the ``path`` of its report.json, its provenance, its cases."""

    path: str
    info: RunInfo
    cases: tuple[PastCase, ...]

    @property
    def agreeing(self) -> int:
        """Number of comparisons that agree."""
        return sum(case.agreeing for case in self.cases)

    @property
    def comparisons(self) -> int:
        """Number of comparisons."""
        return sum(case.comparisons for case in self.cases)

    @property
    def agrees(self) -> bool:
        """True where every case agrees."""
        return all(case.outcome is Outcome.AGREES for case in self.cases)

    @property
    def difference(self) -> float | None:
        """The largest |A - B| of all comparisons over its scale."""
        return max((case.difference for case in self.cases if case.difference is not None), default=None)

    @property
    def departure(self) -> float | None:
        """The largest departure of a case."""
        return max((case.departure for case in self.cases if case.departure is not None), default=None)

    def seconds(self, name: str) -> float | None:
        """Seconds of the case ``name``; None where it was not run."""
        return next((case.seconds for case in self.cases if case.name == name), None)


def reports_in(folders: Iterable[Path]) -> list[Path]:
    """The report.json of each of ``folders`` and of the folders in it."""
    found = {}
    for folder in folders:
        for path in (folder / "report.json", *sorted(folder.glob("*/report.json"))):
            if path.is_file():
                found[path.resolve()] = path
    return list(found.values())


def history(runs: Iterable[StoredRun], baseline: Baseline | None) -> tuple[PastRun, ...]:
    """The ``runs`` from the earliest to the latest, all of them compared with the same ``baseline``."""
    past = [
        PastRun(str(run.path), run.info, tuple(_case(result, baseline) for result in run.results))
        for run in runs
    ]
    return tuple(sorted(past, key=lambda run: run.info.started))


def _case(result: CaseResult, baseline: Baseline | None) -> PastCase:
    differences = [v.difference for _, v in result.verdicts if v.difference is not None]
    return PastCase(
        result.name,
        result.title,
        result.outcome,
        sum(verdict.outcome is Outcome.AGREES for _, verdict in result.verdicts),
        len(result.verdicts),
        result.seconds,
        max(differences, default=None),
        case_drift(result, baseline).departure if baseline is not None else None,
    )
