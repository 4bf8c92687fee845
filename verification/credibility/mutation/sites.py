"""Mutants of a module's source, each with one change.

    arithmetic  + for -, * for /, ** for *, & for |       term      a + b becomes a, a - b becomes a
    comparison  < for <= and for >=, == for !=, is, in    negation  -a, ~a, not a become a; if a: if not a
    constant    n + 1, from 10 on 2 n; 2 x; not b         index, slice, axis, default: a constant of these
    slice       a[i:j] becomes a[i + 1:j], a[i:j - 1]     extreme   min for max, floor for ceil, any for all
    abs         abs(a) becomes a                          sign      return a becomes return -a

Left alone are annotations, decorators, messages of errors, assertions, text, and functions that return it.
"""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import PurePath
from typing import Any

_SWAPPED: dict[type, tuple[type, ...]] = {
    **{ast.Add: (ast.Sub,), ast.Sub: (ast.Add,), ast.Mult: (ast.Div,), ast.Div: (ast.Mult,)},
    **{ast.Pow: (ast.Mult,), ast.FloorDiv: (ast.Mult,), ast.Mod: (ast.FloorDiv,), ast.MatMult: (ast.Mult,)},
    **{ast.BitAnd: (ast.BitOr,), ast.BitOr: (ast.BitAnd,), ast.And: (ast.Or,), ast.Or: (ast.And,)},
    **{ast.Lt: (ast.LtE, ast.GtE), ast.LtE: (ast.Lt, ast.Gt), ast.Gt: (ast.GtE, ast.LtE)},
    **{ast.GtE: (ast.Gt, ast.Lt), ast.Eq: (ast.NotEq,), ast.NotEq: (ast.Eq,), ast.Is: (ast.IsNot,)},
    **{ast.IsNot: (ast.Is,), ast.In: (ast.NotIn,), ast.NotIn: (ast.In,)},
}
_PAIRS = ("min max", "minimum maximum", "argmin argmax", "nanmin nanmax", "floor ceil", "any all")
_EXTREMES = {a: b for pair in _PAIRS for a, b in (pair.split(), pair.split()[::-1])}
_ABSOLUTE = {"abs", "absolute", "fabs"}
_NUMBER = re.compile(r"float|int|complex|Array|NDArray.*|np\.ndarray")
_TEXT = re.compile(r"((list|Iterator|Sequence|tuple)\[)?str(, \.\.\.)?\]?( \| None)?")
_SPEAKING = {"join", "format", "warn", "TypeVar", "ParamSpec", "isinstance"}  # text and types
_SKIPPED = (ast.Raise, ast.Assert, ast.JoinedStr, ast.arg, ast.Import, ast.ImportFrom)
_CERTAIN = {"strict"}  # arguments that only guard against mistakes


@dataclass(frozen=True)
class Mutant:
    """The lines ``before`` of ``file``, from ``line`` on, become ``after``, changed at ``column``.

    function : what encloses them, "" in the module itself.
    """

    file: str
    function: str
    operator: str
    line: int
    column: int
    before: str
    after: str

    @property
    def name(self) -> str:
        """Its place with a digest, as the name of a file."""
        place = PurePath(self.file).with_suffix("").as_posix().replace("/", ".")
        return f"{place}_{self.line}_{sha256(repr(self).encode()).hexdigest()[:8]}"

    @property
    def change(self) -> str:
        """Both in one line."""
        return " ".join(f"{self.before} -> {self.after}".split())


def mutated(source: str, mutant: Mutant) -> str:
    """``source`` with the change of ``mutant``."""
    lines = source.splitlines(keepends=True)
    first = mutant.line - 1
    assert "".join(lines[first:]).startswith(mutant.before)
    return "".join(lines[:first]) + "".join(lines[first:]).replace(mutant.before, mutant.after, 1)


def mutants(source: str, file: str) -> list[Mutant]:
    """Every mutant of a module's ``source``, from its first line to its last."""
    lines = source.encode().splitlines()
    found = {}
    for place, operator, node, new in _sites(ast.parse(source), _Place()):
        before = lines[node.lineno - 1 : node.end_lineno]
        head, tail = before[0][: node.col_offset], before[-1][node.end_col_offset :]
        after = head + _operand(new).encode() + tail
        where = (node.lineno, node.col_offset, b"\n".join(before).decode(), after.decode())
        found[where] = Mutant(file, place.function, operator, *where)
    return [found[where] for where in sorted(found)]


@dataclass(frozen=True)
class _Place:
    """Function around a node, whether that returns numbers, and what a constant there is."""

    function: str = ""
    numeric: bool = False
    constant: str = "constant"


Site = tuple[_Place, str, Any, Any]  # place, operator, node, what it becomes


def _operand(node: ast.AST) -> str:
    """``node`` as source text that stays one operand wherever it is put."""
    bare = ast.AugAssign | ast.Call | ast.Constant | ast.Name | ast.Attribute | ast.Subscript
    return ast.unparse(node) if isinstance(node, bare) else f"({ast.unparse(node)})"


def _with(node: Any, **fields: Any) -> Any:
    """A copy of ``node`` with other ``fields``."""
    return type(node)(**dict(ast.iter_fields(node)) | fields)


