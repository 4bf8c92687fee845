"""coatcheck history: the runs that a user keeps, one after another."""

from dataclasses import asdict
from pathlib import Path

from rich.markup import escape

from verification.commands.common.command_error import CommandError
from verification.commands.common.exit_codes import with_exit_code
from verification.commands.common.known_folders import BASELINE
from verification.commands.common.shared_options import AsJson, BaselineFolder, Output, Quiet
from verification.commands.common.terminal import named_table, print_json, print_out
from verification.regression.baseline_file import read_baseline
from verification.regression.run_history import PastRun, history, reports_in
from verification.running.checked_files import StoreError, write_atomically
from verification.running.json_records import plain
from verification.running.stored_run import read_run


@with_exit_code
def past(
    *folders: Path,
    output: Output | None = None,
    baseline: BaselineFolder = BASELINE,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> int:
    """Show the kept runs from the earliest to the latest: verdicts, departure from the baseline, times.

    Each run that is to be kept goes to a directory of its own: coatcheck run --output reports/NAME. The exit
    code is 0 wherever there is a run, whatever its verdicts are.

    Args:
        folders: Directories of runs, or directories that contain them; reports unless given.
        output: Also write the history to this HTML file.
    """
    places = folders or (Path("reports"),)
    reports = reports_in(places)
    if not reports:
        message = (
            f"{', '.join(map(str, places))}: holds no report.json; keep runs with: coatcheck run --output"
        )
        raise CommandError(f"{message} reports/NAME")
    try:
        runs = history(map(read_run, reports), read_baseline(baseline))
        if output is not None:
            from verification.regression.run_history import history_page

            write_atomically(output, history_page(runs).encode("utf-8", errors="replace"))
    except StoreError as error:
        raise CommandError(str(error)) from None
    if as_json:
        print_json([plain(asdict(run)) for run in runs])
    elif not quiet:
        _print(runs)
        if output is not None:
            print_out(escape(f"page: {output}"))
    return 0


def _print(runs: tuple[PastRun, ...]) -> None:
    table = named_table("started", "commit", "agree", "departure", "seconds", "report")
    for run in runs:
        colour = "green" if run.agrees else "red"
        departure = "-" if run.departure is None else f"{run.departure:.1e}"
        table.add_row(
            run.info.started[:16].replace("T", " "),
            escape(run.info.commit or "-"),
            f"[{colour}]{run.agreeing} of {run.comparisons}[/]",
            departure,
            f"{run.info.seconds:.1f}",
            escape(run.path),
        )
    print_out(table)
    from verification.regression.run_history import history_message

    print_out(history_message(runs))
