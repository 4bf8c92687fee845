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

from verification.cases.case_file import parse_case
from verification.cases.published_file import parse_published
from verification.cases.toml_file import CaseError
from verification.cli import app
from verification.guests.guest_description import parse_guest
from verification.manual.generated_blocks import SOURCE
from verification.study.study_plan import parse_study

ROOT = Path(__file__).resolve().parents[3]
PAGES = (
    *sorted(SOURCE.glob("*.md")),
    ROOT / "verification" / "guests" / "PROTOCOL.md",
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
)
FENCE = re.compile(r"^( *)```(\w+)\n(.*?)^\1```$", re.MULTILINE | re.DOTALL)
QUICK = ("toml", "sh", "console")


def samples_of(text: str) -> list[tuple[str, str]]:
    """Language with content of every fenced block."""
    return [(found[2], found[3]) for found in FENCE.finditer(text)]


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
    raw, path = code.encode(), work / "sample.toml"
    if {"title", "sweep"} <= keys:
        parse_study(raw, path)
    elif {"title", "table"} <= keys:
        (work / "my_table.csv").write_text("depth,s_z\n10,0.65\n")
        parse_published(raw, path)
    elif {"title", "problem"} <= keys:
        parse_case(raw, path)
    elif {"name", "supports"} <= keys:
        parse_guest(raw, path)


def _parsed(line: str) -> None:
    """Parse a line that calls coatcheck; nothing of it is run. Raises CycloptsError."""
    words = shlex.split(re.sub(r"^\$ |  +#.*$", "", line.strip()))
    if words[:1] == ["coatcheck"] and not {"<", "|", ">", "&&"} & set(words):
        app.parse_args(words[1:], exit_on_error=False, print_error=False)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_files_and_commands_on_a_page_are_those_of_this_version(page, tmp_path):
    quick = [sample for sample in samples_of(page.read_text()) if sample[0] in QUICK]
    assert list(failures(quick, tmp_path)) == []


def test_a_wrong_option_or_key_on_a_page_is_noticed(tmp_path):
    wrong = [
        ("sh", "coatcheck run --outptu reports\n"),
        ("toml", 'title = "a"\n[problem]\nradios = 1\n'),
        ("pycon", ">>> 1 + 1\n3\n"),
        ("python", "import no_such_module\n"),
    ]
    assert [len(list(failures([sample], tmp_path))) for sample in wrong] == [1, 1, 1, 1]
    with pytest.raises(CaseError):
        _read(wrong[1][1], tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_line_of_python_on_a_page_runs(page, tmp_path):
    assert list(failures(samples_of(page.read_text()), tmp_path)) == []
