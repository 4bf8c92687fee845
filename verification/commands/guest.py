"""coatcheck guest: contact codes of others, examined."""

import datetime
import json
import shlex
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import numpy as np
from cyclopts import Parameter
from rich.markup import escape

from verification.cases.case_file import Case, default_cases, read_case
from verification.commands.common.command_error import CommandError
from verification.commands.common.known_folders import PACKAGE
from verification.commands.common.named_files import SHIPPED, path_of, require_distinct
from verification.commands.common.shared_options import AsJson, Flag, Jobs, Quiet
from verification.commands.common.task_progress import run_info, solve, worker_count
from verification.commands.common.terminal import (
    STYLE,
    named_table,
    one_line,
    print_json,
    print_out,
    with_exit_code,
)
from verification.guests.exam_subjects import exact_profile, subject_of
from verification.guests.examination import Examined, examined, outcome_counts, packed_cases
from verification.guests.guest_description import FILE, Guest, parse_guest, read_guest
from verification.guests.guest_protocol import Question
from verification.guests.pages.guest_page import badge, summary
from verification.guests.pages.guest_page import page as render
from verification.judging.outcome import Outcome, worst
from verification.page.number_text import engineering
from verification.problem.line_profile import coordinate_of
from verification.problem.quantity import unit_of
from verification.regression.junit_xml import junit_xml
from verification.regression.run_exit_codes import EXIT
from verification.running.case_result import RunInfo, to_json
from verification.running.checked_files import locked, write_atomically

Folder = Annotated[Path | None, Parameter(name=["--output", "-o"])]
UNLIKE = "08_dlc_chromium_steel"  # two coatings, of another thickness and modulus each
UNCOATED, COATED = ("01_uncoated_steel", "13_uncoated_sliding"), ("05_ratio_4", "14_ratio_4_sliding", UNLIKE)
MOST_SHOWN, MOST_REASONS = 5, 12  # wrong answers of a case, reasons
REPORT = "coatcheck-guest-report/1"
EXAMPLES, PROTOCOL = (PACKAGE / "guests" / name for name in ("examples", "PROTOCOL.md"))
PACKED = """name = "my results"
results = "answers"               # directory of the files to fill in
claim = 0.01                      # relative; needed where no uncertainty is given
edge = 0.05                       # of a: half-width of a zone around the contact edge that is left out
supports = { coatings = 50, friction = true, stress = true }
# [units]                         # if not SI, before coatcheck guest pack
# length = "mm"
# stress = "MPa"
"""


@with_exit_code
def init(folder: Path, /, *, program: Flag = False) -> int:
    """Write a guest file with an adapter that runs as it is: Hertz, to be replaced by a call of the code.

    Args:
        folder: Directory to make; files that are there stay as they are.
        program: Write an adapter that is a program of its own, with questions and answers as lines of JSON.
    """
    source = EXAMPLES / ("program" if program else "start")
    for name in (FILE, "adapter.py"):
        if (folder / name).exists():
            raise CommandError(f"{folder / name}: is there already; choose another directory")
    name = "".join(c for c in folder.resolve().name if c.isprintable() and c not in '"\\')[:60] or "my code"
    text = (source / FILE).read_text(encoding="utf-8")
    text = f'name = "{name}"\n{text.partition(chr(10))[2]}\n# all keys, and the protocol: {PROTOCOL}\n'
    parse_guest(text.encode(), folder / FILE)
    write_atomically(folder / FILE, text)
    write_atomically(folder / "adapter.py", (source / "adapter.py").read_bytes())
    print_out(escape(f"{folder / FILE}, {folder / 'adapter.py'}; next: coatcheck guest check {folder}"))
    return 0


