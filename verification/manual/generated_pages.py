"""Pages that are generated whole: every case, command, module; the protocol of guests."""

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from verification.manual.case_pages import contact_pages, published_pages
from verification.manual.tour_output import picture

PACKAGE = Path(__file__).resolve().parents[1]
ROOT = PACKAGE.parent
API = {
    "semianalytic": "Semi-analytical method",
    "fem_reference": "Finite element method",
    "verification/problem": "Problem",
    "verification/sources": "Sources",
    "verification/judging": "Verdicts",
    "verification/cases": "Case files",
    "verification/sampling": "Sampled values",
    "verification/running": "Runs",
    "verification/study": "Parameter studies",
    "verification/regression": "Baseline",
    "verification/guests": "Codes of others",
    "verification/validation": "Comparison with measurements",
    "verification/credibility": "Credibility",
    "verification/desk": "Answer to one problem",
}
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
    yield from contact_pages()
    yield from published_pages()
    yield from _api()
    yield from _gallery()
    yield "commands.md", _commands()
    yield "protocol.md", (PACKAGE / "guests" / "PROTOCOL.md").read_text(encoding="utf-8")
    yield "tour.svg", picture()
    yield "problem.svg", (PACKAGE / "report" / "html" / "problem.svg").read_bytes()


def _gallery() -> Iterator[tuple[str, str | bytes]]:
    """The scripts of ``examples/`` in a checkout with their pictures; an installed package has none."""
    parts = [
        "# Gallery",
        "Scripts that run as they are, from `examples/` of the repository, each with its picture.",
    ]
    for script in sorted((ROOT / "examples").glob("*.py")):
        code = script.read_text(encoding="utf-8")
        title, _, rest = code.removeprefix('"""').partition('"""')
        picture_name = f"gallery_{script.stem}.png"
        image = f"```{{image}} {picture_name}\n:alt: {title}\n:width: 80%\n```"
        parts.append(f"## {script.stem.replace('_', ' ').capitalize()}\n\n{title}\n\n{image}")
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
    """A page for each room, with the docstrings of its modules."""
    entries = []
    for place, title in API.items():
        name = place.replace("/", "_")
        entries.append(name)
        parts = [f"# {title}: `{place.replace('/', '.')}`"]
        for module in _modules(ROOT / place):
            parts.append(f"## `{module}`\n\n```{{eval-rst}}\n.. automodule:: {module}\n   :members:\n```")
        yield f"api/{name}.md", "\n\n".join(parts) + "\n"
    toc = "\n".join(entries)
    text = "Every public class and function, from its docstring."
    yield "api/index.md", f"# API reference\n\n{text}\n\n```{{toctree}}\n:maxdepth: 1\n\n{toc}\n```\n"


def _modules(folder: Path) -> list[str]:
    """Dotted names of the modules in ``folder``, without the adapters of guests."""
    found = []
    for path in sorted(folder.rglob("*.py")):
        words = path.relative_to(ROOT).with_suffix("").parts
        if "examples" not in words and path.stem != "__init__":
            found.append(".".join(words))
    return found
