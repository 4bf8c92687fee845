"""Plugin of pytest: ``pytest my_code/guest.toml`` examines a guest, one test for each comparison.

pytest --coatcheck-guest my_code --coatcheck-cases 01_uncoated_steel,05_ratio_4
"""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from verification.judging.verdict import Verdict


def pytest_addoption(parser: pytest.Parser) -> None:
    """The option that names a guest."""
    group = parser.getgroup("coatcheck", "examination of a contact code")
    group.addoption(
        "--coatcheck-guest", metavar="GUEST", help="directory with a guest.toml, or a guest's name"
    )
    group.addoption(
        "--coatcheck-cases", metavar="NAMES", default="", help="cases, separated by commas; all unless given"
    )


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """A guest file that is named on the command line; others of a project are left alone."""
    if file_path.name != "guest.toml":
        return None
    named = [Path(word.partition("::")[0]).resolve() for word in parent.config.args]
    chosen = parent.config.getoption("--coatcheck-guest")
    named += [Path(chosen).resolve(), (Path(chosen) / "guest.toml").resolve()] if chosen else []
    return _GuestFile.from_parent(parent, path=file_path) if file_path.resolve() in named else None


class _GuestFile(pytest.File):
    def collect(self) -> Iterator[pytest.Item]:
        """Examine the guest, then one item for each comparison."""
        import tempfile

        from verification.cases.case_file import read_case, shipped_cases
        from verification.guests.examination import examined
        from verification.guests.guest_description import read_guest
        from verification.running.pool.process_pool import run_tasks
        from verification.running.provenance import cores

        guest = read_guest(self.path)
        shipped = shipped_cases()
        names = [name for name in self.config.getoption("--coatcheck-cases").split(",") if name] or list(
            shipped
        )
        cases = [read_case(shipped[name]) for name in names]

        def solve(tasks: Any, limit: float) -> list[Any]:
            return run_tasks(tasks, jobs=cores(), time_limit=limit)

        with tempfile.TemporaryDirectory() as folder:
            found = examined(guest, cases, Path(folder), solve, cores())
        for result in found.results:
            for claim, verdict in result.verdicts:
                name = f"{result.name}-{claim.quantity}-{claim.line}"
                known = guest.known_failure(result.name, claim.quantity, claim.line)
                yield _Comparison.from_parent(self, name=name, verdict=verdict, known=known)


class _Comparison(pytest.Item):
    def __init__(self, *, verdict: "Verdict", known: str | None, **given: Any) -> None:
        super().__init__(**given)
        self.verdict = verdict
        if known is not None:
            self.add_marker(pytest.mark.xfail(reason=known, strict=True))

    def runtest(self) -> None:
        """Passes where the comparison agrees."""
        outcome = self.verdict.outcome.value
        if outcome == "UNSUPPORTED":
            pytest.skip(self.verdict.reason)
        if outcome != "AGREES":
            pytest.fail(f"{outcome}: {self.verdict.reason}", pytrace=False)

    def reportinfo(self) -> tuple[Path, None, str]:
        return self.path, None, self.name
