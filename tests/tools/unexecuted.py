"""Statements of both methods that neither the default run nor the fast tests execute."""

import ast
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from verification.commands.common.terminal import print_out

ROOT = Path(__file__).parents[2]
METHODS = ("semianalytic", "fem_reference")
RUNS = {
    "default run": ("-m", "verification.cli", "run", "--output", "{folder}"),
    "fast tests": ("-m", "pytest", "-q", "-n", "2", "--timeout", "0", "-p", "no:cacheprovider"),
}
HEADERS = (ast.If, ast.For, ast.While, ast.With, ast.Try, ast.Match)
NO_STATEMENT = (
    ast.FunctionDef,
    ast.ClassDef,
    ast.Import,
    ast.ImportFrom,
    ast.Raise,
    ast.Assert,
    ast.Pass,
    ast.Try,
)


def unexecuted(*, traces: Path | None = None) -> int:
    """List the statements of both methods that neither the default run nor the fast tests execute.

    Refusals, which raise an error, are left out: tests of bad input reach them. Without --traces both are run
    first, some 20 minutes.

    Exit codes: 0 every statement is executed; 1 some are not.

    Parameters
    ----------
    traces
        File of executed lines that runs with LINE_TRACE wrote (`line_trace/sitecustomize.py`), each after the
        other: among all tests a worker may lose its trace, and tests of some rooms alone add what it missed.
    """
    with tempfile.TemporaryDirectory() as folder:
        if traces is None:
            traces = Path(folder) / "lines"
            for arguments in RUNS.values():
                command = [sys.executable, *(one.format(folder=folder) for one in arguments)]
                subprocess.run(command, cwd=ROOT, env=traced(traces), check=False)
        found = list(missing(set(traces.read_text(encoding="utf-8").split())))
    for place, text in found:
        print_out(f"{place}  {text}")
    print_out(f"{len(found)} statements are never executed")
    return int(bool(found))


def traced(file: Path) -> dict[str, str]:
    """Environment in which Python notes the executed lines of both methods in ``file``."""
    here = str(Path(__file__).parent / "line_trace")
    path = os.pathsep.join(filter(None, (here, os.environ.get("PYTHONPATH"))))
    return os.environ | {"PYTHONPATH": path, "LINE_TRACE": str(file)}


def missing(executed: set[str]) -> Iterator[tuple[str, str]]:
    """Place and first line of each statement in a function of the methods, no line of which was executed."""
    for path in sorted(path for method in METHODS for path in (ROOT / method).rglob("*.py")):
        text, name = path.read_text(encoding="utf-8"), path.relative_to(ROOT).as_posix()
        lines = text.splitlines()
        for function in (node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef)):
            for node in statements(function):
                last = node.body[0].lineno - 1 if isinstance(node, HEADERS) else node.end_lineno or 0
                reached = range(node.lineno, max(last, node.lineno) + 1)
                if not any(f"{name}:{line}" in executed for line in reached):
                    yield f"{name}:{node.lineno}", lines[node.lineno - 1].strip()


def statements(function: ast.FunctionDef) -> Iterator[ast.stmt]:
    """Statements of a function that compute, without those of functions inside it."""
    held = list(function.body)
    while held:
        node = held.pop(0)
        documents = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        if not isinstance(node, NO_STATEMENT) and not documents:
            yield node
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            continue
        parts = [*getattr(node, "body", []), *getattr(node, "orelse", []), *getattr(node, "finalbody", [])]
        parts += [
            one for part in (*getattr(node, "handlers", []), *getattr(node, "cases", [])) for one in part.body
        ]
        held = parts + held
