"""One thread a process; the slow tests in parts."""

import zlib

import pytest
from threadpoolctl import threadpool_limits

SLOW_PARTS = 7


@pytest.fixture(scope="session", autouse=True)
def _one_thread():
    """Tests run side by side, and small matrices lose time on more threads."""
    with threadpool_limits(1):
        yield


def pytest_addoption(parser):
    parser.addoption(
        "--slow-part", type=int, choices=range(SLOW_PARTS), help="of the slow tests one part alone"
    )


def pytest_collection_modifyitems(config, items):
    part = config.getoption("--slow-part")
    if part is None:
        return
    slow = [item for item in items if item.get_closest_marker("slow")]
    other = [item for item in slow if zlib.crc32(item.nodeid.encode()) % SLOW_PARTS != part]
    config.hook.pytest_deselected(items=other)
    items[:] = [item for item in items if item not in other]
