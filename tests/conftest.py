"""One thread a process; the slow tests in parts."""

import os
import re
import time
import zlib

import pytest
from rich.console import Console
from threadpoolctl import threadpool_limits

SLOW_PARTS = 14  # two for each day of a week, see .ci/run


@pytest.fixture(scope="session", autouse=True)
def _one_thread():
    """Tests run side by side, and small matrices lose time on more threads."""
    with threadpool_limits(1):
        yield


@pytest.fixture
def environment(monkeypatch):
    """Variables as this process sees them; putenv is unsafe while other threads read the environment."""

    def given(**variables):
        monkeypatch.setattr(os, "environ", {**os.environ, **variables})
        monkeypatch.setattr(Console, "_environ", os.environ)

    return given


def pytest_addoption(parser):
    parser.addoption(
        "--slow-part", type=int, choices=range(SLOW_PARTS), help="one part of the slow tests alone"
    )
    parser.addoption("--slow-seconds", type=float, help="begin no slow test later than this")


BEGIN = time.monotonic()


def pytest_runtest_setup(item):
    seconds = item.config.getoption("--slow-seconds")
    late = seconds is not None and time.monotonic() - BEGIN > seconds
    if late and item.get_closest_marker("slow"):
        pytest.skip(f"{seconds:g} s are over")


def pytest_collection_modifyitems(config, items):
    for item in items:
        if item.get_closest_marker("slow") or item.get_closest_marker("cases"):
            item.add_marker(pytest.mark.timeout(3600))
    part = config.getoption("--slow-part")
    if part is None:
        return
    # Tests of one file with one parameter share what their fixtures have solved.
    groups = {item: re.sub(r"::[^\[]*", "", item.nodeid) for item in items if item.get_closest_marker("slow")}
    other = {item for item, name in groups.items() if zlib.crc32(name.encode()) % SLOW_PARTS != part}
    config.hook.pytest_deselected(items=list(other))
    items[:] = [item for item in items if item not in other]
