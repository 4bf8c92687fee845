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
from typing import Any

from verification.evidence.mutant_record import Mutant

_BECOMES = (
    "Add Sub, Sub Add, Mult Div, Div Mult, Pow Mult, FloorDiv Mult, Mod FloorDiv, MatMult Mult, "
    "BitAnd BitOr, BitOr BitAnd, And Or, Or And, Lt LtE GtE, LtE Lt Gt, Gt GtE LtE, GtE Gt Lt, Eq NotEq, "
    "NotEq Eq, Is IsNot, IsNot Is, In NotIn, NotIn In"
)
_OPERATORS = {old: new for old, *new in (row.split() for row in _BECOMES.split(", "))}
_PAIRS = "min max, minimum maximum, argmin argmax, nanmin nanmax, floor ceil, any all"
_EXTREMES = {a: b for pair in _PAIRS.split(", ") for a, b in (pair.split(), pair.split()[::-1])}
_NUMBER = re.compile(r"float|int|complex|Array|NDArray.*|np\.ndarray")
_TEXT = re.compile(r"((list|Iterator|Sequence|tuple)\[)?str(, \.\.\.)?\]?( \| None)?")
_SPEAKING = {"join", "format", "warn", "TypeVar", "ParamSpec", "isinstance"}  # calls about text, about types
_TYPES = {"int", "float", "str", "bool", "list", "tuple", "dict"}
_SKIPPED = (ast.Raise, ast.Assert, ast.JoinedStr, ast.arg, ast.Import, ast.ImportFrom)
_OPERANDS = (ast.AugAssign, ast.Call, ast.Constant, ast.Name, ast.Attribute, ast.Subscript)


def mutated(source: str, mutant: Mutant) -> str:
    """``source`` with the change of ``mutant``."""
    lines = source.splitlines(keepends=True)
    rest = "".join(lines[mutant.line - 1 :])
    assert rest.startswith(mutant.before)
    return "".join(lines[: mutant.line - 1]) + mutant.after + rest.removeprefix(mutant.before)


def mutants(source: str, file: str) -> list[Mutant]:
    """Every mutant of a module's ``source``, from its first line to its last."""
    lines = source.encode().splitlines()
    found = {}
    for function, operator, node, new in _sites(ast.parse(source)):
        before = lines[node.lineno - 1 : node.end_lineno]
        text = ast.unparse(new) if isinstance(new, _OPERANDS) else f"({ast.unparse(new)})"
        after = before[0][: node.col_offset] + text.encode() + before[-1][node.end_col_offset :]
        where = (node.lineno, node.col_offset, b"\n".join(before).decode(), after.decode())
        found[where] = Mutant(file, function, operator, *where)
    return [found[where] for where in sorted(found)]


def _with(node: Any, **fields: Any) -> Any:
    """A copy of ``node`` with other ``fields``."""
    return type(node)(**dict(ast.iter_fields(node)) | fields)


def _other(operator: ast.AST) -> list[Any]:
    return [getattr(ast, name)() for name in _OPERATORS.get(type(operator).__name__, ())]


def _name(node: Any) -> str:
    return getattr(node, "id", "") or getattr(node, "attr", "")


def _is_text(node: Any) -> bool:
    return isinstance(node, ast.JoinedStr) or isinstance(getattr(node, "value", None), str)


def _is_type(node: Any) -> bool:
    return _name(node)[:1].isupper() or _name(node) in _TYPES


def _speaks(node: Any) -> bool:
    return isinstance(node, ast.Call) and _name(node.func) in _SPEAKING


