"""coatcheck compare-coatings: several stacks from one table, judged side by side."""

import time
from concurrent.futures import ProcessPoolExecutor
from importlib.util import find_spec
from multiprocessing import get_context
from pathlib import Path

from rich.markup import escape

from verification.commands.common.shared_options import AsJson, Jobs, Output, Quiet
from verification.commands.common.task_progress import worker_count
from verification.commands.common.terminal import named_table, print_json, print_out, with_exit_code
from verification.commands.common.terminal_bar import progress_bar
from verification.judging.outcome import Outcome
from verification.regression.run_exit_codes import EXIT
from verification.running.checked_files import write_atomically


@with_exit_code
def compare_coatings(
    file: Path,
    /,
    *,
    output: Output = Path("coatings"),
    jobs: Jobs = None,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> int:
    """Solve every row of a table of coatings: one row of stresses each, with what fails first.

    The exit code is 3 where a row could not be solved.

    Args:
        file: CSV or XLSX with the columns name, ball, load, substrate, friction, coating 1, coating 2, ... in
            the words of coatcheck solve: "TiN 2 um, 450 GPa, 0.25, strength 2 GPa, adhesion 400 MPa"; or a
            column for each number, such as coating 1 E [GPa].
        output: Directory of coatings.csv, coatings.html and, where openpyxl is installed, coatings.xlsx.
    """
    from verification.desk.coating_table import HEADS, VERDICT, read_rows, solved_row, table_page, table_rows
    from verification.desk.table_file import MISSING, write_cells

    jobs, begin = worker_count(jobs), time.perf_counter()
    cases, rows = read_rows(file), []
    with progress_bar(silent=quiet or as_json) as bar:
        task = bar.add_task("coatings", total=len(cases))
        with ProcessPoolExecutor(min(jobs, len(cases)), mp_context=get_context("spawn")) as pool:
            for row in pool.map(solved_row, cases):
                rows.append(row)
                bar.update(task, advance=1)
    write_atomically(output / "coatings.html", table_page(rows, cases, file.name))
    files = ["coatings.csv", "coatings.html", *(["coatings.xlsx"] if find_spec("openpyxl") else [])]
    for name in (one for one in files if not one.endswith(".html")):
        write_cells(output / name, table_rows(rows))
    if as_json:
        print_json([dict(zip((*HEADS, *VERDICT), row.cells, strict=True)) for row in rows])
    elif not quiet:
        stresses, judged = (named_table(*map(escape, ("name", *some))) for some in (HEADS[2:], VERDICT[:-1]))
        for row in rows:
            style = "bold red" if row.message or (row.governing and row.governing[1].utilisation > 1) else ""
            name, _, *cells = map(escape, row.cells[:-1])
            stresses.add_row(name, *cells[: len(HEADS) - 2], style=style)
            if row.governing:
                judged.add_row(name, *cells[len(HEADS) - 2 :], style=style)
        print_out(stresses, "", *([judged] if judged.rows else []))
        for row in rows:
            if row.message:
                print_out(escape(f"{row.name}: {row.message}"))
        seconds = time.perf_counter() - begin
        made = ", ".join(str(output / name) for name in files)
        print_out(escape(f"{len(rows)} coatings in {seconds:.0f} s: {made}"))
        if len(files) < 3:
            print_out(escape(f"no coatings.xlsx: {MISSING}"))
    return EXIT[Outcome.NO_RESULT if any(row.message for row in rows) else Outcome.AGREES]
