"""The command line as people expect it: examples, exit codes, completion, plain pipes, a stop that keeps."""

import io
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from functools import partial

import pytest
from quick_case import COMMAND, QUICK, coatcheck
from rich.console import Console
from synthetic_results import INFO, contact, result_of

from verification.cases.case_file import shaped_cases, shipped_cases
from verification.cases.published_file import published_cases
from verification.commands.common.terminal import named_table, print_out
from verification.commands.compare import compare
from verification.commands.shipped.list_cases import list_cases
from verification.commands.shipped.materials_listed import materials
from verification.report.report_material import ReportMaterial
from verification.report.report_page import report_json
from verification.running.case_result import to_json
from verification.running.checked_files import write_checked
from verification.running.stored_run import read_run


def asked(capsys, *words):
    """Exit code, output and messages of a command in this process."""
    from verification.cli import app

    code = app([str(word) for word in words], result_action="return_value")
    said = capsys.readouterr()
    return code, said.out, said.err


@pytest.fixture
def stored(tmp_path):
    """A run directory with two made-up cases, without its page."""
    results = [
        result_of(contact(), name=name, title=f"Case <{name}>", points=5, text=f"title = '{name}'")
        for name in ("second", "first")
    ]
    for result in results:
        write_checked(tmp_path / "run" / "cases" / f"{result.name}.json", to_json(result))
    (tmp_path / "run" / "report.json").write_text(report_json(ReportMaterial(results, INFO)))
    return tmp_path / "run"


@pytest.mark.parametrize(
    ("shell", "words"),
    [
        # What each shell does on Tab: the word begun, then what it may become.
        ("bash", 'COMP_WORDS=(coatcheck re) COMP_CWORD=1; _coatcheck; echo "${COMPREPLY[@]}"; complete -p'),
        ("zsh", "whence -f $_comps[coatcheck] && [[ -n $_comps[coatcheck] ]] && echo default"),
        ("fish", "complete -C 'coatcheck re'; echo default"),
    ],
)
def test_completion_works_in_the_shell_itself(capsys, tmp_path, shell, words):
    if shutil.which(shell) is None:
        pytest.skip(f"no {shell} on this machine")
    script = tmp_path / "completion"
    script.write_text(asked(capsys, "completion", shell)[1])
    begin = "autoload -Uz compinit; compinit -u -D; " if shell == "zsh" else ""
    done = subprocess.run(
        [shell, "-c", f"{begin}source {script}; {words}"], capture_output=True, text=True, timeout=60
    )
    assert "report" in done.stdout, done.stderr
    # Where no command fits, the names of files.
    assert "default" in done.stdout


@pytest.fixture
def screen(monkeypatch):
    """A terminal of the given width, whose text a call returns without its colours."""
    written = io.StringIO()

    def of_width(width):
        monkeypatch.setattr(
            "rich.console.Console", partial(Console, file=written, force_terminal=True, width=width)
        )
        return lambda: re.sub(r"\x1b\[[0-9;]*m", "", written.getvalue())

    return of_width


@pytest.mark.parametrize("width", [80, 120])
def test_names_are_whole_in_a_terminal(stored, screen, width):
    shown = screen(width)
    name = "16_ratio_quarter_sliding_of_mine"
    results = [replace(result, name=name) for result in read_run(stored).results[:1]]
    (stored / "report.json").write_text(report_json(ReportMaterial(results, INFO)))
    assert list_cases() == 0
    assert compare(stored, stored) == 0
    names = [name, *shipped_cases(), *shaped_cases(), *published_cases()]
    assert [n for n in names if n not in shown()] == []
    assert max(map(len, shown().splitlines())) <= width


@pytest.mark.parametrize("width", [60, 80, 120])
def test_no_word_of_a_table_is_clipped(screen, width):
    heads = ["name", "p0 [MPa]", "largest tension of the coatings [MPa]", "used", "safety factor", "from N"]
    cells = ["interface 2 (Cr / 100Cr6) shears off", "1024.5", "467", "0.587", "1.05e+03", "102"]
    tables = [(heads, cells), (heads, ["nickel phosphorus as it is supplied, heated", *cells[1:]])]
    for head, row in tables:
        shown, table = screen(width), named_table(*head)
        table.add_row(*row)
        print_out(table)
        assert [word for word in " ".join([*head, *row]).split() if word not in shown()] == []
        assert max(map(len, shown().splitlines())) <= width
    materials("DLC", "100Cr6", "Al2O3")
    assert [
        word for word in ("a-C:H", "SUJ2,", "1.3505,", "386", "446", "0.231") if word not in shown()
    ] == []