def _sites(
    node: Any, function: str = "", numeric: bool = False, kind: str = "constant"
) -> Iterator[tuple[str, str, Any, Any]]:
    """Function, operator, node, what it becomes, of ``node`` with all in it.

    numeric : whether the function returns numbers.   kind : of a constant.
    """
    if isinstance(node, _SKIPPED) or _speaks(node) or _speaks(getattr(node, "value", None)):
        return
    parts = [(part, "constant") for part in ast.iter_child_nodes(node)]
    if isinstance(node, ast.FunctionDef):
        returns = ast.unparse(node.returns) if node.returns else ""
        if _TEXT.fullmatch(returns):
            return
        numeric = bool(_NUMBER.fullmatch(returns))
        parts = [(d, "default") for d in (*node.args.defaults, *node.args.kw_defaults) if d]
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        function = f"{function}.{node.name}".lstrip(".")
        parts = [*(parts if isinstance(node, ast.FunctionDef) else []), *((s, "constant") for s in node.body)]
    elif isinstance(node, ast.AnnAssign):
        parts = [(node.value, "constant")] if node.value else []
    elif isinstance(node, ast.keyword):  # strict=True of zip only guards against mistakes
        parts = [(node.value, "axis" if node.arg == "axis" else "constant")] if node.arg != "strict" else []
    elif isinstance(node, ast.Subscript):
        parts = [(node.value, "constant"), (node.slice, "index")]
    elif isinstance(node, ast.Slice):
        parts = [(part, "slice") for part, _ in parts]
    elif isinstance(node, ast.UnaryOp | ast.Tuple):
        parts = [(part, kind) for part, _ in parts]
    yield from ((function, operator, old, new) for operator, old, new in _changes(node, numeric, kind))
    for part, kind in parts:
        yield from _sites(part, function, numeric, kind)


def _changes(node: Any, numeric: bool, kind: str) -> Iterator[tuple[str, Any, Any]]:
    """Operator, node, what it becomes, of the changes of ``node`` itself."""
    if isinstance(node, ast.Constant) and isinstance(n := node.value, bool | int | float | complex):
        step = n == 0 or (type(n) is int and n < 10)
        yield kind, node, ast.Constant(not n if isinstance(n, bool) else n + 1 if step else 2 * n)
    elif isinstance(node, ast.BinOp | ast.AugAssign):
        sides = (node.left, node.right) if isinstance(node, ast.BinOp) else (node.value,)
        if any(map(_is_text, sides)) or (isinstance(node.op, ast.BitOr) and any(map(_is_type, sides))):
            return
        yield from (("arithmetic", node, _with(node, op=op)) for op in _other(node.op))
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
            yield "term", node, node.left
    elif isinstance(node, ast.Compare):
        for i, old in enumerate(node.ops):
            for op in _other(old):
                yield "comparison", node, _with(node, ops=[*node.ops[:i], op, *node.ops[i + 1 :]])
    elif isinstance(node, ast.BoolOp):
        yield "comparison", node, _with(node, op=_other(node.op)[0])
    elif isinstance(node, ast.UnaryOp):
        yield "negation", node, node.operand
    elif isinstance(node, ast.If | ast.While | ast.IfExp | ast.comprehension):
        for test in node.ifs if isinstance(node, ast.comprehension) else [node.test]:
            if not isinstance(test, ast.Compare | ast.BoolOp | ast.UnaryOp | ast.Constant):
                yield "negation", test, ast.UnaryOp(ast.Not(), test)
    elif isinstance(node, ast.Slice):
        for bound, by in ((node.lower, ast.Add()), (node.upper, ast.Sub())):
            if bound and not isinstance(bound, ast.Constant | ast.UnaryOp):
                yield "slice", bound, ast.BinOp(bound, by, ast.Constant(1))
    elif isinstance(node, ast.Call) and (other := _EXTREMES.get(_name(node.func))):
        field = "id" if isinstance(node.func, ast.Name) else "attr"
        yield "extreme", node, _with(node, func=_with(node.func, **{field: other}))
    elif isinstance(node, ast.Call) and _name(node.func) in ("abs", "absolute", "fabs"):
        yield "abs", node, node.args[0]
    elif isinstance(node, ast.Return) and numeric and node.value:
        yield "sign", node.value, ast.UnaryOp(ast.USub(), node.value)
