"""Planted faults: the catalogue is whole, plants leave no trace, trials see what they must."""

import ast
import subprocess
import sys
import tomllib
from contextlib import suppress
from copy import deepcopy
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import pytest
from faults_planted.fault_anchor import Change, PlantError, definition, edited
from faults_planted.fault_campaign import record_of, row_of
from faults_planted.fault_catalogue import CONTROLS, FAULTS, LISTS
from faults_planted.fault_planting import Fault, owner_of, planted
from faults_planted.fault_trial import Check, Trial, clean_path, try_fault
from faults_planted.faults import faults
from synthetic_results import INFO

from verification.cases.case_file import read_case, shipped_cases
from verification.evidence.fault_record import Catch, Record, read_record
from verification.judging.verdict import Outcome
from verification.running import contact_run as running
from verification.running.case_result import from_json as result_from_json
from verification.running.case_result import to_json as result_to_json
from verification.running.checked_files import read_checked, write_checked
from verification.sources import source_registry

TOOLS = Path(__file__).parents[1]
ALL = tuple((FAULTS | CONTROLS).values())


def test_names_are_unique_across_the_groups():
    names = [
        entry["name"]
        for path in LISTS.glob("*.toml")
        for entry in tomllib.loads(path.read_text(encoding="utf-8"))["fault"]
    ]
    assert len(names) == len(set(names)) == len(FAULTS) + len(CONTROLS)


@pytest.mark.parametrize("fault", [f for f in ALL if f.changes], ids=lambda fault: fault.name)
def test_a_plant_fits_the_source_and_leaves_no_trace(fault):
    targets = [owner_of(change.target) for change in fault.changes]
    before = [(owner, name, vars(owner)[name]) for owner, name in targets]
    with planted(fault.changes):
        assert all(vars(owner)[name] is not original for owner, name, original in before)
    assert all(vars(owner)[name] is original for owner, name, original in before)


class OtherVariables(ast.NodeTransformer):
    """Every variable that a function sets, parameters apart, under another name."""

    def __init__(self, function):
        nodes = list(ast.walk(function))
        kept = {node.arg for node in nodes if isinstance(node, ast.arg)}
        self.set = {n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)} - kept

    def visit_Name(self, node):
        return ast.Name(f"{node.id}_now", node.ctx) if node.id in self.set else node

    def read(self, function):
        return ast.parse(ast.unparse(self.visit(deepcopy(function)))).body[0]


@pytest.mark.slow
def test_faults_stay_where_they_are_when_the_source_is_reformatted_and_most_when_all_variables_are_renamed():
    followed = 0
    for change in (change for fault in ALL for change in fault.changes if change.replace):
        module, function = definition(change.target)
        known = vars(import_module(module))
        planned = edited(function, change, known)
        reformatted = ast.parse(f"# other lines\n\n{ast.unparse(function)}").body[0]
        assert ast.dump(edited(reformatted, change, known)) == ast.dump(planned)
        names = OtherVariables(function)
        with suppress(PlantError):  # it says so where the place is not certain
            assert ast.dump(names.read(edited(names.read(function), change, known))) == ast.dump(
                names.read(planned)
            )
            followed += 1
    assert followed > 0.8 * len(FAULTS)


def test_a_function_imported_by_name_is_exchanged_there_too():
    from fem_reference.elasticity import linear_system, loading

    change = Change("fem_reference:constrained_solve", "factor(b - A @ found)", "2 * factor(b - A @ found)")
    with planted((change,)):
        assert loading.constrained_solve is linear_system.constrained_solve
        assert "planted" in loading.constrained_solve.__code__.co_filename
    assert "planted" not in loading.constrained_solve.__code__.co_filename


JUDGE = "verification.judging:judge"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (Change(JUDGE, "nowhere()", "1"), "0 times"),
        (Change(JUDGE, "U.max() >= cap", "False"), r"'U\.max\(\) > cap' is nearest"),
        (Change(JUDGE, "judged", "1"), "not once"),
        (Change(JUDGE, "U.max() > cap", "U.max()  > (cap)"), "nothing would be planted"),
        (Change(JUDGE, "U.max() > cap", "U.min() > lid"), "needs lid"),
        (Change(JUDGE, "U.max() >", "False"), "not Python"),
        (Change("verification.judging:no_such_function", "a", "b"), "in no module"),
        (Change("verification.study:judge", "a", "b"), r"in verification\.judging\.verdict"),
        (Change("verification.sampling:positions", "a", "b"), "2 definitions.*oblique"),
        (Change("fem_reference.element_numbers:SAFETY", by="6 / 2"), "nothing would be planted"),
    ],
)
def test_a_fault_that_no_longer_fits_the_source_is_refused(change, said):
    with pytest.raises(PlantError, match=said), planted((change,)):
        pass


