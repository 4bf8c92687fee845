"""Change the source at random places; report the changes that no check or test catches."""

import datetime
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from rich.markup import escape

from mutation.campaign import ROOMS, ROOT, annotated, drawn
from mutation.trial import kept_trial, trial_task
from verification.commands.common.command_error import CommandError, no_result
from verification.commands.common.exit_codes import with_exit_code
from verification.commands.common.known_folders import RECORDS
from verification.commands.common.shared_options import (
    AsJson,
    Flag,
    Jobs,
    Output,
    Quiet,
    RecordsFolder,
    Resume,
)
from verification.commands.common.task_progress import run_info, solve, worker_count
from verification.commands.common.terminal import did_you_mean, print_json, print_out
from verification.commands.common.terminal_bar import require_gmsh
from verification.commands.credibility.faults import solve_clean
from verification.evidence.mutant_record import Mutant, MutantRecord, Trial, to_json, write_record
from verification.running.checked_files import locked


@with_exit_code
def mutants(
    *rooms: str,
    count: int = 400,
    seed: int = 1,
    output: Output = Path("reports/mutants"),
    record: Flag = False,
    records: RecordsFolder = RECORDS,
    jobs: Jobs = None,
    time_limit: float = 7200.0,
    resume: Resume = False,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> int:
    """Change one operator, constant, index or term at a time; report the changes that nothing catches.

    As many mutants of each room, drawn at random, meet the checks of the default run, then the unit tests of
    the room, which both have to pass without any change. It needs a source checkout that nobody edits
    meanwhile.

    Exit codes: 0 enough are caught, every survivor was read; 1 not so; 2 bad input.

    Args:
        rooms: semianalytic, fem_reference, references, judging, sampling, running; all of them unless given.
        count: Number of mutants, in all.
        seed: Seed of the random numbers.
        output: Directory of mutants.json, of the clean runs, of the trials.
        record: Store the record as RECORDS/mutants.json, for the credibility page of every report.
        time_limit: Seconds one mutant may take before it is stopped and counted as not tried.
    """
    jobs = worker_count(jobs, time_limit)
    for name in rooms:
        if name not in ROOMS:
            near = did_you_mean(name, ROOMS)
            raise CommandError(f"{name}: choose rooms of {', '.join(ROOMS)}{near}")
    if count < 1 or seed < 0:
        raise CommandError(f"--count = {count}, --seed = {seed}; only the seed may be zero, none negative")
    if record and rooms:
        raise CommandError("--record stores mutants of all rooms; leave the rooms out")
    if not (ROOT / "tests").is_dir():
        raise CommandError("this coatcheck has no unit tests beside it; run it in a source checkout")
    require_gmsh()

    chosen, silent = list(dict.fromkeys(rooms)) or list(ROOMS), quiet or as_json

    def tried(work: Sequence[tuple[str, Mutant | None]], limits: dict[str, float]) -> list[Trial]:
        kept = {one: trial for one in work if resume and (trial := kept_trial(*one, output))}
        tasks = [trial_task(*one, output, limits[one[0]]) for one in work if one not in kept]
        fresh = iter(solve(tasks, jobs, time_limit, silent))
        return [kept.get(one) or next(fresh) for one in work]

    started = datetime.datetime.now(datetime.UTC)
    with locked(output):
        checks = [ROOMS[name].checks for name in chosen]
        solve_clean(checks, output, jobs, time_limit, resume, silent)
        controls = tried([(name, None) for name in chosen], dict.fromkeys(chosen, time_limit))
        for one in controls:
            if one.catch != "survived":
                raise no_result(f"{one.room}: nothing changed, yet caught by {one.catch}: {one.by}")
        trials = tried(drawn(chosen, count, seed), {one.room: 30 + 3 * one.seconds for one in controls})
        info = run_info(f"tests/tools mutants {' '.join(rooms)} --count {count} --seed {seed}", started, jobs)
        seconds = sum(trial.seconds for trial in (*controls, *trials))
        found = MutantRecord(seed, annotated(trials), seconds, info)
        for folder in (output, *([records] if record else [])):
            write_record(folder, found)
    if as_json:
        print_json(to_json(found))
    elif not quiet:
        _print_mutants(found)
    return 0 if found.passed else 1


def _print_mutants(found: MutantRecord) -> None:
    for trial, m in found.survivors:
        text = f"{m.file}:{m.line} {m.function}: {m.change}  {trial.kind} {trial.reason}"
        print_out(f"[bold red]{trial.catch}[/] {escape(text)}")
    caught, count = found.score()
    by = ", ".join(f"{number} {catch}" for catch, number in Counter(t.catch for t in found.trials).items())
    print_out(f"{caught} of {count} mutants caught, equivalent ones apart ({by}); {found.info.seconds:.0f} s")
