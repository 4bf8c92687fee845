"""Samples of the manual: Python that runs, case files that are read, commands whose options exist."""

import contextlib
import doctest
import io
import re
import shlex
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

from verification.cases.contact import parse_case
from verification.cli import app
from verification.manual.build import assemble
from verification.study.plan import read_study_file

FENCE = re.compile(r"^( *)```(\w+)\n(.*?)^\1```$", re.MULTILINE | re.DOTALL)


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """Text of every page by its path."""
    source = tmp_path_factory.mktemp("manual") / "source"
    assemble(source)
    return {path.relative_to(source).as_posix(): path.read_text() for path in source.rglob("*.md")}


@pytest.mark.slow
def test_every_sample_of_the_manual_does_what_its_page_states(pages, tmp_path):
    found = [
        f"{name}: {message}"
        for name, text in pages.items()
        for message in failures(list(samples_of(text)), tmp_path)
    ]
    assert found == []


def samples_of(text: str) -> Iterator[tuple[str, str]]:
    """Language with content of every fenced block."""
    for found in FENCE.finditer(text):
        yield found[2], found[3]


def failures(samples: list[tuple[str, str]], work: Path) -> Iterator[str]:
    """A message for each sample of one page that fails."""
    space: dict[str, object] = {"__name__": "__main__"}
    for language, code in samples:
        first = code.strip().partition("\n")[0]
        try:
            if language == "python":
                with contextlib.chdir(work), contextlib.redirect_stdout(io.StringIO()):
                    exec(compile(code, first, "exec"), space)
            elif language == "pycon":
                yield from _doctested(code, space)
            elif language == "toml":
                _read(code, work)
            elif language in ("sh", "console"):
                for line in re.sub(r" \\\n *", " ", code).splitlines():
                    _parsed(line)
        except Exception as error:  # whatever a sample raises is its failure
            yield f"{first}: {type(error).__name__}: {error}"


def _doctested(code: str, space: dict[str, object]) -> Iterator[str]:
    test = doctest.DocTestParser().get_doctest(code, space, "sample", None, None)
    text = io.StringIO()
    runner = doctest.DocTestRunner(verbose=False, optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE)
    runner.run(test, out=text.write, clear_globs=False)
    space.update(test.globs)
    if runner.failures:
        yield " ".join(text.getvalue().split())


def _read(code: str, work: Path) -> None:
    """Read a whole file as its reader does, a part of one as TOML. Raises ValueError."""
    keys = tomllib.loads(code).keys()
    path = work / "sample.toml"
    path.write_text(code, encoding="utf-8")
    if "sweep" in keys and "title" in keys:
        read_study_file(path)
    elif {"title", "problem"} <= keys and "table" not in keys:
        parse_case(code.encode(), path)


def _parsed(line: str) -> None:
    """Parse a line that calls coatcheck; nothing of it is run. Raises CycloptsError."""
    command = re.sub(r"^\$ |  +#.*$", "", line.strip())
    words = shlex.split(command) if command.startswith("coatcheck ") else []
    if words and not {"<", "|", ">", "&&"} & set(words):
        app.parse_args(words[1:], exit_on_error=False, print_error=False)