@pytest.fixture(scope="module")
def clean(tmp_path_factory):
    """A clean run of the uncoated case in which the exact reference stands in for both methods."""
    folder = tmp_path_factory.mktemp("clean")
    case = read_case(shipped_cases()["01_uncoated_steel"])
    known = source_registry.solvers()
    exact = known["integral_equation"]
    sources = {"semianalytic": exact, "fem_reference": exact} | {
        name: known[name] for name in ("integral_equation", "hertz")
    }
    write_checked(clean_path(folder, case.name), result_to_json(running.run(case, sources)))
    return folder


def test_a_wrong_exponent_in_hertz_is_caught_by_the_comparisons_with_hertz(clean):
    fault = FAULTS["hertz_exponent"]
    row = row_of(fault, try_fault(fault, clean))
    assert row.catch is Catch.DISAGREES
    assert row.as_predicted
    assert row.columns["bare, closed form"].disagree > 20
    assert row.columns["self-tests"].disagree > 0
    assert row.change > 1


def test_hertz_is_blind_to_a_fault_of_the_coating_that_the_enclosures_see(clean):
    fault = replace(FAULTS["kernel_halved"], cases=("01_uncoated_steel",))
    row = row_of(fault, try_fault(fault, clean))
    seen = dict(row.columns)
    assert seen.pop("self-tests").disagree == 1
    assert all(one.disagree + one.inconclusive == 0 for one in seen.values())


def test_nothing_planted_is_noticed_by_no_comparison(clean):
    blank = Fault("blank", "blank", "nothing", "hertz", (), (), ("01_uncoated_steel",))
    row = row_of(blank, try_fault(blank, clean))
    assert row.catch is Catch.SURVIVED
    assert row.change == 0


@pytest.mark.slow
def test_a_check_that_fails_without_the_fault_is_no_evidence(clean, tmp_path):
    path = clean_path(clean, "01_uncoated_steel")
    result = result_from_json(read_checked(path))
    claim, verdict = result.verdicts[-1]
    spoiled = (*result.verdicts[:-1], (claim, replace(verdict, outcome=Outcome.DISAGREES)))
    write_checked(clean_path(tmp_path, result.name), result_to_json(replace(result, verdicts=spoiled)))
    fault = FAULTS["hertz_exponent"]
    whole, without = try_fault(fault, clean), try_fault(fault, tmp_path)
    assert len(without.checks) == len(whole.checks) - 1
    assert len(without.failing_clean) == 1
    assert claim.quantity in without.failing_clean[0]
    record = _record(without)
    assert record.failing_clean == without.failing_clean
    assert not record.passed


def test_drift_alone_counts_only_where_it_was_foretold():
    moved = Check("baseline", "baseline", "c", "approach", Outcome.DISAGREES, "2 of 2 values changed")
    unforeseen, foretold = FAULTS["kap_sign"], FAULTS["u_inflated_semianalytic"]
    assert row_of(unforeseen, Trial(unforeseen.name, (moved,), 1.0)).catch is Catch.SURVIVED
    assert row_of(foretold, Trial(foretold.name, (moved,), 1.0)).catch is Catch.DRIFTED


def _record(*trials: Trial) -> Record:
    return record_of(trials, INFO)


def _trial(name: str, outcome: Outcome = Outcome.DISAGREES, change: float = 0.1) -> Trial:
    check = Check("coated, exact", "approach", "14_ratio_4_sliding", "contact", outcome, "as <it> is")
    return Trial(name, (check,), change, "approach", 2.0)


def test_a_record_passes_only_where_enough_is_caught_and_nothing_is_left_unsaid():
    assert _record(_trial("nu_off_substrate"), Trial("control_published", change=0.0)).passed
    assert not _record(_trial("nu_off_substrate"), _trial("kap_x2_dropped", Outcome.AGREES)).passed
    assert not _record(_trial("nu_off_substrate", change=0.0)).passed
    assert not _record(_trial("nu_off_substrate"), _trial("control_published")).passed
    many = [_trial(name) for name in FAULTS if name != "nu_off_substrate"]
    lost = _record(*many, _trial("nu_off_substrate", Outcome.AGREES))
    assert lost.share > 0.95
    assert lost.unexplained
    assert not lost.passed


@pytest.mark.slow
def test_the_command_tries_resumes_and_writes_the_matrix(tmp_path):
    words = [sys.executable, TOOLS, "faults", "sides_swapped", "--output", tmp_path, "--jobs", "1"]
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "1 of 1" in " ".join(done.stdout.split())
    record = read_record(tmp_path)
    assert record is not None
    assert record.rows[0].as_predicted
    stamp = (tmp_path / "trials" / "sides_swapped.json").stat().st_mtime_ns
    assert subprocess.run([*words, "--resume", "--quiet"]).returncode == 0
    assert (tmp_path / "trials" / "sides_swapped.json").stat().st_mtime_ns == stamp


def test_a_mistyped_name_is_answered_with_the_nearest(capsys):
    assert faults("kapsign") == faults(group="stres") == 2
    said = capsys.readouterr().err
    assert "kap_sign" in said
    assert "stress" in said
