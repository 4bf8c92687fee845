"""Provenance of a run: versions, commit, machine."""

import hashlib
import os
import platform
import subprocess
from collections.abc import Iterable
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from threadpoolctl import threadpool_info

from verification.sources.source_registry import METHODS, SOURCES

PACKAGES = (
    "coatcheck",
    "numpy",
    "scipy",
    "ducc0",
    "scikit-fem",
    "gmsh",
    "mkl",
    "meshio",
    "pyvista",
    "pydantic",
    "matplotlib",
)

ROOT = Path(__file__).resolve().parents[2]
CODE = (*(SOURCES[name].package for name in METHODS), "verification")

NOT_INSTALLED = "not installed"


def versions(packages: Iterable[str] = PACKAGES) -> dict[str, str]:
    """Version of Python and of each package, by default of those that results depend on."""
    return {"python": platform.python_version()} | {name: _version(name) for name in packages}


def numerical_versions() -> dict[str, str]:
    """Versions, and the kernel of each BLAS that is loaded, on which the seventh digit depends."""
    kernels = {
        f"{one['internal_api']} {one['version']}, {one.get('architecture') or 'unknown'} kernel"
        for one in threadpool_info()
        if one["user_api"] == "blas"
    }
    return versions() | {"BLAS": "; ".join(sorted(kernels))}


@cache
def _version(name: str) -> str:
    """Version of an installed package; a process has loaded one of it, so that it is looked up once."""
    try:
        return version(name)
    except PackageNotFoundError:
        return NOT_INSTALLED


def commit(here: Path = ROOT) -> str | None:
    """Commit of the source tree below ``here``, with "+" where it was changed since; None of no checkout."""
    if not (here / ".git").exists():
        return None

    def git(*words: str) -> str:
        return subprocess.run(
            ["git", "-C", str(here), *words], capture_output=True, text=True, timeout=10, check=True
        ).stdout.strip()

    try:
        return git("rev-parse", "--short=12", "HEAD") + ("+" if git("status", "--porcelain", "-uno") else "")
    except (OSError, subprocess.SubprocessError):
        return None


@cache
def fingerprint(
    modules: tuple[str, ...] = CODE, packages: tuple[str, ...] = ("python", *PACKAGES), without: str = ""
) -> str:
    """SHA-256 over the source of ``modules``, ``without`` one package, and the versions of ``packages``.

    Results of equal fingerprints come from the same code; by default that is all of this program. It is read
    once: code that changes later is not the code that this process has loaded.
    """
    known = versions()
    found = hashlib.sha256(repr([(name, known[name]) for name in packages]).encode())
    left_out = ROOT.joinpath(*without.split(".")) if without else None
    for module in modules:
        place = ROOT.joinpath(*module.split("."))
        for path in sorted(place.rglob("*.py")) or [place.with_suffix(".py")]:
            if left_out in path.parents:
                continue
            found.update(path.relative_to(ROOT).as_posix().encode() + b"\0" + path.read_bytes())
    return found.hexdigest()


def cores() -> int:
    """Processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def hardware() -> str:
    """Machine with its number of processors, as a run records it."""
    return f"{machine()}, {cores()} cores"


def machine() -> str:
    """System and processor, without a host name."""
    return f"{platform.system()} {platform.machine()}{_processor()}"


def _processor() -> str:
    """Name, family and model of the processor, on Linux; the last digits may depend on them."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return ""
    fields: dict[str, str] = {}
    for line in lines:
        name, _, value = line.partition(":")
        fields.setdefault(name.strip(), value.strip())
    found = [fields[name] for name in ("model name", "cpu family", "model", "stepping") if name in fields]
    return f", {' '.join(found)}" if found else ""
