"""Scripts in examples/: short, each with the picture that the manual shows, and each runs as it is."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
MOST_LINES = 60


def test_examples_are_short_say_what_they_show_and_have_a_picture():
    assert len(EXAMPLES) >= 10
    for script in EXAMPLES:
        text = script.read_text("utf-8")
        assert text.count("\n") <= MOST_LINES, script.name
        assert text.startswith('"""'), script.name
    pictures = {path.stem for path in (ROOT / "examples" / "pictures").glob("*.png")}
    assert pictures == {script.stem for script in EXAMPLES}


@pytest.mark.slow
@pytest.mark.parametrize("script", EXAMPLES, ids=lambda path: path.stem)
def test_example_runs_without_a_warning_and_draws_its_picture(script, tmp_path):
    environment = os.environ | {"MPLBACKEND": "Agg", "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-W", "error", str(script)]
    done = subprocess.run(
        command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=280, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout
    assert [path.name for path in tmp_path.iterdir()] == [f"{script.stem}.png"]
