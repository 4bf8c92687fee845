"""Good TOML files made bad: keys lost, added, renamed, given what they must not have, or garbled text."""

import copy
import json
import math
import re
from typing import Any

from hypothesis import strategies as st

LARGEST = 1.7976931348623157e308
STRANGE = [
    "",
    "text",
    "1.0",
    "x" * 5000,
    "\u202egnitaoc\u202c β薄膜 \U0001f600",
    "line\nbreak",
    "\x1b[31mred\x1b[0m",
    "<script>alert(1)</script>",
    "__import__('os').abort()",
    "../../../etc/passwd",
    True,
    False,
    0,
    -1,
    10**18,
    10**400,
    0.0,
    -0.0,
    -1.0,
    5e-324,
    1e-300,
    1e-30,
    1e30,
    1e300,
    LARGEST,
    -LARGEST,
    math.nan,
    math.inf,
    -math.inf,
    [],
    [1.0, 2.0],
    [[[[]]]],
    ["text"],
    {},
    {"E": 1.0},
    {"a": {"b": {"c": []}}},
]
Tree = dict[str, Any]


def dump(tree: Tree) -> str:
    """``tree`` as TOML text, one line a top-level key."""
    return "".join(f"{_key(key)} = {_value(value)}\n" for key, value in tree.items())


def _key(key: str) -> str:
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else _quoted(key)


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[ " + ", ".join(_value(item) for item in value) + " ]"
    return repr(value)


def keys_of(node: Any, here: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    """The path of every value in a tree of dictionaries and lists."""
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    found = [here] if here else []
    for key, value in items:
        found += keys_of(value, (*here, key))
    return found


@st.composite
def malformed(draw: st.DrawFn, trees: list[Tree]) -> tuple[bytes, tuple[str, ...]]:
    """A file with one thing changed, and the keys an error may name: () where its text was garbled."""
    tree = copy.deepcopy(draw(st.sampled_from(trees)))
    changes = ["replace"] * 6 + ["garble"] * 3 + ["lose", "add", "rename", "repeat", "wrap"]
    kind = draw(st.sampled_from(changes))
    if kind == "garble":
        return draw(garbled(dump(tree).encode())), ()
    path = draw(st.sampled_from(keys_of(tree)))
    node = tree
    for step in path[:-1]:
        node = node[step]
    last = path[-1]
    named = [path]
    if kind == "replace":
        anything = st.one_of(st.sampled_from(STRANGE), st.floats(), st.integers(), st.text(max_size=40))
        node[last] = draw(anything)
    elif kind == "lose":
        del node[last]
    elif kind == "add":
        # The smallest table around the value; a name that no file of this program knows.
        while not isinstance(node, dict):
            path = path[:-1]
            node = tree
            for step in path[:-1]:
                node = node[step]
        name = draw(st.one_of(st.sampled_from(["hardness", "E ", "Radius", "λ", "\x1b[2J", "a" * 3000])))
        node[name] = draw(st.sampled_from(STRANGE))
        named = [(*path[:-1], name)]
    elif kind == "rename":
        if isinstance(node, dict):
            node[f"{last}_"] = node.pop(last)
            named.append((*path[:-1], f"{last}_"))
        else:
            node[last] = {"renamed": node[last]}
    elif kind == "repeat":
        node[last] = [copy.deepcopy(node[last])] * draw(st.sampled_from([0, 2, 60, 2000]))
    else:
        node[last] = [node[last]]
    return dump(tree).encode("utf-8", "surrogatepass"), tuple(".".join(map(str, key)) for key in named)


@st.composite
def garbled(draw: st.DrawFn, whole: bytes) -> bytes:
    """A text cut short, with a bit turned over, a piece lost or doubled, or something strange in between."""
    at = draw(st.integers(0, len(whole) - 1))
    kind = draw(st.sampled_from(["cut", "flip", "lose", "double", "insert"]))
    if kind == "cut":
        return whole[:at]
    if kind == "flip":
        return whole[:at] + bytes([whole[at] ^ 1 << draw(st.integers(0, 7))]) + whole[at + 1 :]
    until = min(len(whole), at + draw(st.integers(1, 40)))
    if kind == "lose":
        return whole[:at] + whole[until:]
    if kind == "double":
        return whole[:until] + whole[at:]
    junk = st.sampled_from(
        [b"\0", b"\xff\xfe", b"\n", b"[", b"]]", b"{" * 40, b"=", b'"', b"'''", b"#", b"a.b.c=1\n", b"1e999"]
    )
    return whole[:at] + draw(junk) + whole[at:]
