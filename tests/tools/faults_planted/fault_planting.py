"""Planted faults: part of a function, or a constant, replaced while a trial runs.

The source on disk is never changed. The syntax tree of the function is edited, compiled in the module of the
original and put in its place wherever that was imported by name; leaving the context restores the originals.
"""

import ast
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cached_property, reduce
from importlib import import_module
from types import ModuleType
from typing import Any

from faults_planted.fault_anchor import Change, PlantError, definition, edited
from verification.sources.source_registry import METHODS, SOURCES

# Where names are replaced; those of the trials too, which import what they judge with.
PACKAGES = (*(SOURCES[name].package for name in METHODS), "verification", "faults_planted")


@dataclass(frozen=True)
class Fault:
    """One mistake with a ``description`` of what is wrong.

    where : the faulty source, "harness", or "published" for the reader of published tables.
    predicted : names of the quantities, invariants, tables or self-tests of which at least one should catch
    it, stated before the first trial.   cases : of the default run, in the trial.   solve : sources solved
    under the fault, the others are taken from the clean run.   published : published cases in the trial.
    reason, remedy : of a fault that no check catches, why not and which check would.
    equivalent : no number changes by more than ``EQUIVALENT_CHANGE``, for this ``reason``.
    """

    name: str
    group: str
    description: str
    where: str
    changes: tuple[Change, ...] = ()
    predicted: tuple[str, ...] = ()
    cases: tuple[str, ...] = ()
    solve: tuple[str, ...] = ()
    published: tuple[str, ...] = ()
    reason: str = ""
    remedy: str = ""
    equivalent: bool = False


@contextmanager
def planted(changes: tuple[Change, ...]) -> Iterator[None]:
    """Context in which the running code has ``changes``. Raises PlantError where one does not fit.

    Tables that functions keep are forgotten before and after: they are those of the code that filled them.
    """
    with ExitStack() as stack:
        stack.callback(_forget_tables)
        for target in dict.fromkeys(change.target for change in changes):
            owner, name = owner_of(target)
            original = vars(owner)[name]
            changed = _changed(owner, [change for change in changes if change.target == target])
            places = [(owner, name)]
            if isinstance(owner, ModuleType):  # what a module defines is imported by name
                alike = callable(original)  # numbers are shared between constants
                held = [one for one in _held() if one[2] is original and (alike or one[1] == name)]
                places = [(module, known) for module, known, _ in held]
            for place, known in places:
                stack.callback(setattr, place, known, original)
                setattr(place, known, changed)
        _forget_tables()
        yield


def _forget_tables() -> None:
    """Empty the caches of all functions of the packages."""
    for _, _, value in _held():
        if callable(clear := getattr(value, "cache_clear", None)):
            clear()


def _held() -> list[tuple[Any, str, Any]]:
    """Every module of the packages with each name in it and what that holds."""
    modules = [module for key, module in sys.modules.items() if key.split(".")[0] in PACKAGES]
    return [(module, name, value) for module in modules for name, value in vars(module).items()]


def owner_of(target: str) -> tuple[Any, str]:
    """The module or class that defines ``target``, with its name there."""
    module, _ = definition(target)
    *parents, name = target.partition(":")[2].split(".")
    return reduce(getattr, parents, import_module(module)), name


def _changed(owner: Any, changes: list[Change]) -> Any:
    """The new value of a constant, or the function, method or property with all ``changes``."""
    target = changes[0].target
    *_, name = target.partition(":")[2].split(".")
    module, tree = definition(target)
    known = vars(sys.modules[module])
    title = f"<{target}, {changes[-1].by!r} planted>"
    if not changes[0].replace:
        value = eval(changes[0].by, known)  # text of the catalogue
        if value == vars(owner)[name]:
            raise PlantError(f"{target} is {value!r} already; nothing would be planted")
        return value
    for change in changes:
        tree = edited(tree, change, known)
    # A compiled property remains one, since its decorator is part of the tree.
    made: dict[str, Any] = {}
    exec(compile(ast.unparse(tree), title, "exec"), known, made)
    changed = made[name]
    if isinstance(changed, cached_property):
        changed.__set_name__(type(name, (), {}), name)
    return changed