@pytest.mark.parametrize(
    ("words", "nearest"),
    [
        ("run 05_ratio4", "05_ratio_4"),
        ("run Publishd", "published"),
        ("run hertz", "hertz_1882"),
        ("study thickness silver_on_stel", "silver_on_steel"),
        ("report rum", "run"),
        ("compare run rum", "run"),
        ("run zzz", None),
    ],
)
def test_a_mistyped_name_is_answered_with_the_nearest(stored, capsys, monkeypatch, words, nearest):
    monkeypatch.chdir(stored.parent)
    code, _, error = asked(capsys, *words.split())
    assert code == 2
    assert len(error.splitlines()) == 1
    assert ("mean" in error) == (nearest is not None)
    assert nearest is None or nearest in error


def test_what_is_piped_has_no_colours(tmp_path, environment):
    environment(TERM="xterm-256color")
    (tmp_path / "quick.toml").write_text(QUICK)
    done = coatcheck("run", "quick.toml", "-v", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "\x1b" not in done.stdout + done.stderr
    # Verbose: every source with its seconds.
    lines = [line.split() for line in done.stderr.splitlines()]
    assert {words[0] for words in lines if words[-1:] == ["s"] or "iterations" in words} >= {"hertz"}


@pytest.mark.parametrize(
    ("words", "written"),
    [
        (("solve", "quick.toml", "--plot", "stresses.png"), "stresses.png"),
        pytest.param(("run", "quick.toml", "--output", "out"), "out/report.html", marks=pytest.mark.slow),
        pytest.param(
            ("run", "quick.toml", "--output", "out", "--json"), "out/report.html", marks=pytest.mark.slow
        ),
    ],
)
def test_a_reader_that_has_seen_enough_changes_no_file_and_no_exit_code(tmp_path, words, written):
    (tmp_path / "quick.toml").write_text(QUICK)
    asked_for = (*COMMAND, *words)
    with subprocess.Popen(asked_for, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as working:
        working.stdout.close()
        said = working.stderr.read()
    assert (working.returncode, (tmp_path / written).is_file()) == (0, True), said


def test_ctrl_c_keeps_what_was_done_and_says_so(tmp_path):
    (tmp_path / "quick.toml").write_text(QUICK)
    long = "26_ellipse_soft_across"
    words = ["run", "quick.toml", long, "--jobs", "2", "--output", "out"]
    process = subprocess.Popen(
        [*COMMAND, *words],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # ignored below nohup and the like
    )
    kept = tmp_path / "out" / "cases" / "quick.json"
    deadline = time.monotonic() + 120
    while not kept.exists() and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.05)
    time.sleep(0.3)
    assert process.poll() is None, "ended before the signal"
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130, said
    assert "1 of 2" in said
    assert "--resume" in said
    assert "Traceback" not in said
    assert not (tmp_path / "out" / "cases" / f"{long}.json").exists()
    written = kept.stat().st_mtime_ns
    again = coatcheck("run", "quick.toml", "--output", "out", "--resume", "--json", cwd=tmp_path)
    assert again.returncode == 0, again.stderr
    assert kept.stat().st_mtime_ns == written


def test_a_damaged_case_is_named_and_the_page_left_alone(stored, capsys):
    path = stored / "cases" / "first.json"
    path.write_bytes(path.read_bytes()[:-50])
    code, _, complaint = asked(capsys, "report", stored)
    assert code == 2
    assert "first.json" in complaint
    assert len(complaint.splitlines()) == 1
    assert not (stored / "report.html").exists()


@pytest.mark.parametrize(
    ("command", "unused"),
    [
        ("--help", ("numpy", "scipy", "pydantic", "matplotlib", "fem_reference", "semianalytic")),
        # a case stated by its approach is read with the load that the exact reference finds, by SciPy
        ("list", ("pint", "matplotlib", "gmsh", "pyvista", "fem_reference", "semianalytic")),
        (
            'solve --ball "10 mm" --load "20 N" --coating "2 um, 180 GPa, 0.2" --substrate "210 GPa, 0.3"',
            ("pint", "matplotlib", "gmsh", "pyvista", "fem_reference"),
        ),
        # half of the processor time of guest check was loading SciPy's statistics
        ("guest check nowhere", ("scipy.stats", "scipy.signal", "matplotlib", "gmsh", "fem_reference")),
    ],
)
def test_commands_load_nothing_that_they_do_not_use(command, unused):
    text = f"import sys; sys.argv = ['coatcheck', *{shlex.split(command)!r}]\n"
    text += "from verification.cli import main\ntry: main()\nexcept SystemExit: print('loaded', *sys.modules)"
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.splitlines()[-1].split()[1:])
    assert "verification.cli" in loaded
    assert not loaded & set(unused)
