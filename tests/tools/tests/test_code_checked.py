"""Checks of the code itself: imports really read, the record of both that every report shows."""

import pytest
from code_checked.checking import code
from code_checked.import_independence import PARTS, imports_of, parts

from verification.evidence.code_record import read_record, shared
from verification.evidence.enclosure_record import SHIPPED


def test_the_methods_share_numpy_and_none_of_scipy():
    found = {one.name: one for one in parts()}
    assert tuple(found) == tuple(PARTS)
    for one in found.values():
        assert (one.forbidden, one.hidden) == ((), ())
        assert one.statements > one.files > 5
    first, second = found["semianalytic"], found["fem_reference"]
    assert "numpy" in shared(first, second)
    assert set(first.packages) & set(second.packages) == {"numpy", "scipy"}
    assert "skfem" in second.packages
    assert "skfem" not in first.packages


def test_an_import_across_the_border_is_found(tmp_path, monkeypatch):
    package = tmp_path / "borderless"
    (package / "deep").mkdir(parents=True)
    (package / "__init__.py").write_text("import os\nimport numpy as np\nfrom scipy import special, linalg\n")
    (package / "deep" / "__init__.py").write_text("")
    (package / "deep" / "a.py").write_text(
        "def f():\n    from fem_reference.meshing.mesh import build\n    import borderless.deep\n"
        "    import importlib\n    return importlib.import_module('semi' + 'analytic'), build\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    found = imports_of("borderless", ("fem_reference",))
    assert found.files == 3
    assert found.modules == ("fem_reference.meshing.mesh", "numpy", "scipy.linalg", "scipy.special")
    assert found.functions == ("scipy.linalg", "scipy.special")
    assert found.forbidden == ("borderless/deep/a.py imports fem_reference.meshing.mesh",)
    assert found.hidden == ("borderless/deep/a.py calls importlib.import_module",)
    with pytest.raises(ValueError, match="no_such_package"):
        imports_of("no_such_package")


def test_the_shipped_record_is_what_is_measured(tmp_path, monkeypatch):
    monkeypatch.setattr("code_checked.checking.RECORDS", tmp_path)
    assert code(record=True) == 0
    now, then = read_record(tmp_path), read_record(SHIPPED)
    assert [one.errors for one in now.orders] == [pytest.approx(one.errors, rel=1e-6) for one in then.orders]
    assert [one.modules for one in now.parts] == [one.modules for one in then.parts]
