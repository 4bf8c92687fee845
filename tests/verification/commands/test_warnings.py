"""Implausible input on terminal, page and in JSON; an option refuses it."""

from case_texts import case_text
from quick_case import coatcheck

LINE = "load = 3 <looks> like mN"


def test_run_refuses_an_implausible_case_when_strict(tmp_path):
    path = tmp_path / "slip.toml"
    path.write_text(case_text(radius="10"))
    done = coatcheck("run", str(path), "--strict", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith("coatcheck: slip: ")
    assert done.stderr.count("\n") == 1
