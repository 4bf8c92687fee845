"""The table of the numbers that the method chose: whole, used, each with what measures it."""

import ast
import re
from pathlib import Path

import semianalytic
from semianalytic import numbers

FOLDER = Path(semianalytic.__file__).parent
TABLE = Path(numbers.__file__).read_text(encoding="utf-8")
TESTS = Path(__file__).parent
NAMED = {name for name in vars(numbers) if name.isupper()}
# What shows the effect of another value besides tests of this folder.
ELSEWHERE = {"problems", "bench", "rounding", "the model"}
MOST = 104


def test_each_number_says_what_it_trades_and_what_measures_it():
    groups = re.findall(r"((?:# .*\n)+)((?:[A-Z].*\n)+)", TABLE)
    assert {name for _, given in groups for name in re.findall(r"\b[A-Z][A-Z_]+\b", given)} == NAMED
    for text, given in groups:
        source = re.search(r"\[([^\]]+)\]\s*$", text.replace("\n# ", " "))
        assert source, given
        known = (
            source[1] in ELSEWHERE
            or (TESTS / f"{source[1]}.py").exists()
            or re.search(r"\(\d{4}\)", source[1])
        )
        assert known, source[1]


def test_each_number_is_used_and_no_other_module_keeps_one():
    assert len(NAMED) <= MOST
    used = set()
    for path in FOLDER.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        used |= set(re.findall(r"\bnumbers\.([A-Z][A-Z_]+)\b", text))
        for node in ast.parse(text).body if path.name != "numbers.py" else []:
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant | ast.UnaryOp):
                assert not isinstance(ast.literal_eval(node.value), (int, float)), (
                    path.name,
                    ast.unparse(node),
                )
    assert used == NAMED
