"""Imports of methods or references, read from their installed source.

This shows what code they share, down to the functions of NumPy and SciPy that both call. Equations that
they share are named in the registry of sources.
"""

import ast
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

from verification.evidence.code_record import Imports
from verification.sources.source_registry import METHODS, SOURCES

# Each part with the packages that it must not import.
_METHODS = tuple(SOURCES[name].package for name in METHODS)
PARTS = {name: (*(other for other in _METHODS if other != name), "verification") for name in _METHODS}
PARTS["verification.sources.references"] = _METHODS


def parts() -> tuple[Imports, ...]:
    """Both methods, then the references. Raises ValueError where one is not installed as source."""
    return tuple(imports_of(name, forbidden_packages) for name, forbidden_packages in PARTS.items())


def imports_of(name: str, forbidden_packages: tuple[str, ...] = ()) -> Imports:
    """Read every file of the package ``name``. Raises ValueError where there is no source to read."""
    folder = _folder(name)
    modules: set[str] = set()
    functions: set[str] = set()
    forbidden, hidden = [], []
    files = statements = 0
    for path in sorted(folder.rglob("*.py")):
        files += 1
        nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
        place = path.relative_to(folder).as_posix()
        for module in _imported(nodes):
            statements += 1
            within = f"{module}.".startswith
            if any(within(f"{other}.") for other in forbidden_packages):
                forbidden.append(f"{name}/{place} imports {module}")
            if module.partition(".")[0] not in sys.stdlib_module_names and not within(f"{name}."):
                modules.add(module)
        functions.update(_used(nodes))
        hidden += [f"{name}/{place} calls {called}" for called in _called_by_name(nodes)]
    return Imports(
        name,
        files,
        statements,
        tuple(sorted(modules)),
        tuple(forbidden),
        tuple(hidden),
        tuple(sorted(functions)),
    )


def _folder(name: str) -> Path:
    spec = find_spec(name)
    places = spec.submodule_search_locations if spec is not None else None
    if not places or not list(Path(places[0]).glob("*.py")):
        raise ValueError(f"{name}: its source is not installed, so that its imports cannot be read")
    return Path(places[0])


def _imported(nodes: list[ast.AST]) -> Iterator[str]:
    """The module of each import, ``from scipy import special`` being one of scipy.special."""
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            for alias in node.names:
                yield f"scipy.{alias.name}" if node.module == "scipy" else node.module


def _used(nodes: list[ast.AST]) -> Iterator[str]:
    """Full name of everything of NumPy and SciPy that is imported or reached through a dot."""
    names: dict[str, str] = {}
    for node in nodes:
        if isinstance(node, ast.Import):
            names |= {alias.asname or alias.name: alias.name for alias in node.names if alias.asname}
            names |= {alias.name.partition(".")[0]: alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            names |= {alias.asname or alias.name: f"{node.module}.{alias.name}" for alias in node.names}
    names = {short: full for short, full in names.items() if full.partition(".")[0] in ("numpy", "scipy")}
    yield from (full for full in names.values() if "." in full)
    for node in nodes:
        if isinstance(node, ast.Attribute):
            first, _, rest = ast.unparse(node).partition(".")
            if first in names and rest.replace(".", "").replace("_", "").isalnum():
                yield f"{names[first]}.{rest}"


def _called_by_name(nodes: list[ast.AST]) -> Iterator[str]:
    for node in nodes:
        if isinstance(node, ast.Call):
            name = getattr(node.func, "id", None) or getattr(node.func, "attr", None)
            if name in ("import_module", "__import__", "exec", "eval"):
                yield ast.unparse(node.func)
