"""The way of a case through ``coatcheck run``, as JSON: ``python tests/tools/case_path.py CASE OUTPUT``.

Each entry is a function of ``verification`` that is given the case, its result or the material of the report,
alone or in a list or mapping, with the file it is called from, in the order of the first calls.
"""

import inspect
import json
import sys
from pathlib import Path

from verification.cli import main
from verification.commands.common import task_progress
from verification.report import report_page
from verification.running.checked_files import read_checked

ROOT = Path(report_page.__file__).parents[2]
GIVEN = {"Case", "PublishedCase", "_CaseFile", "CaseResult", "ReportMaterial"}
found = {}


def is_given(argument):
    if isinstance(argument, dict):
        return any(map(is_given, (*list(argument)[:1], *list(argument.values())[:1])))
    if isinstance(argument, list | tuple):
        argument = argument[0] if argument else None
    kind = type(argument)
    return kind.__name__ in GIVEN and kind.__module__.startswith(("verification.cases", "verification.r"))


def run_here(tasks, *, started, finished, meanwhile, **_):
    """In place of the pool, whose processes a profile does not see; self-tests have cases of their own."""
    sys.setprofile(None)
    meanwhile()
    sys.setprofile(note)
    results = []
    for task in tasks:
        started(task.name)
        task.path.parent.mkdir(parents=True, exist_ok=True)
        task.work()
        results.append(task.read(read_checked(task.path)))
        finished(task.name, results[-1])
    return results


def file_of(frame):
    """The file below ``verification``, if any, from which the frame's function was called."""
    while frame := frame.f_back:
        if (path := Path(frame.f_code.co_filename)).is_relative_to(ROOT / "verification"):
            return path.relative_to(ROOT).as_posix()
    return None


def note(frame, event, _):
    code = frame.f_code
    if event != "call" or "/verification/" not in code.co_filename:
        return
    names, *more, held = inspect.getargvalues(frame)
    key = (Path(code.co_filename).relative_to(ROOT).as_posix(), code.co_qualname)
    if key not in found and any(is_given(held.get(name)) for name in (*names, *more)):
        found[key] = file_of(frame)


if __name__ == "__main__":
    case, output = sys.argv[1:]
    task_progress.run_tasks = run_here
    sys.argv = ["coatcheck", "run", case, "--output", output, "--quiet"]
    sys.setprofile(note)
    try:
        code = main()
    except SystemExit as end:
        code = end.code
    sys.setprofile(None)
    json.dump([(*key, caller) for key, caller in found.items()], sys.stdout)
    sys.exit(code)
