"""What a report says of the program itself, measured once a process."""

from functools import cache
from unittest import mock

import pytest


@pytest.fixture(scope="session", autouse=True)
def _measured_once():
    """Each of these has tests of its own, which call it by its own name."""
    from verification.commands import report, run

    with (
        mock.patch.object(run, "self_tests", cache(run.self_tests)),
        mock.patch.object(report, "self_tests", cache(report.self_tests)),
    ):
        yield