@with_exit_code
def pack(
    folder: Path, /, *cases: str, mesh_hint: Flag = False, jobs: Jobs = None, quiet: Quiet = False
) -> int:
    """Write every problem as JSON with its points as CSV, for codes that cannot be called.

    Fill in contact.csv and points.csv of each problem, leave empty what the code does not give; or put a file
    of nodes beside them: .frd, .vtu or nodes.csv. Then run coatcheck guest judge. A guest.toml in the
    directory is used; otherwise one is written.

    Args:
        folder: Directory to make; files that are there stay as they are.
        cases: Names of shipped cases, see coatcheck list, or .toml files; all shipped ones unless given.
        mesh_hint: Also show where the points of each problem lie, for a mesh that resolves them.
    """
    jobs = worker_count(jobs)
    chosen = _chosen(cases)
    if not (folder / FILE).exists():
        write_atomically(folder / FILE, PACKED)
    guest = read_guest(folder)
    if guest.results is None:
        raise CommandError(f'{folder / FILE}: results is missing; results = "answers" names the directory')
    with locked(folder / "report"):
        packed = packed_cases(guest, chosen, folder / "report", lambda t, limit: solve(t, jobs, limit, quiet))
    if mesh_hint:
        _print_mesh(guest, packed)
    line = f"{len(packed)} problems in {folder / guest.results}; next: fill in their CSV files, then "
    print_out(escape(f"{line}coatcheck guest judge {folder}"))
    return 0


def _print_mesh(guest: Guest, questions: Sequence[Question]) -> None:
    """Prints where the points of each question lie and how close together, in the units of the guest."""
    heads = ("contact edge at r =", "interfaces at z =", "farthest r", "deepest z", "closest points")
    table = named_table("problem", *heads)
    for one in questions:
        lines = [np.array([q.x, q.y, q.z]) for q in one.lines if q.body == "flat"]
        radius = max((np.hypot(*s[:2]).max() for s in lines), default=0.0)
        depth = max((s[2].max() for s in lines), default=0.0)
        close = min((np.linalg.norm(np.diff(s), axis=0).min(initial=np.inf) for s in lines), default=np.inf)
        depths = ", ".join(f"{z:.4g}" for z in np.cumsum([c.thickness for c in one.problem.coatings]))
        shown = [f"{v:.3g}" for v in (radius, depth, close)]
        table.add_row(escape(one.id), f"{one.edge:.4g}", depths or "-", *shown)
    print_out(table)
    print_out(f"[dim]lengths in {guest.units.length}[/]")


