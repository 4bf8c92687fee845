"""The packages in rooms: small folders, names that do not repeat each other, imports downwards only."""

import ast
import re
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("semianalytic", "fem_reference", "verification")
MODULES = sorted(path for package in PACKAGES for path in (ROOT / package).rglob("*.py"))
MOST = 12
# A room imports from those before it; rooms on one floor do not import each other.
FLOORS = (
    ("problem",),
    ("sources",),
    ("judging",),
    ("cases",),
    ("sampling",),
    ("running",),
    ("study", "regression", "guests"),
    ("credibility", "bench", "desk"),
    ("report",),
    ("manual",),
    ("commands",),
)
FLOOR = {room: number for number, rooms in enumerate(FLOORS) for room in rooms}


def folders():
    """Every folder of the packages with the names of its modules and its folders of modules."""
    found = defaultdict(lambda: (set(), set()))
    for path in MODULES:
        folder = path.parent
        if path.name != "__init__.py":
            found[folder][0].add(path.stem)
        if folder.parent != ROOT:
            found[folder.parent][1].add(folder.name)
    return found


def imported(tree):
    """Dotted names of the modules that a module of ``verification`` imports, wherever in it."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"a relative import: {ast.unparse(node)}"
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def plain(name):
    """A name in the singular."""
    return name[:-3] + "y" if name.endswith("ies") else name.removesuffix("s")


def test_verification_shows_its_rooms_and_the_command_line():
    modules, rooms = folders()[ROOT / "verification"]
    assert modules == {"cli"}
    assert rooms >= FLOOR.keys()
    assert (
        len(rooms) <= MOST + 3
    )  # three more than a folder may hold: the guests, the desk, the manual have a room of their own


def test_no_room_holds_more_than_twelve_modules():
    sizes = {
        folder.relative_to(ROOT).as_posix(): len(modules) + len(inner)
        for folder, (modules, inner) in folders().items()
        if ROOT / "verification" in folder.parents
    }
    assert {name: size for name, size in sizes.items() if size > MOST} == {}


def test_no_module_repeats_the_name_of_its_folder():
    repeated = [
        f"{folder.relative_to(ROOT)}/{name}"
        for folder, (modules, _) in folders().items()
        for name in sorted(modules)
        if plain(folder.name) in {plain(name), *map(plain, name.split("_"))}
    ]
    assert repeated == []


def test_no_modules_of_a_folder_share_the_first_word_of_their_names():
    families = defaultdict(list)
    for folder, (modules, _) in folders().items():
        for name in sorted(modules):
            families[f"{folder.relative_to(ROOT)}/{name.split('_')[0]}"].append(name)
    assert {place: names for place, names in families.items() if len(names) > 1} == {}


def test_rooms_import_downwards_only():
    upward = []
    for path in MODULES:
        package, room, *_ = path.relative_to(ROOT).parts
        if package != "verification" or room not in FLOOR:
            continue
        for name in sorted(set(imported(ast.parse(path.read_text(encoding="utf-8"))))):
            top, _, rest = name.partition(".")
            other = rest.partition(".")[0]
            if top == "verification" and other and other != room and FLOOR.get(other, MOST) >= FLOOR[room]:
                upward.append(f"{path.relative_to(ROOT)} imports {name}")
    assert upward == []


def test_every_module_has_one_purpose_in_its_first_line():
    lines = {}
    for path in MODULES:
        tree = ast.parse(path.read_text(encoding="utf-8"))
        if tree.body or path.name != "__init__.py":
            lines[path.relative_to(ROOT).as_posix()] = (ast.get_docstring(tree) or "").partition("\n")[0]
    found = {name: line for name, line in lines.items() if not line or re.search(r"\band\b", line, re.I)}
    assert found == {}
