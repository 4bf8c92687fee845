"""Numbers that both methods chose: value, what is said of each, whether it stands in its method's table."""

import ast
import re
from pathlib import Path
from typing import NamedTuple

from rich.markup import escape

from verification.commands.common.terminal import named_table, print_out

ROOT = Path(__file__).parents[2]
TABLES = {"semianalytic": "numbers.py", "fem_reference": "element_numbers.py"}  # of each method
NAME = re.compile(r"_?[A-Z][A-Z0-9_]*")


class MethodConstant(NamedTuple):
    """A number, or a few, that a module of a method gives a name; ``said``: the comment at or above it.

    Outside the tables a number that is computed from another constant is no choice, nor are whole numbers in
    a list or a dictionary, which count rows, harmonics or orders.
    """

    path: str
    name: str
    value: str
    said: str
    in_table: bool


def method_constants() -> list[MethodConstant]:
    """Every numeric constant of both methods, module by module."""
    found = []
    for package, table in TABLES.items():
        for path in sorted((ROOT / package).rglob("*.py")):
            text = path.read_text(encoding="utf-8")
            lines, place = text.splitlines(), path.relative_to(ROOT).as_posix()
            for node in ast.parse(text).body:
                value = getattr(node, "value", None)
                if path.name != table and value and _follows(value):
                    continue
                if isinstance(node, ast.Assign | ast.AnnAssign) and value and _numeric(value):
                    targets = node.targets if isinstance(node, ast.Assign) else [node.target]
                    parts = [part for one in targets for part in ast.walk(one)]
                    said = _said(lines, node.lineno, node.end_lineno or node.lineno)
                    shown = ast.unparse(value)
                    found += [
                        MethodConstant(place, name, shown, said, path.name == table)
                        for name in (part.id for part in parts if isinstance(part, ast.Name))
                        if NAME.fullmatch(name)
                    ]
    return found


def _numeric(value: ast.expr) -> bool:
    """Whether numbers, and no texts but keys, are written in ``value``."""
    keys = {id(key) for node in ast.walk(value) if isinstance(node, ast.Dict) for key in node.keys}
    written = [one.value for one in ast.walk(value) if isinstance(one, ast.Constant) and id(one) not in keys]
    return any(type(one) in (int, float) for one in written) and not any(isinstance(w, str) for w in written)


def _follows(value: ast.expr) -> bool:
    """Whether ``value`` is computed from a constant, or is a list or a dictionary of whole numbers."""
    nodes = list(ast.walk(value))
    named = [getattr(node, "id", getattr(node, "attr", "")) for node in nodes]
    numbers = [
        node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, float)
    ]
    value = value.args[0] if isinstance(value, ast.Call) and value.args else value  # np.array of a list
    return any(map(NAME.fullmatch, named)) or (
        isinstance(value, ast.List | ast.Dict) and all(one.is_integer() for one in numbers)
    )


def _said(lines: list[str], first: int, last: int) -> str:
    """The comment behind an assignment, or the lines of comment above it."""
    behind = [line.partition("#")[2].strip() for line in lines[first - 1 : last] if "#" in line]
    above: list[str] = []
    while not behind and re.fullmatch(r"[A-Z_, ]+ = [^#]+", lines[first - 2]):  # one comment for both
        first -= 1
    while not behind and first > 1 and lines[first - 2].startswith("#"):
        first -= 1
        above.insert(0, lines[first - 1].lstrip("# "))
    return " ".join(behind or above)


def constants() -> int:
    """List the numeric constants of both methods with what is said of each, the tables last."""
    table = named_table("module", "name", "value", "what it is, and where from")
    found = sorted(method_constants(), key=lambda one: (one.in_table, one.path))
    for one in found:
        table.add_row(one.path, one.name, escape(one.value), escape(one.said))
    print_out(table, f"{len(found)} constants, {sum(one.in_table for one in found)} of them in the tables")
    return 0
