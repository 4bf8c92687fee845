"""Pages that are generated whole: every module, the protocol of guests."""

from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
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
    "verification/credibility": "Credibility",
    "verification/desk": "Answer to one problem",
}


def generated_pages() -> Iterator[tuple[str, str | bytes]]:
    """Path under the source folder with the content of every generated page or figure."""
    yield from _api()


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
    yield "api/index.md", f"# API reference\n\n{text}\n\n```{{toctree}}\n:maxdepth: 1\n{toc}\n```\n"


def _modules(folder: Path) -> list[str]:
    """Dotted names of the modules in ``folder``, without the adapters of guests, whose codes are not here."""
    found = []
    for path in sorted(folder.rglob("*.py")):
        words = path.relative_to(ROOT).with_suffix("").parts
        if "examples" not in words and path.name != "__init__.py":
            found.append(".".join(words))
    return found
