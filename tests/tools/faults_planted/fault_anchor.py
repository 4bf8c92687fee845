"""Where a planted fault stands in the source: a definition found by name, changed in its syntax tree."""

import ast
import builtins
import re
from collections.abc import Callable, Container, Sequence
from copy import deepcopy
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache, partial
from importlib.util import find_spec
from pathlib import Path

Part = Sequence[ast.AST]  # nodes in a row: one expression, or some statements


class PlantError(Exception):
    """A fault that no longer fits the source; the message names the definition and what it lacks."""


@dataclass(frozen=True)
class Change:
    """In the function ``target`` the expression or statements ``replace`` become ``by``.

    Without ``replace`` the target is a constant, and ``by`` its value.

    target : "place:function", "place:Class.method" or "place:CONSTANT". The place is a package, a folder or a
    module; one definition of the name stands there or below.   replace : as Python; spaces, brackets and
    line breaks do not matter, and local variables may have been renamed since. It occurs there once.
    """

    target: str
    replace: str = ""
    by: str = ""


@cache
def definition(target: str) -> tuple[str, ast.stmt]:
    """The module that defines ``target``, and the definition. Raises PlantError unless there is just one."""
    place, _, name = target.partition(":")
    defined = {
        module: node for module, path in _modules(place.split(".")[0]) if (node := _defined(path, name))
    }
    found = [module for module in defined if f"{module}.".startswith(f"{place}.")]
    if len(found) != 1:
        raise PlantError(
            f"{target}: the fault no longer fits the source, which has {len(found)} definitions of this name "
            f"there, not one; {name} is defined in {', '.join(found or defined) or 'no module'}"
        )
    return found[0], defined[found[0]]


def edited(function: ast.stmt, change: Change, known: Container[str]) -> ast.stmt:
    """A copy of ``function`` with ``change``; ``known`` are the names of its module.

    Raises PlantError where the change does not fit, or needs a name that the function does not have.
    """
    function = deepcopy(function)
    here = _names([function])
    replace, by = _parts(change)
    foreign = {n for n in _names([*replace, *by]) - here if n not in known and n not in vars(builtins)}
    places = _places(function, replace)
    found = [(part, put, by) for part, put in places if _said(part) == _said(replace)]
    if not found:
        renamed = [(part, put, _renaming(replace, part, foreign)) for part, put in places]
        found = [(part, put, _renamed(by, names)) for part, put, names in renamed if names]
    if len(found) != 1:
        near = get_close_matches(_said(replace), [_said(part) for part, _ in places], 1, 0)
        raise PlantError(
            f"{change.target}: {change.replace!r} occurs there {len(found)} times, not once; the fault no "
            f"longer fits the source, where {'nothing' if not near else repr(near[0])} is nearest"
        )
    part, put, by = found[0]
    if _said(part) == _said(by):
        raise PlantError(f"{change.target}: {change.by!r} stands there already; nothing would be planted")
    if lacking := (foreign & _names(by)) - _names(by, (ast.Store, ast.Param)):
        raise PlantError(f"{change.target}: {change.by!r} needs {', '.join(sorted(lacking))}, unknown there")
    put(by)
    return ast.parse(ast.unparse(function)).body[0]


@cache
def _modules(package: str) -> list[tuple[str, Path]]:
    """Every module of a package with its file."""
    spec = find_spec(package)
    folders = map(Path, spec.submodule_search_locations or () if spec else ())
    return [
        (".".join(path.relative_to(folder.parent).with_suffix("").parts).removesuffix(".__init__"), path)
        for folder in folders
        for path in sorted(folder.rglob("*.py"))
    ]


def _defined(path: Path, name: str) -> ast.stmt | None:
    """The definition of ``name``, or of the method "Class.method", in the file at ``path``."""
    *classes, last = name.split(".")
    if not re.search(rf"\b{last}\b", _text(path)):
        return None
    body = _statements(path)
    for name in classes:
        found = [one for one in body if isinstance(one, ast.ClassDef) and one.name == name]
        body = found[0].body if found else []
    return next((one for one in body if last in _given(one)), None)


@cache
def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


@cache
def _statements(path: Path) -> list[ast.stmt]:
    return ast.parse(_text(path)).body


def _given(statement: ast.stmt) -> set[str]:
    """The names of the function or the constants that a statement defines."""
    if isinstance(statement, ast.FunctionDef):
        return {statement.name}
    return _names([statement], (ast.Store,)) if isinstance(statement, ast.Assign | ast.AnnAssign) else set()


def _parts(change: Change) -> tuple[Part, Part]:
    """What is replaced and by what: one expression each, or statements."""
    try:
        replace, by = (ast.parse(text).body for text in (change.replace, change.by))
    except SyntaxError as error:
        raise PlantError(f"{change.target}: {error.text!r} is not Python: {error.msg}") from None
    both = [*replace, *by]
    if len(replace) == len(by) == 1 and all(isinstance(one, ast.Expr) for one in both):
        return [replace[0].value], [by[0].value]  # type: ignore[attr-defined]
    return replace, by


def _places(tree: ast.AST, like: Part) -> list[tuple[Part, Callable[[Part], object]]]:
    """Every place that could hold ``like``, with what puts other nodes there; no variable that is set."""
    n, kind = len(like), type(like[0])
    found: list[tuple[Part, Callable[[Part], object]]] = []
    for parent in ast.walk(tree):
        for name, held in ast.iter_fields(parent):
            if isinstance(held, list):
                rows = [slice(i, i + n) for i in range(len(held) - n + 1)]
                found += [(held[row], partial(held.__setitem__, row)) for row in rows]
            elif n == 1:
                found.append(([held], partial(_set_one, parent, name)))
    read = [(part, put) for part, put in found if isinstance(getattr(part[0], "ctx", ast.Load()), ast.Load)]
    return [(part, put) for part, put in read if isinstance(part[0], kind)]


def _set_one(parent: ast.AST, name: str, part: Part) -> None:
    setattr(parent, name, part[0])


def _said(part: Part) -> str:
    """The nodes as text in a form of their own."""
    return "\n".join(map(ast.unparse, part))


def _variables(part: Part) -> list[tuple[str, type]]:
    """The variables in the nodes, each with whether it is read, set or a parameter, always in one order."""
    nodes = [node for one in part for node in ast.walk(one) if isinstance(node, ast.Name | ast.arg)]
    return [(n.id, type(n.ctx)) if isinstance(n, ast.Name) else (n.arg, ast.Param) for n in nodes]


def _names(part: Part, uses: tuple[type, ...] = (ast.Load, ast.Store, ast.Del, ast.Param)) -> set[str]:
    return {name for name, use in _variables(part) if use in uses}


def _renaming(replace: Part, part: Part, foreign: set[str]) -> dict[str, str]:
    """New names of ``foreign`` variables that make ``replace`` into ``part``; empty where none do."""
    old, new = ([name for name, _ in _variables(one)] for one in (replace, part))
    names = {was: now for was, now in zip(old, new, strict=False) if was in foreign and now not in old}
    one_to_one = len(set(names.values())) == len(names)
    return names if one_to_one and _said(_renamed(replace, names)) == _said(part) else {}


def _renamed(part: Part, names: dict[str, str]) -> Part:
    part = deepcopy(part)
    for node in (node for one in part for node in ast.walk(one)):
        if isinstance(node, ast.Name):
            node.id = names.get(node.id, node.id)
        elif isinstance(node, ast.arg):
            node.arg = names.get(node.arg, node.arg)
    return part
