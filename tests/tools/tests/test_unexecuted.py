"""Statements that a trace of executed lines leaves out."""

import subprocess
import sys

import unexecuted


def test_a_trace_names_the_lines_that_ran_and_leaves_the_rest(tmp_path):
    file = tmp_path / "lines"
    code = "from semianalytic.inputs import undeformed_gap; undeformed_gap('parabola', 1.0)(0.1)"
    subprocess.run([sys.executable, "-c", code], env=unexecuted.traced(file), cwd=unexecuted.ROOT, check=True)
    executed = set(file.read_text(encoding="utf-8").split())
    missing = [
        text for place, text in unexecuted.missing(executed) if place.startswith("semianalytic/inputs.py")
    ]
    assert "return lambda r: r**2 / (2 * radius)" not in missing
    assert "return lambda r: r**2 / (radius + np.sqrt(np.maximum(radius**2 - r**2, 0.0)))" in missing
    assert not any(text.startswith("raise") for text in missing)
