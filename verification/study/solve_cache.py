"""A content-addressed store of solves with checksums.

The key of a solve is the SHA-256 of all that its answer depends on: the request in canonical JSON, the source
files of the modules that answer, the versions of the packages that its digits depend on. An answer is a file
of that name, written whole or not at all, with its checksum and its request.
"""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from verification.running.checked_files import StoreError, read_checked, write_checked
from verification.running.provenance import fingerprint
from verification.sources.source_registry import SOURCES

# Modules that an answer depends on beside the package of its source.
_SEARCH = (
    "verification.study.largest_stresses",
    "verification.study.friction_planes",
    "verification.study.study_point",
    "verification.problem",
    "verification.sources.source_registry",
    "verification.sources.source_record",
    "verification.sources.method_sources",
    "verification.sources.exact_sources",
    "verification.sources.limit_extrapolation",
    "verification.sampling.largest_tension",
    "verification.judging.invariants.companion_uncertainty",
    "verification.running.case_result",
    "verification.running.slicing",
)
_DIGITS = ("python", "numpy", "scipy", "ducc0", "scikit-fem", "gmsh", "mkl")


def solve_key(request: Mapping[str, Any]) -> str:
    """Key of a request, 64 hexadecimal digits; equal for equal requests to equal code."""
    canonical = json.dumps(request, sort_keys=True, separators=(",", ":"), allow_nan=False)
    code = fingerprint((SOURCES[request["source"]].package, *_SEARCH), _DIGITS)
    return hashlib.sha256(f"{canonical}\n{code}".encode()).hexdigest()


@dataclass(frozen=True)
class Cache:
    """Answers under ``folder``, one file each."""

    folder: Path

    def path(self, key: str) -> Path:
        """Path of the answer of ``key``."""
        return self.folder / key[:2] / f"{key}.json"

    def has(self, key: str) -> bool:
        """True where there is a file for ``key``, damaged or not."""
        return self.path(key).is_file()

    def get(self, key: str, request: Mapping[str, Any]) -> dict[str, Any]:
        """The answer of ``key``. Raises StoreError where it is missing, damaged or of another request."""
        path = self.path(key)
        stored = read_checked(path)
        if stored.get("key") != key or stored.get("request") != json.loads(json.dumps(request)):
            raise StoreError(f"{path}: holds another solve than its name states; delete it")
        return stored["answer"]

    def put(self, key: str, request: Mapping[str, Any], answer: Mapping[str, Any]) -> None:
        """Store an answer. Raises StoreError where it cannot be written."""
        content = {"key": key, "request": dict(request), "answer": _without_nan(dict(answer))}
        write_checked(self.path(key), content)


def _without_nan(value: Any) -> Any:
    """``value`` with null for NaN, which strict JSON lacks."""
    if isinstance(value, dict):
        return {key: _without_nan(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_without_nan(item) for item in value]
    return None if isinstance(value, float) and value != value else value
