"""Stacks of many layers: the worst of each material and of the interfaces stands for all of them."""

from collections.abc import Iterable
from typing import TypeVar

from verification.cases.case_file import Case
from verification.desk.answer_stresses import Extreme
from verification.desk.layer_limits import LayerMode

MOST = 6  # coatings of a body, each of which is shown by itself

At = TypeVar("At", Extreme, LayerMode)


def worst_of_each(case: Case, found: Iterable[At]) -> tuple[At, ...]:
    """The largest of each quantity by material, and of the interfaces; everything where layers are few."""
    worst: dict[tuple[str, ...], At] = {}
    for at in found:
        kind, _, number = at.where.rpartition(" ")
        materials = _materials(case, at.body)
        group = at.where
        if len(materials) > MOST and number.isdecimal():
            if kind in ("base of coating", "top of coating"):
                continue
            group = kind if kind == "interface" else materials[int(number) - 1]
        key = (at.body, at.quantity, group)
        if key not in worst or _size(at) > _size(worst[key]):
            worst[key] = at
    return tuple(worst.values())


def _size(at: Extreme | LayerMode) -> float:
    return at.utilisation if isinstance(at, LayerMode) else at.value


def _materials(case: Case, body: str) -> list[str]:
    """A word for the material of each coating of a body: its name, or its numbers."""
    seen, names, begin, found = case.problem.seen_from(body), case.names.get(body, ()), 0, []
    for i, n in enumerate(case.sublayers(body)):
        E, nu, _ = seen.coatings[begin]
        found.append((names[i] if i < len(names) else "") or f"{E:g} {nu:g}")
        begin += n
    return found
