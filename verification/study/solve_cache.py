"""A content-addressed store of solves with checksums.

The key of a solve is the SHA-256 of all that its answer depends on: the request in canonical JSON, the source
files of the modules that answer, the versions of the packages that its digits depend on. An answer is a file
of that name, written whole or not at all, with its checksum and its request.
"""

import hashlib
import json
from collections.abc import Mapping
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
    "verification.sampling.along_axis",
    "verification.sampling.largest_tension",
    "verification.judging.invariants.companion_uncertainty",
    "verification.running.case_result",
    "verification.running.json_records",
    "verification.running.slicing",
)
_DIGITS = ("python", "numpy", "scipy", "ducc0", "scikit-fem", "gmsh", "mkl")


def solve_key(request: Mapping[str, Any]) -> str:
    """Key of a request, 64 hexadecimal digits; equal for equal requests to equal code."""
    canonical = json.dumps(request, sort_keys=True, separators=(",", ":"), allow_nan=False)
    code = fingerprint((SOURCES[request["source"]].package, *_SEARCH), _DIGITS)
    return hashlib.sha256(f"{canonical}\n{code}".encode()).hexdigest()


def stored_path(folder: Path, key: str) -> Path:
    """Path of the answer of ``key`` in the directory of a study."""
    return folder / "cache" / key[:2] / f"{key}.json"


def read_answer(path: Path, request: Mapping[str, Any]) -> dict[str, Any]:
    """The answer at ``path``. Raises StoreError where it is missing, damaged or of another request."""
    stored = read_checked(path)
    if stored.get("key") != path.stem or stored.get("request") != json.loads(json.dumps(request)):
        raise StoreError(f"{path}: holds another solve than its name states; delete it")
    answer: dict[str, Any] = stored["answer"]
    return answer


def write_answer(path: Path, request: Mapping[str, Any], answer: Mapping[str, Any]) -> None:
    """Store an answer, with null for NaN, which strict JSON lacks. Raises StoreError."""
    rows = [
        {name: None if value != value else value for name, value in row.items()} for row in answer["rows"]
    ]
    write_checked(path, {"key": path.stem, "request": dict(request), "answer": {**answer, "rows": rows}})
