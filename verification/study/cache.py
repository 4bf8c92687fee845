"""A content-addressed store of solves that checks itself.

The key of a solve is the SHA-256 of everything that its answer depends on: the request in canonical JSON,
the source files of the packages that answer, the versions of those that put digits into it. An answer lies in
a file of that name, written whole or not at all, with its own checksum and the request it belongs to.
"""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from verification.running.provenance import versions
from verification.running.store import StoreError, read_checked, write_checked
from verification.sources.registry import SOURCES

__all__ = ["Cache", "code_version", "solve_key"]

# Modules that an answer depends on beside the package of its source.
_SEARCH = (
    "verification.study.quantities",
    "verification.study.planes",
    "verification.study.point",
    "verification.problem",
    "verification.sources.registry",
    "verification.sources.source",
    "verification.sources.methods",
    "verification.sources.exact",
    "verification.sources.extrapolation",
    "verification.sampling.plane",
    "verification.running.result",
)
_DIGITS = ("python", "numpy", "scipy", "ducc0", "scikit-fem", "gmsh")


def solve_key(request: Mapping[str, Any]) -> str:
    """Key of a request, 64 hexadecimal digits; equal for equal requests to equal code."""
    canonical = json.dumps(request, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(f"{canonical}\n{code_version(request['source'])}".encode()).hexdigest()


@cache
def code_version(source: str) -> str:
    """SHA-256 of the source files behind an answer of ``source``, and of the versions it stands on."""
    digest = hashlib.sha256()
    for module in (SOURCES[source].package, *_SEARCH):
        spec = find_spec(module)
        assert spec is not None
        assert spec.origin is not None
        origin = Path(spec.origin)
        files = sorted(origin.parent.rglob("*.py")) if origin.name == "__init__.py" else [origin]
        for path in files:
            digest.update(f"{module}/{path.name}\n".encode())
            digest.update(path.read_bytes())
    found = versions()
    digest.update(json.dumps({name: found[name] for name in _DIGITS}).encode())
    return digest.hexdigest()


@dataclass(frozen=True)
class Cache:
    """Answers under ``folder``, one file each."""

    folder: Path

    def path(self, key: str) -> Path:
        """Where the answer of ``key`` lies."""
        return self.folder / key[:2] / f"{key}.json"

    def has(self, key: str) -> bool:
        """Whether there is a file for ``key``, whole or not."""
        return self.path(key).is_file()

    def get(self, key: str, request: Mapping[str, Any]) -> dict[str, Any]:
        """The answer of ``key``. Raises StoreError where it is missing, damaged or of another request."""
        path = self.path(key)
        stored = read_checked(path)
        if stored.get("key") != key or stored.get("request") != json.loads(json.dumps(request)):
            raise StoreError(f"{path}: holds another solve than its name says; delete it")
        return stored["answer"]

    def put(self, key: str, request: Mapping[str, Any], answer: Mapping[str, Any]) -> None:
        """Store an answer. Raises StoreError where it cannot be written."""
        write_checked(
            self.path(key), {"key": key, "request": dict(request), "answer": _without_nan(dict(answer))}
        )


def _without_nan(value: Any) -> Any:
    """NaN, which strict JSON lacks, as null."""
    if isinstance(value, dict):
        return {key: _without_nan(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_without_nan(item) for item in value]
    return None if isinstance(value, float) and value != value else value
