"""Known answers: what was asked, what the harness found, what it has to be."""

from collections.abc import Iterator
from typing import Any

Answers = Iterator[tuple[str, Any, Any]]
