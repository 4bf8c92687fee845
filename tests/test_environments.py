"""Commands of the README and the manual, each with the extras that its line names, by default ``all``.

Long commands run on one case, see ``QUICK``. Names of tests contain the extras, so that ``-k all:``
runs one environment alone: continuous integration takes turns.
"""

import os
import re
import shlex
import subprocess
import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from map_of_heights import write_sdf

from verification.cli import COMMANDS

ROOT = Path(__file__).resolve().parent.parent
PAGES = [ROOT / "README.md", *sorted((ROOT / "verification" / "manual" / "source").glob("*.md"))]
SOLVE = ROOT / "verification" / "manual" / "source" / "solve.md"
LINE = re.compile(r"^(?:\| `|    |\$ )?((?:[^`|\n]*&& *)?(?:\.venv/bin/)?coatcheck [^`|\n]*)", re.MULTILINE)
EXTRAS = re.compile(r"pip install .*?-e '?\.(?:\[([\w,]+)\])?'?")
# What takes minutes is run in part; what waits for a person or writes the baseline is not run.
QUICK = {
    r"run$": "run 01_uncoated_steel",
    r"run published$": "run ahlvin_ulery_1962",
    r"(study \w+).*": r"\1 --help",
    r"completion .*": "completion bash",
}
NOT_RUN = ("baseline update", "<")
# What a line needs beyond ``all``.
NEEDS = {"surface": "report,surfaces"}


def commands() -> list[tuple[str, str]]:
    """(extras, words) of every command of coatcheck on a page, in the order of the pages."""
    found = {}
    for page in PAGES:
        text = re.sub(r" \\\n +", " ", page.read_text(encoding="utf-8"))
        for line in LINE.findall(text):
            extras = EXTRAS.search(line)
            words = line.rpartition("coatcheck ")[2].partition("  #")[0].strip().rstrip(")")
            known = words.split()[0] in {name.split()[0] for name in COMMANDS}
            if known and not any(part in words for part in NOT_RUN):
                for pattern, quick in QUICK.items():
                    words = re.sub(f"^{pattern}", quick, words)
                found[(extras and extras[1]) or NEEDS.get(words.split()[0], "all"), words] = None
    return list(found)


@cache
def environment(extras: str) -> Path:
    """The programs of a new environment with ``extras``, or with the base alone if there are none."""
    place = ROOT / "build" / "environments" / (extras or "base")
    subprocess.run([sys.executable, "-m", "venv", "--clear", place], check=True)
    named = f"{ROOT}[{extras}]" if extras else ROOT
    words = [place / "bin" / "pip", "install", "-q", "-c", ROOT / "constraints.txt", "-e", named]
    subprocess.run(words, check=True)
    return place / "bin"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Commands of a page use what those before them wrote, and a reader's own files: those that the pages
    print, a curve and a map of heights."""
    place = tmp_path_factory.mktemp("newcomer")
    printed = {"my_coating.toml": (ROOT / "CONTRIBUTING.md", "toml"), "my_coatings.csv": (SOLVE, "text")}
    for name, (page, kind) in printed.items():
        text = page.read_text(encoding="utf-8").partition(f"```{kind}\n")[2].partition("```")[0]
        (place / name).write_text(text)
    loads = np.linspace(0.5, 5, 10)  # mN; depth by Hertz, of E* = 80 GPa and a radius of 5 um
    depths = (0.75 * 1e-3 * loads / (80e9 * 5e-6**0.5)) ** (2 / 3) / 1e-9
    rows = "".join(f"{load},{depth}\n" for load, depth in zip(loads, depths, strict=True))
    (place / "curve.csv").write_text("load [mN],depth [nm]\n" + rows)
    x = np.linspace(-200e-6, 200e-6, 128)
    write_sdf(place / "map.sdf", 20e-9 * np.cos(4e5 * x)[:, None] * np.cos(5e5 * x)[None, :], 400e-6)
    return place


def test_commands_of_the_pages_are_found():
    found = commands()
    assert {extras for extras, _ in found} >= {"all", "manual"}
    assert len(found) > 20


@pytest.mark.slow
@pytest.mark.timeout(1800)  # the first one with an extra installs it
@pytest.mark.parametrize(("extras", "words"), commands(), ids=[f"{e}: {w}" for e, w in commands()])
def test_a_command_runs_with_the_extras_that_its_line_names(extras, words, folder):
    programs = environment(extras)
    variables = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"} | {"OMP_NUM_THREADS": "1"}
    done = subprocess.run(
        [programs / "coatcheck", *shlex.split(words)],
        cwd=folder,
        env=variables,
        capture_output=True,
        text=True,
    )
    # 5: the runs that are compared are of different cases here
    usual = (0, 5) if words.startswith("compare") else (0,)
    assert done.returncode in usual, done.stdout[-2000:] + done.stderr[-2000:]
    assert "\x1b" not in done.stdout + done.stderr


@pytest.mark.slow
@pytest.mark.timeout(900)
@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        ("solve --ball '10 mm, 210 GPa, 0.3' --load '20 N' --substrate '210 GPa, 0.3'", 0, "MPa"),
        ("guest init my_code", 0, "my_code"),
        ("guest check my_code", 0, "agree"),
        ("guest run my_code", 0, "agree"),
        ("vectors", 0, "problems"),
        (
            "solve --ball '10 mm, 210 GPa, 0.3' --load '20 N' --substrate '210 GPa, 0.3' --check",
            3,
            "coatcheck[fem]",
        ),
        ("run 01_uncoated_steel", 3, "coatcheck[fem]"),
        ("study thickness my_coating.toml", 3, "coatcheck[report]"),
    ],
    ids=lambda value: f"base: {value}" if isinstance(value, str) and " " in value else None,
)
def test_the_base_alone_solves_and_examines_guests_and_names_the_extra_of_what_it_lacks(
    words, code, said, folder
):
    programs = environment("")
    done = subprocess.run(
        [programs / "coatcheck", *shlex.split(words)], cwd=folder, capture_output=True, text=True, timeout=600
    )
    assert done.returncode == code, done.stdout[-2000:] + done.stderr[-2000:]
    assert said in done.stdout + done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_the_base_alone_takes_at_most_300_mb():
    """base: without pip and what came with the environment."""
    packages = next(environment("").parent.glob("lib/python*/site-packages"))
    files = [path for path in packages.rglob("*") if path.is_file() and path.parts[-2] != "__pycache__"]
    own = [path for path in files if path.relative_to(packages).parts[0] not in ("pip", "setuptools")]
    assert sum(path.stat().st_size for path in own) <= 300e6