@with_exit_code
def run(
    guest: str,
    /,
    *cases: str,
    output: Folder = None,
    jobs: Jobs = None,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> int:
    """Examine a guest on the shipped cases that it supports, at points that the suite chooses.

    The exact reference is the judge. The uncertainty is what the guest states, or that of its refinement
    study; without either its differences are compared with what it claims.

    Exit codes: 0 what it answered agrees; 1 a disagreement, or a known failure that agrees; 2 a guest file
    that cannot be used; 3 no result; 4 inconclusive.

    Args:
        guest: Directory with a guest.toml, or that file.
        cases: Names of shipped cases, see coatcheck list, or .toml files; unless given all shipped
            ones, for files those that were packed.
        output: Directory of report.html, report.json, junit.xml, badge.svg; GUEST/report unless given.
    """
    jobs = worker_count(jobs)
    host = read_guest(guest)
    chosen = _chosen(cases or _packed(host))
    folder = output or host.folder / "report"
    begin, started = time.perf_counter(), datetime.datetime.now(datetime.UTC)
    silent = quiet or as_json
    with locked(folder):
        found = examined(host, chosen, folder, lambda tasks, limit: solve(tasks, jobs, limit, silent), jobs)
        info = run_info(shlex.join(["coatcheck", "guest", "run", guest, *cases]), started, jobs)
        page = folder / "report.html"
        texts = {
            "junit.xml": junit_xml(found.results, info, skipped=(Outcome.UNSUPPORTED, Outcome.INCONCLUSIVE)),
            "report.json": report_json(found, info),
            "badge.svg": badge(found),
            "report.html": render(found, info),
        }
        for name, text in texts.items():
            write_atomically(folder / name, text)
    code = exit_code(found)
    if as_json:
        print_json(
            {
                "guest": host.name,
                "exit_code": code,
                "cases": {r.name: dict(outcome_counts([r])) for r in found.results},
                "known": found.known,
                "unexpected": found.unexpected,
            }
        )
    elif not quiet:
        _print(found, time.perf_counter() - begin, page)
    return code


@with_exit_code
def check(guest: str, /, *, output: Folder = None, jobs: Jobs = None, as_json: AsJson = False) -> int:
    """Ask a guest an uncoated, two coated, a sliding problem; show its answers beside the exact ones.

    What is wrong is compared with what common slips would give: another problem solved (half of the load, E
    for E*, coatings exchanged), units, signs, axes, a for 2a, a shift by half a cell. A slip is named only
    where it explains nine tenths of what is wrong. Exit codes as of run.

    Args:
        guest: Directory with a guest.toml, or that file.
        output: Directory of the answers; GUEST/check unless given.
    """
    jobs = worker_count(jobs)
    host = read_guest(guest)
    folder = output or host.folder / "check"
    names = (UNCOATED[0], *COATED) if host.supports.coatings else UNCOATED
    chosen = [case for case in _chosen(names) if host.refusal(case.problem) is None]
    with locked(folder):
        found = examined(host, chosen, folder, lambda tasks, limit: solve(tasks, jobs, limit, as_json), jobs)
    code = exit_code(found)
    if as_json:
        slips = {
            name: {case: cause.message for case, cause in by.items()} for name, by in found.causes.items()
        }
        print_json({"guest": host.name, "exit_code": code, "slips": slips})
        return code
    line = f"{host.name}: {found.total[Outcome.AGREES]} of {found.answered} comparisons agree"
    print_out(escape(line + ("; next: coatcheck guest run " + shlex.quote(guest) if not code else "")))
    _print_causes(found)
    _print_beside(found)
    _print_missing(found)
    return code


def _print_causes(found: Examined) -> None:
    """Remarks on the answers; each likely slip, with how many wrong answers it explains in which cases."""
    for text, count in found.remarks.items():
        print_out(f"[bold]->[/] {escape(one_line(text))}" + (f" ({count} cases)" if count > 1 else ""))
    for by in found.causes.values():
        message = next(iter(by.values())).message
        count = len({(case, *place) for case, cause in by.items() for place in cause.places})
        text = f"{message} Explains {count} wrong answers in {', '.join(by)}"
        print_out(f"[bold]->[/] {escape(one_line(text))}")


def _print_beside(found: Examined) -> None:
    """The answers that no named slip explains beside the exact ones: numbers and what is wrong."""
    table = named_table(
        "case", "quantity", "line", "at", "guest", "exact", "guest/exact", "difference", "verdict"
    )
    left: Counter[str] = Counter()
    for result, claim, verdict in found.comparisons:
        mine = result.profile_of.get((claim.quantity, claim.line, found.guest.name))
        exact = exact_profile(result, claim.quantity, claim.line)
        explained = (result.name, claim.quantity, claim.line) in found.explained
        if verdict.outcome is Outcome.UNSUPPORTED or mine is None or exact is None or explained:
            continue
        number, agrees = claim.line == "contact", verdict.outcome is Outcome.AGREES
        if agrees and not number:
            continue
        if not agrees:
            left[result.name] += 1
            if left[result.name] > MOST_SHOWN:
                continue
        # The point that decides, or where the exact value is largest.
        worst = verdict.worst if verdict.worst is not None else exact.position[np.abs(exact.value).argmax()]
        i = int(np.abs(exact.position - worst).argmin())
        at = "" if number else f"{coordinate_of(claim.line)} = {worst:.3g} m"
        shown = [engineering(p.value[i], unit_of(claim.quantity), 6) for p in (mine, exact)]
        ratio = f"{mine.value[i] / exact.value[i]:.4g}" if exact.value[i] else "-"
        gap = "-" if verdict.difference is None else f"{verdict.difference:.1e}"
        word = f"[{STYLE[verdict.outcome]}]{verdict.outcome}[/]"
        line = "" if number else claim.line
        table.add_row(escape(result.name), claim.quantity, line, at, *shown, ratio, gap, word)
    if table.rows:
        print_out(table)
    for name, count in left.items():
        if count > MOST_SHOWN:
            print_out(
                f"{escape(name)}: {count - MOST_SHOWN} more that no slip explains; guest run shows them"
            )


def _print_missing(found: Examined) -> None:
    """Why there is no result, and what was left out, a line for each reason."""
    failures = Counter(s.failure for r in found.results for s in r.sources if s.failure)
    for failure, count in failures.items():
        print_out(f"[bold red]no result of {count} cases:[/] {escape(one_line(failure))}")
    missing: dict[str, list[str]] = {}
    for _, claim, verdict in found.comparisons:
        if verdict.outcome is Outcome.UNSUPPORTED:
            missing.setdefault(verdict.reason, []).append(claim.quantity)
    for reason, of in missing.items():
        quantities = ", ".join(dict.fromkeys(of))
        print_out(f"[dim]{len(of)} comparisons left out, of {quantities}: {escape(one_line(reason))}[/]")


def report_json(found: Examined, info: RunInfo) -> str:
    """The results as JSON, for other programs."""
    content = {"schema": REPORT, **summary(found), "run": vars(info)}
    cases = [to_json(result) for result in found.results]
    return json.dumps(content | {"results": cases}, allow_nan=False, separators=(",", ":")) + "\n"


def exit_code(found: Examined) -> int:
    """The code of the worst verdict that is not a known failure."""
    outcomes = {v.outcome for r, c, v in found.comparisons if found.guest.known_failure(r.name, c) is None}
    if found.unexpected:
        outcomes.add(Outcome.DISAGREES)
    if found.known and not outcomes & EXIT.keys():
        return EXIT[Outcome.AGREES]
    return EXIT[worst(outcomes)]


def _chosen(names: Sequence[str]) -> list[Case]:
    shipped = default_cases()
    cases = [read_case(path_of(name, shipped, SHIPPED)) for name in names or shipped]
    require_distinct([case.name for case in cases])
    exact = [case for case in cases if subject_of(case).claims]
    if names and exact != cases:
        name = next(case.name for case in cases if case not in exact)
        raise CommandError(f"{name}: no exact values are known for it; leave it out")
    return exact


def _packed(guest: Guest) -> list[str]:
    """The shipped cases whose files were written for ``guest`` to fill in; none of a guest that is called."""
    if guest.results is None:
        return []
    place = guest.folder / guest.results
    found = [name for name in default_cases() if (place / name).is_dir()]
    if not found:
        raise CommandError(f"{place}: holds no shipped case; run guest pack, or name the case files")
    return found


def _print(found: Examined, seconds: float, page: Path) -> None:
    table = named_table("case", *(o.replace("_", " ").lower() for o in Outcome), "largest", "s")
    for result in found.results:
        counts = outcome_counts([result])
        if counts.keys() == {Outcome.UNSUPPORTED}:
            continue
        worst = max((v.difference for _, v in result.verdicts if v.difference is not None), default=None)
        cells = [f"[{STYLE[o]}]{counts[o]}[/]" if counts[o] else "." for o in Outcome]
        taken = f"{result.seconds:.1f}" if result.seconds else "-"
        table.add_row(escape(result.name), *cells, "-" if worst is None else f"{worst:.1e}", taken)
    print_out(table)
    listed = "listed as a known failure"
    for name, why in found.unexpected:
        print_out(f"[bold red]{escape(name)}:[/] {listed} ({escape(why)}), but agrees")
    _print_causes(found)
    for line in _reasons(found):
        print_out(line)
    agree = f"{found.guest.name}: {found.total[Outcome.AGREES]} of {found.answered} comparisons agree"
    cases = f"{len(found.results)} cases in {seconds:.0f} s; report: {page}"
    print_out(escape(f"{agree}, {found.total[Outcome.UNSUPPORTED]} unsupported; {cases}"))


def _reasons(found: Examined) -> list[str]:
    """A line for each reason of disagreements that no named slip explains, at most a few."""
    seen: dict[str, Counter[str]] = {}
    for result, claim, verdict in found.comparisons:
        if verdict.outcome in (Outcome.AGREES, Outcome.UNSUPPORTED):
            continue
        if (result.name, claim.quantity, claim.line) in found.explained:
            continue
        # Without its numbers a reason is that of many comparisons.
        what = verdict.reason if verdict.difference is None else f"{verdict.outcome}: {claim.quantity}"
        seen.setdefault(what, Counter())[result.name] += 1
    lines = [
        f"[bold red]->[/] {escape(one_line(what))} ({cases.total()} comparisons of {', '.join(cases)})"
        for what, cases in seen.items()
    ]
    more = [f"{len(lines) - MOST_REASONS} more reasons, see the report"] if len(lines) > MOST_REASONS else []
    return lines[:MOST_REASONS] + more