def _name(node: ast.AST) -> str:
    return getattr(node, "id", "") or getattr(node, "attr", "")


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.JoinedStr) or isinstance(getattr(node, "value", None), str)


def _is_type(node: ast.AST) -> bool:
    return _name(node)[:1].isupper() or _name(node) in {
        "int",
        "float",
        "str",
        "bool",
        "list",
        "tuple",
        "dict",
    }


def _speaks(node: Any) -> bool:
    return isinstance(node, ast.Call) and _name(node.func) in _SPEAKING


def _sites(node: Any, place: _Place) -> Iterator[Site]:
    """The changes of ``node`` and of everything in it."""
    if isinstance(node, _SKIPPED) or _speaks(node) or _speaks(getattr(node, "value", None)):
        return
    parts: list[tuple[Any, _Place]]
    inner = replace(place, constant="constant")
    if isinstance(node, ast.FunctionDef):
        returns = ast.unparse(node.returns) if node.returns else ""
        if _TEXT.fullmatch(returns) or node.name in ("__repr__", "__str__"):
            return
        name = f"{place.function}.{node.name}".lstrip(".")
        inside = _Place(name, bool(_NUMBER.fullmatch(returns)))
        defaults = [*node.args.defaults, *filter(None, node.args.kw_defaults)]
        parts = [(d, replace(inside, constant="default")) for d in defaults]
        parts += [(statement, inside) for statement in node.body]
    elif isinstance(node, ast.ClassDef):
        parts = [(s, _Place(f"{place.function}.{node.name}".lstrip("."))) for s in node.body]
    elif isinstance(node, ast.AnnAssign):
        parts = [(node.value, inner)] if node.value else []
    elif isinstance(node, ast.Call):
        axis = replace(place, constant="axis")
        keywords = [k for k in node.keywords if k.arg not in _CERTAIN]
        parts = [(part, inner) for part in (node.func, *node.args)]
        parts += [(k.value, axis if k.arg == "axis" else inner) for k in keywords]
    elif isinstance(node, ast.Subscript):
        parts = [(node.value, inner), (node.slice, replace(place, constant="index"))]
    elif isinstance(node, ast.Slice):
        bounds = [bound for bound in (node.lower, node.upper, node.step) if bound]
        parts = [(bound, replace(place, constant="slice")) for bound in bounds]
    else:
        kept = isinstance(node, ast.UnaryOp | ast.Tuple)  # a constant in -1 or in [0, 1] is still an index
        parts = [(part, place if kept else inner) for part in ast.iter_child_nodes(node)]
    yield from ((place, operator, old, new) for operator, old, new in _changes(node, place))
    for part, where in parts:
        yield from _sites(part, where)


def _changes(node: Any, place: _Place) -> Iterator[tuple[str, Any, Any]]:
    """Operator, node, what it becomes, of the changes of ``node`` itself."""
    if isinstance(node, ast.Constant) and isinstance(node.value, bool | int | float | complex):
        n = node.value
        larger = not n if isinstance(n, bool) else n + 1 if n == 0 or (type(n) is int and n < 10) else 2 * n
        yield place.constant, node, ast.Constant(larger)
    elif isinstance(node, ast.BinOp | ast.AugAssign):
        sides = (node.left, node.right) if isinstance(node, ast.BinOp) else (node.value,)
        if any(map(_is_text, sides)) or (isinstance(node.op, ast.BitOr) and any(map(_is_type, sides))):
            return
        for op in _SWAPPED.get(type(node.op), ()):
            yield "arithmetic", node, _with(node, op=op())
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
            yield "term", node, node.left
    elif isinstance(node, ast.Compare):
        for i, old in enumerate(node.ops):
            for op in _SWAPPED[type(old)]:
                yield "comparison", node, _with(node, ops=[*node.ops[:i], op(), *node.ops[i + 1 :]])
    elif isinstance(node, ast.BoolOp):
        yield "comparison", node, _with(node, op=_SWAPPED[type(node.op)][0]())
    elif isinstance(node, ast.UnaryOp):
        yield "negation", node, node.operand
    elif isinstance(node, ast.If | ast.While | ast.IfExp | ast.comprehension):
        for test in node.ifs if isinstance(node, ast.comprehension) else [node.test]:
            if not isinstance(test, ast.Compare | ast.BoolOp | ast.UnaryOp | ast.Constant):
                yield "negation", test, ast.UnaryOp(ast.Not(), test)
    elif isinstance(node, ast.Slice):
        one = ast.Constant(1)
        for bound, by in ((node.lower, ast.Add), (node.upper, ast.Sub)):
            if bound and not isinstance(bound, ast.Constant | ast.UnaryOp):
                yield "slice", bound, ast.BinOp(bound, by(), one)
    elif isinstance(node, ast.Call):
        if (name := _name(node.func)) in _EXTREMES:
            field = "id" if isinstance(node.func, ast.Name) else "attr"
            yield "extreme", node, _with(node, func=_with(node.func, **{field: _EXTREMES[name]}))
        elif name in _ABSOLUTE and len(node.args) == 1:
            yield "abs", node, node.args[0]
    elif isinstance(node, ast.Return) and place.numeric and node.value:
        yield "sign", node.value, ast.UnaryOp(ast.USub(), node.value)
