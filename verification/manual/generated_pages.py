"""Pages that are generated whole: every case, command, public name; the protocol of guests."""

import re
import subprocess
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

from verification.manual.case_pages import case_pages
from verification.manual.tour_output import pictures

PACKAGE = Path(__file__).resolve().parents[1]
ROOT = PACKAGE.parent
SOURCE = Path(__file__).parent / "source"
PUBLIC = ("verification", "semianalytic", "fem_reference")
# What a page of the manual points to in the code.
POINTED = re.compile(r"\{py:(class|func|mod)\}`([\w.]+)`")
DIRECTIVES = {"class": "autoclass", "func": "autofunction", "mod": "automodule"}
# The help of every command in one process, which knows nothing of this room.
HELP = """
import io
from rich.console import Console
from verification.cli import COMMANDS, app
for key in COMMANDS:
    text = io.StringIO()
    app.help_print(key.split(), console=Console(file=text, width=96, color_system=None))
    print("\\x00" + key + "\\x01" + text.getvalue())
"""


def generated_pages() -> Iterator[tuple[str, str | bytes]]:
    """Path under the source folder with the content of every generated page or figure."""
    yield from case_pages()
    yield from _api()
    yield from _gallery()
    yield "commands.md", _commands()
    yield "protocol.md", (PACKAGE / "guests" / "PROTOCOL.md").read_text(encoding="utf-8")
    yield from pictures()
    yield "problem.svg", (PACKAGE / "report" / "html" / "problem.svg").read_bytes()


def _gallery() -> Iterator[tuple[str, str | bytes]]:
    """The scripts of ``examples/`` in a checkout with their pictures; an installed package has none."""
    parts = [
        "# Gallery",
        "Scripts of the repository, each with the command that runs it and the picture that it draws.",
    ]
    for script in sorted((ROOT / "examples").glob("*.py")):
        code = script.read_text(encoding="utf-8")
        title, _, rest = code.removeprefix('"""').partition('"""')
        picture_name = f"gallery_{script.stem}.png"
        image = f"```{{image}} {picture_name}\n:alt: {title}\n:width: 80%\n```"
        command = f"```sh\npython examples/{script.name}\n```"
        parts.append(f"## {script.stem.replace('_', ' ').capitalize()}\n\n{title}\n\n{command}\n\n{image}")
        parts.append(f"```python\n{rest.strip()}\n```")
        yield picture_name, (script.parent / "pictures" / f"{script.stem}.png").read_bytes()
    yield "gallery.md", "\n\n".join(parts) + "\n"


def _commands() -> str:
    """The help of every command."""
    done = subprocess.run([sys.executable, "-c", HELP], capture_output=True, text=True, check=True, cwd=ROOT)
    parts = ["# Commands", "What `coatcheck COMMAND --help` prints."]
    for entry in done.stdout.split("\x00")[1:]:
        key, _, words = entry.partition("\x01")
        # The exit codes, the same of all, are in their own section.
        words = words.partition("Exit codes:")[0]
        lines = "\n".join(f"    {line.rstrip()}" for line in words.strip("\n").splitlines())
        parts.append(f"## coatcheck {key}\n\n{lines}")
    return "\n\n".join(parts) + "\n"


def _api() -> Iterator[tuple[str, str]]:
    """A page of the public names, and one of what other pages point to in the code."""
    parts = ["# Public names", "What to import; each name with its docstring and a link to its source."]
    for package in PUBLIC:
        parts.append(f"## `{package}`\n\n{_directive('mod', package)}")
        known = import_module(package)
        for name in known.__all__:
            kind = "class" if isinstance(getattr(known, name), type) else "func"
            parts.append(_directive(kind, f"{package}.{name}"))
    yield "api.md", "\n\n".join(parts) + "\n"
    text = "\n".join(path.read_text(encoding="utf-8") for path in sorted(SOURCE.glob("*.md")))
    pointed = {name: kind for kind, name in POINTED.findall(text)}
    parts = ["# Code behind the pages", "Modules, classes and functions that pages of this manual point to."]
    parts += [_directive(pointed[name], name) for name in sorted(pointed)]
    yield "code.md", "\n\n".join(parts) + "\n"


def _directive(kind: str, name: str) -> str:
    members = "   :members:\n" if kind == "class" else ""
    return f"```{{eval-rst}}\n.. {DIRECTIVES[kind]}:: {name}\n{members}```"
