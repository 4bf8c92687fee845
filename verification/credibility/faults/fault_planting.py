"""Planted faults: part of a function, or a constant, replaced while a trial runs.

The source on disk is never changed. The text of the function is taken from the running code, edited, compiled
in the module of the original and put in its place wherever that was imported by name; leaving the context
restores the originals.
"""

import inspect
import linecache
import sys
import textwrap
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cached_property, reduce
from importlib import import_module
from types import ModuleType
from typing import Any

from verification.sources.source_registry import METHODS, SOURCES

PACKAGES = (*(SOURCES[name].package for name in METHODS), "verification")


class PlantError(Exception):
    """A fault that no longer fits the source; the message names the function and the text."""


@dataclass(frozen=True)
class Edit:
    """In the function ``target``, "module:function" or "module:Class.method", ``old`` becomes ``new``.

    ``old`` must occur exactly once, so that a change of the source is noticed.
    """

    target: str
    old: str
    new: str


@dataclass(frozen=True)
class Constant:
    """The constant ``target``, "module:NAME", becomes ``new``."""

    target: str
    new: Any


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
    changes: tuple[Edit | Constant, ...] = ()
    predicted: tuple[str, ...] = ()
    cases: tuple[str, ...] = ()
    solve: tuple[str, ...] = ()
    published: tuple[str, ...] = ()
    reason: str = ""
    remedy: str = ""
    equivalent: bool = False


@contextmanager
def planted(changes: tuple[Edit | Constant, ...]) -> Iterator[None]:
    """Context in which the running code has ``changes``. Raises PlantError where one does not fit.

    Tables that functions keep are forgotten before and after: they are those of the code that filled them.
    """
    with ExitStack() as stack:
        stack.callback(_forget_tables)
        for change in changes:
            owner, name = owner_of(change.target)
            if name not in vars(owner):
                raise PlantError(
                    f"{change.target}: there is no such function; the fault no longer fits the source"
                )
            original = vars(owner)[name]
            places = [(owner, name)]
            if isinstance(change, Constant):
                if original == change.new:
                    raise PlantError(f"{change.target} is {original!r} already; nothing would be planted")
                changed = change.new
            else:
                changed = _changed(original, name, change)
                if isinstance(owner, ModuleType):  # functions are imported by name
                    places = [(module, known) for module, known, value in _held() if value is original]
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
    """The module or class that holds ``target``, with its name there."""
    module, _, path = target.partition(":")
    *parents, name = path.split(".")
    return reduce(getattr, parents, import_module(module)), name


def _changed(original: Any, name: str, change: Edit) -> Any:
    """The function, method or property with the edit, compiled in its own module."""
    function = original
    for attribute in ("fget", "func", "__func__"):  # of a property, a cached one, a class method
        function = getattr(function, attribute, function)
    function = inspect.unwrap(getattr(function, "form", function))
    text = textwrap.dedent(inspect.getsource(function))
    count = text.count(change.old)
    if count != 1:
        raise PlantError(
            f"{change.target}: {change.old!r} occurs there {count} times, not once; "
            "the fault no longer fits the source"
        )
    module = sys.modules[function.__module__]
    # A compiled property remains one, since its decorator is part of the text.
    made: dict[str, Any] = {}
    # Kept where inspect looks, so that a second edit finds the text of the first.
    name_of_file = f"<{change.target}, {change.new!r} planted>"
    lines = text.replace(change.old, change.new).splitlines(keepends=True)
    linecache.cache[name_of_file] = (len(text), None, lines, name_of_file)
    code = compile("".join(lines), name_of_file, "exec")
    exec(code, vars(module), made)  # text from this package only
    changed = made[name]
    if isinstance(changed, cached_property):
        changed.__set_name__(type(name, (), {}), name)
    return changed
